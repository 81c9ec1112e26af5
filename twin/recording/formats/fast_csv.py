"""Large tables of plain numbers, quickly: pyarrow's reader in pieces, where it is installed.

It is asked only for what it reads as the careful reader would: one separator, points for decimals, a name for
each column. Whatever it stumbles over is left to the careful reader, which says where.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

LEAST_BYTES = 2 << 20  # smaller tables are read carefully from the start
BLOCK = 2 << 20
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
    """The wanted columns as floats, block after block; None when this reader is not for it. A block is a
    column (n,) a name, in the file's units."""
    try:
        import pyarrow as pa
        from pyarrow import csv
    except ImportError:
        return None
    if len(set(names)) != len(names) or not set(wanted) <= set(names) or path.stat().st_size < LEAST_BYTES:
        return None
    if encoding not in ("utf-8-sig", "latin-1") or separator == " ":
        return None
    options = (
        csv.ReadOptions(
            block_size=2 * BLOCK,
            column_names=list(names),
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

    def read(lines: bytes) -> dict[str, np.ndarray]:
        table = csv.read_csv(pa.BufferReader(lines), *options)
        return {n: table.column(n).to_numpy() for n in wanted}

    return map(read, whole_lines(path, skip))


def whole_lines(path: Path, skip: int) -> Iterator[bytes]:
    """The file behind so many lines, in blocks that end with a line: pyarrow's own blocks are read ahead,
    some thirty at once."""
    with open(path, "rb") as file:
        for _ in range(skip):
            file.readline()
        while block := file.read(BLOCK):
            block += file.readline(BLOCK)
            if block.strip():
                yield block


class Thinned:
    """Columns that grow in their place, of which every k-th row is kept so that no more than MOST_CELLS are
    held; `blocks`: about how many will come."""

    def __init__(self, names: Sequence[str], blocks: float = 1.0):
        self.columns: dict[str, np.ndarray] = {n: np.empty(0) for n in names}
        self.every, self.held, self.seen, self.filled, self._blocks = 1, 0, 0, 0, blocks

    def add(self, block: dict[str, np.ndarray]) -> None:
        """Keep every so many-th row of a block, columns (n,) by name in the file's units."""
        size = len(next(iter(block.values())))
        start, ends = (
            -self.seen % self.every,
            self.held + len(range(-self.seen % self.every, size, self.every)),
        )
        for name, values in block.items():
            if ends > self.columns[name].size:
                self._grow(name, ends, round(1.05 * self._blocks * size))
            kept = self.columns[name][self.held : ends]
            kept[:] = values[start :: self.every]
            self.filled += int(np.count_nonzero(kept == kept))
        self.held = ends
        self.seen += size
        while self.held * len(self.columns) > MOST_CELLS and self.filled > 0.5 * self.held * len(
            self.columns
        ):
            self.halve()

    def _grow(self, name: str, least: int, expected: int) -> None:
        """Room that nobody has written to yet costs nothing."""
        before = self.columns[name]
        self.columns[name] = np.empty(max(least, 2 * before.size, min(expected, MOST_CELLS)))
        self.columns[name][: self.held] = before[: self.held]

    def halve(self) -> None:
        """Every second of the rows held: they stand at multiples of `every`."""
        self.every *= 2
        for values in self.columns.values():
            values[: (self.held + 1) // 2] = values[: self.held : 2].copy()
        self.held = (self.held + 1) // 2
        self.filled //= 2

    def whole(self) -> dict[str, np.ndarray]:
        """The columns (N,) of what was kept, in the file's units."""
        return {name: values[: self.held] for name, values in self.columns.items()}


def collected(
    path: Path,
    names: Sequence[str],
    wanted: Sequence[str],
    separator: str,
    skip: int,
    encoding: str,
    notes: list[str],
) -> dict[str, np.ndarray] | None:
    """The wanted columns whole (of very long tables every k-th row: `notes` says so); None when the
    careful reader must be asked. A column (N,) a name, in the file's units."""
    held = Thinned(wanted, path.stat().st_size / BLOCK + 1.0)
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
    _give_back()
    if not held.held:
        return None
    if held.every > 1:
        notes.append(
            f"{held.seen} rows are more than {MOST_CELLS // len(wanted)}: one row in "
            f"{held.every} was kept. Cut the file into shorter voyages to keep all"
        )
    return held.whole()


def _give_back() -> None:
    """What the reader keeps for its next blocks is memory again."""
    import pyarrow as pa

    pa.default_memory_pool().release_unused()
