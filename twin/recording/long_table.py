"""Long tables, as historians export them: a row for each reading, its name and its value in two columns.

A map says so with `[file] long = ["NAME COLUMN", "VALUE COLUMN"]`; its columns are then those names.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from twin.errors import DataError, did_you_mean
from twin.recording.mapping import Key
from twin.recording.table import Table
from twin.recording.timebase import TimeAxis

MOST_NAMES, LEAST_READINGS = 300, 8  # names in a long table, and readings of each on average


def widened(
    table: Table, clock: TimeAxis, long: Sequence[str], wanted: Sequence[Key]
) -> tuple[Table, TimeAxis]:
    """The same readings as a table with a column for each wanted name: a row for each instant, in order,
    empty where that was not read. DataError: no reading has such a name."""
    names, values = np.array(table.texts[long[0]]), table.numbers[long[1]]
    known = list(dict.fromkeys(table.texts[long[0]]))
    good = np.isfinite(clock.time_s)
    base, row = np.unique(clock.time_s[good], return_inverse=True)
    columns: dict[Key, np.ndarray] = {}
    for key in wanted:
        here = names[good] == key
        if not here.any():
            raise DataError(
                f"{table.path}: no reading is called {key!r}.{did_you_mean(str(key), known)} There are "
                f"{', '.join(known[:20])}."
            )
        columns[key] = np.full(base.shape, np.nan)
        columns[key][row[here]] = values[good][here]
    lines = np.full(base.shape, np.iinfo(np.int64).max)
    np.minimum.at(lines, row, table.lines[good])
    return replace(table, lines=lines, numbers=columns, texts={}), replace(clock, time_s=base)


def long_columns(
    names: Sequence[str], cells: dict[str, list[str]], numbers: Sequence[str]
) -> tuple[str, str] | None:
    """(column of names, column of values) of a long table; None where it is none. `numbers`: the columns that
    hold numbers."""
    for name in names:
        words = [c for c in cells[name] if c]
        told = Counter(words)
        if name in numbers or not 3 <= len(told) <= MOST_NAMES or len(words) < LEAST_READINGS * len(told):
            continue
        if any(sum(c.isdigit() for c in word) > len(word) / 2 for word in told):
            continue
        runs = sum(a != b for a, b in pairwise(words))
        value = next((n for n in numbers if n.strip().lower() in VALUE_NAMES), "")
        if value and runs > len(told):
            return name, value
    return None


VALUE_NAMES = ("value", "values", "val", "wert", "verdi", "reading", "v", "data", "measurement", "_value")
