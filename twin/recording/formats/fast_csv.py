"""Large tables of plain numbers, quickly: pyarrow's reader in pieces, where it is installed.

It is asked only for what it reads as the careful reader would: one separator, points for decimals, a name for
each column. Whatever it stumbles over is left to the careful reader, which says where.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

LEAST_BYTES = 2 << 20  # smaller tables are read carefully from the start
BLOCK = 8 << 20
MOST_CELLS = 24_000_000  # held at once: about 30 bytes each until the voyage stands
EMPTY = [
    "",
    "nan",
    "NaN",
    "NAN",
    "na",
    "NA",
    "n/a",
    "N/A",
    "#N/A",
    "null",
    "NULL",
    "none",
    "None",
    "-",
    "--",
    "---",
]


def pieces(
    path: Path, names: Sequence[str], wanted: Sequence[str], separator: str, skip: int, encoding: str
) -> Iterator[dict[str, np.ndarray]] | None:
    """The wanted columns as floats, block after block; None when this reader is not for it."""
    try:
        import pyarrow as pa
        from pyarrow import csv
    except ImportError:
        return None
    if len(set(names)) != len(names) or not set(wanted) <= set(names) or path.stat().st_size < LEAST_BYTES:
        return None
    if encoding not in ("utf-8-sig", "latin-1") or separator == " ":
        return None
    reader = csv.open_csv(
        path,
        csv.ReadOptions(
            block_size=BLOCK,
            column_names=list(names),
            skip_rows=skip,
            encoding="utf8" if encoding == "utf-8-sig" else "latin1",
            use_threads=False,
        ),
        csv.ParseOptions(delimiter=separator, newlines_in_values=False),
        csv.ConvertOptions(
            include_columns=list(wanted),
            column_types={n: pa.float64() for n in wanted},
            null_values=EMPTY,
            strings_can_be_null=True,
        ),
    )
    return (
        {n: block.column(i).to_numpy(zero_copy_only=False) for i, n in enumerate(wanted)} for block in reader
    )


class Thinned:
    """Columns that grow, of which every k-th row is kept so that no more than MOST_CELLS are held."""

    def __init__(self, names: Sequence[str]):
        self.parts: dict[str, list[np.ndarray]] = {n: [] for n in names}
        self.every, self.held, self.seen, self.filled = 1, 0, 0, 0

    def add(self, block: dict[str, np.ndarray]) -> None:
        size = len(next(iter(block.values())))
        start = -self.seen % self.every
        for name, values in block.items():
            kept = values[start :: self.every].copy()
            self.parts[name].append(kept)
            self.filled += int(np.count_nonzero(kept == kept))
        self.held += len(range(start, size, self.every))
        self.seen += size
        while self.held * len(self.parts) > MOST_CELLS and self.filled > 0.5 * self.held * len(self.parts):
            self.halve()

    def halve(self) -> None:
        """Every second of the rows held: they stand at multiples of `every`."""
        self.every *= 2
        for name, values in self.parts.items():
            self.parts[name] = [np.concatenate(values)[::2].copy()]
        self.held = len(next(iter(self.parts.values()))[0])
        self.filled //= 2

    def columns(self) -> dict[str, np.ndarray]:
        return {name: np.concatenate(self.parts.pop(name)) for name in list(self.parts)}


def collected(
    path: Path,
    names: Sequence[str],
    wanted: Sequence[str],
    separator: str,
    skip: int,
    encoding: str,
    notes: list[str],
) -> dict[str, np.ndarray] | None:
    """The wanted columns whole (of very long tables every k-th row: `notes` says so); None when the careful
    reader must be asked."""
    held = Thinned(wanted)
    try:
        found = pieces(path, names, wanted, separator, skip, encoding)
        if found is None:
            return None
        for block in found:
            held.add(block)
    except MemoryError:
        raise
    except Exception:  # pyarrow's own kinds; the careful reader finds the place and says it
        return None
    if not held.held:
        return None
    if held.every > 1:
        notes.append(
            f"{held.seen} rows are more than {MOST_CELLS // len(wanted)}: one row in "
            f"{held.every} was kept. Cut the file into shorter voyages to keep all"
        )
    return held.columns()
