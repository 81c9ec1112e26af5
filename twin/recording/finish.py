"""From a file's samples to what a voyage is made of: rows without a time left out, what no ship can do
blanked, what is absent derived."""

from typing import Any, NamedTuple

import numpy as np

from twin.errors import DataError
from twin.live.signals.channels import of_actuators
from twin.recording.mapping import PLACES
from twin.recording.out_of_range import out_of_range_in_words
from twin.recording.place import CHART, FRAMED, derive, present
from twin.recording.raw import Raw
from twin.recording.samples import plausible
from twin.recording.second_reading import no_second_reading
from twin.recording.timebase import (
    rebuilt,
    refuse_backwards,
    refuse_leaps,
    refuse_standing,
)

FEWEST_ROWS = 10
CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm")


class Finished(NamedTuple):
    """What a `Voyage` is made of, in its order."""

    name: str
    time_s: np.ndarray
    columns: dict[str, np.ndarray]
    meta: dict[str, Any]


def finished(raw: Raw, controls: bool = True) -> Finished:
    """What a voyage is made of: rows without a time left out, implausible samples blanked, what
    is absent derived."""
    with_time(raw)
    refuse_leaps(raw.path, raw.lines, raw.time_s)
    refuse_backwards(raw.path, raw.lines, raw.time_s)
    if raw.rebuild is not False:
        raw.time_s, how = rebuilt(raw.path, raw.time_s, raw.rebuild)
        raw.notes.append(how)
    refuse_standing(raw.path, raw.time_s)
    for name, values in raw.columns.items():
        raw.columns[name], blanked, lie = plausible(name, values, raw.lines)
        raw.notes += blanked
        if lie:
            raw.meta["out_of_range"] = raw.meta.get("out_of_range", {}) | {name: lie}
    require(raw, controls)
    columns, derived = derive(raw.time_s, raw.columns)
    meta = {k: v for k, v in raw.meta.items() if v}
    derived = meta.get("derived", {}) | derived
    meta["derived"] = derived | no_second_reading(raw.time_s, columns, derived)
    meta["notes"] = (*meta.get("notes", ()), *raw.notes)
    meta["lost"] = (*meta.get("lost", ()), *raw.lost)
    return Finished(meta.pop("name", raw.path.stem), raw.time_s, columns, meta)


def with_time(raw: Raw) -> None:
    """Leaves out the rows without a time; DataError when too few are left."""
    keep = np.isfinite(raw.time_s)
    rows = int(np.count_nonzero(keep))
    if rows < FEWEST_ROWS:
        kind = f"this is {raw.meta['format']}; it " if "format" in raw.meta else ""
        raise DataError(
            f"{raw.path}: {kind}has {rows} rows with a time; at least {FEWEST_ROWS} are needed. "
            "Is it the right time column?"
        )
    if rows < keep.size:
        raw.notes.append(
            f"{keep.size - rows} rows without a time left out (first in line {raw.lines[~keep][0]})"
        )
        raw.time_s, raw.lines = raw.time_s[keep], raw.lines[keep]
        raw.columns = {name: x[keep] for name, x in raw.columns.items()}


def tells_why(note: str, missing: list[str]) -> bool:
    """Whether a note tells of what is missing, of what was left out, or of how numbers were read."""
    return (
        note.startswith(("not used", "left out"))
        or any(name in note for name in missing)
        or "is not used" in note
        or "blanked" in note
        or "decimal" in note
    )


def require(raw: Raw, controls: bool = True) -> None:
    """Heading, controls, and position or velocity must hold samples; DataError names all that do not."""
    parts = any(present(raw.columns, name) for name in of_actuators(raw.columns))
    needed = ("heading_true_north_deg", *(CONTROLS if controls and not parts else ()))
    missing = [name for name in needed if not present(raw.columns, name)]
    if not present(raw.columns, *CHART) and not present(raw.columns, *FRAMED):
        missing.append(f"{' and '.join(CHART)} (or {' and '.join(PLACES)}, or {' and '.join(FRAMED)})")
    if missing:
        empty = [n for n in raw.columns if not present(raw.columns, n)]
        said = [f"{', '.join(empty)}: no usable sample"] * bool(empty) + [
            n[:200] for n in raw.notes if tells_why(n, missing)
        ][:4]
        outside, units = raw.meta.get("out_of_range", {}), raw.meta.get("units", {})
        said += [
            out_of_range_in_words(n, outside[n], units.get(n)).removesuffix(".")
            for n in missing
            if n in outside
        ]
        steady = " A shaft that kept one speed may stand under [constant]." * (CONTROLS[1] in missing)
        needs = ", ".join(missing)
        for control in [name for name in missing if name in CONTROLS][-1:]:
            needs = needs.replace(control, f"{control} (or the channels of actuators, as port.command)")
        kind = f"this is {raw.meta['format']}; a voyage " if "format" in raw.meta else ""
        raise DataError(
            f"{raw.path}: {kind}needs {needs}. {'; '.join(said)}{'. ' if said else ''}Add the column, or say "
            f"in a map which one it is (twin import --map; under [columns] {missing[0].split()[0]} = "
            f'"COLUMN" leaves the others as they are; --suggest-map writes one).{steady}'
            + " What is judged without the controls is imported with "
            "--without-controls." * (set(missing) <= set(CONTROLS) - set(outside))
        )
