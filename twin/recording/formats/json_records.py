"""Tables as JSON: a list of flat objects, or one object a line; columns by their keys, those of inner objects
joined by a point."""

import json
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.recording.formats.binary_tables import Packed, Piece

JSON = "a table of JSON records"
MOST_BYTES = 1 << 28


def looks_json(lines: list[str], start: bytes) -> bool:
    """Whether a file begins with a list of objects, or with an object in each of its first lines."""
    text = start.lstrip(b"\xef\xbb\xbf \t\r\n")
    if text.startswith(b"["):
        return text[1:].lstrip().startswith(b"{")
    return len(lines) > 1 and all(s.startswith("{") and s.rstrip(",").endswith("}") for s in lines[:5])


class JsonRecords(Packed):
    """All of its records are held: such files are small."""

    def _open(self) -> list[str]:
        if self.path.stat().st_size > MOST_BYTES:
            raise DataError(
                f"{self.path}: this is {self.says} of more than {MOST_BYTES >> 20} MB. Export it as CSV."
            )
        text = self.path.read_text(encoding="utf-8-sig", errors="replace").strip()
        try:
            found = (
                json.loads(text)
                if text.startswith("[")
                else [json.loads(s) for s in text.splitlines() if s.strip()]
            )
        except (ValueError, RecursionError) as error:
            raise DataError(f"{self.path}: this is {self.says}, and it is damaged: {error}.") from None
        self._records = [flat_record(r) for r in found if isinstance(r, dict)]
        return list(dict.fromkeys(key for record in self._records for key in record))

    def _pieces(self, names: Sequence[str]) -> Iterator[Piece]:
        if self._records:
            yield {name: column([r.get(name) for r in self._records]) for name in names}


def flat_record(record: dict[str, Any], front: str = "", depth: int = 4) -> dict[str, Any]:
    """A record's numbers and words by their whole path."""
    out: dict[str, Any] = {}
    for key, held in record.items():
        if isinstance(held, dict) and depth:
            out |= flat_record(held, f"{front}{key}.", depth - 1)
        elif held is None or isinstance(held, int | float | str):
            out[f"{front}{key}"] = held
    return out


def column(values: list[Any]) -> Any:
    """Numbers as floats when all are numbers or empty, else as words."""
    if all(v is None or isinstance(v, int | float) for v in values):
        return np.array([np.nan if v is None else float(v) for v in values])
    return ["" if v is None else str(v) for v in values]
