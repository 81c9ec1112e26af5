"""Where a table's names stand: under lines of a title, beside a line of groups, above a line of units.

The rows of a table are those in which most cells are numbers or moments. Of the lines above the first of
them, as wide as it, one may be of units; the names are the line with most words; a line above them that has
fewer words is one of groups (`Port | | Starboard`), whose words hold for the empty cells behind them.
"""

import re
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from twin.recording.formats.name_words import unit_in

NUMBER_LIKE = re.compile(r"[-+]?[\d.,:/°'\"\s+-]*\d[\d.,:/°'\"\s+-]*([eE][-+]?\d+)?\s*[A-Za-z%]{0,3}")
STAMP_LIKE = re.compile(r".*\d{1,4}[-/. ]\w{1,4}[-/. ]\d{1,4}.*|.*\d\d?:\d\d.*")
NOTHING = frozenset(
    ("", "-", "--", "[-]", "(-)", "n/a", "none", "text", "utc", "hh:mm:ss", "[utc]", "dd.mm.yyyy")
)
MOST_ROWS = 40  # lines above the first row at most


class HeaderRows(NamedTuple):
    """`names_at`: the line of names (from 0), `rows_at`: the first row under it; `groups` and `units` by
    column, "" where there is none."""

    names_at: int
    rows_at: int
    groups: list[str]
    units: list[str]


def is_value(cell: str) -> bool:
    """Whether a cell is a number or a moment."""
    return bool(NUMBER_LIKE.fullmatch(cell) or STAMP_LIKE.fullmatch(cell))


def is_row(cells: Sequence[str]) -> bool:
    """Whether most cells of a line are numbers or moments."""
    filled = [c for c in cells if c.strip().lower() not in NOTHING]
    return bool(filled) and sum(map(is_value, (c.strip() for c in filled))) > 0.5 * len(filled)


def is_units(cells: Sequence[str]) -> bool:
    """Whether a line holds units, and nothing else but marks of none."""
    filled = [c.strip().strip("[]()") for c in cells if c.strip().lower() not in NOTHING]
    return bool(filled) and sum(bool(unit_in(c)) for c in filled) >= 0.6 * len(filled)


def header_rows(lines: Sequence[Sequence[str]]) -> HeaderRows | None:
    """The header of a table by its first lines, each cut into cells; None: its first line is a row, or none
    is."""
    wide = Counter(len(c) for c in lines if is_row(c)).most_common(1)
    if not wide:
        return None
    width = wide[0][0]
    first = next(
        (
            i
            for i, c in enumerate(lines)
            if is_row(c) and len(c) >= width and all(map(is_row, lines[i + 1 : i + 3]))
        ),
        None,
    )
    if not first or first > MOST_ROWS:
        return None
    above = [i for i in range(first) if len(lines[i]) >= min(width, 2) and any(c.strip() for c in lines[i])]
    full = [i for i in above if len(lines[i]) >= width - 1 and not is_row(lines[i])]
    units_at = next((i for i in reversed(full) if is_units(lines[i])), None)
    named = [i for i in full if i != units_at]
    if not named:
        return None
    names_at = max(named, key=lambda i: (len({c.strip() for c in lines[i] if c.strip()}), i))
    over = [i for i in named if i < names_at]
    groups = filled_right(lines[over[-1]], width) if over else [""] * width
    units = [c.strip() for c in lines[units_at]] if units_at is not None else []
    return HeaderRows(names_at, first, groups, (units + [""] * width)[:width])


def filled_right(cells: Sequence[str], width: int) -> list[str]:
    """Each empty cell says what the one before it says."""
    out: list[str] = []
    for cell in (*cells, *[""] * width)[:width]:
        out.append(cell.strip() or (out[-1] if out else ""))
    return out


def own_labels(names: Sequence[str], groups: Sequence[str]) -> list[str]:
    """Names that are told apart: with their group where it is needed, else with the word again."""
    bare = [n.strip() for n in names]
    many = Counter(bare)
    out: list[str] = []
    for i, name in enumerate(bare):
        group = groups[i] if i < len(groups) else ""
        label = f"{group} {name}".strip() if group and (many[name] > 1 or not name) else name
        while label and label in out:
            label += " again"
        out.append(label)
    return out
