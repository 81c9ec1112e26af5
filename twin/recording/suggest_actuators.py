"""The entries of a proposed map for vessels with several actuators, where names say whose a column is."""

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from twin.num import as_given
from twin.recording.columns_seen import SeenColumns
from twin.recording.formats.actuator_guess import PREFERRED, ActuatorGuess, guess_actuator, keys_of

Where = tuple[SeenColumns, str]
ONE_LETTER = re.compile(r".+[_ .-][PSps]")
SIDES_BY_LETTER = {"p": "port", "s": "starboard"}
OTHER_SIDE = {"P": "S", "S": "P", "p": "s", "s": "p"}
MOST_PITCH = 2.5  # over the diameter, of any propeller
OF_FULL_PITCH = "of full pitch? Then factor = pitch over diameter at full pitch. CONFIRM"
CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm", "engine_rate_rpm")


def actuator_columns(files: Sequence[SeenColumns]) -> dict[str, tuple[Where, ActuatorGuess]]:
    """For each channel of each actuator the column that says it best, a feedback before an order; of what
    tells how hard one pushes the best kind alone."""
    best: dict[str, tuple[Where, ActuatorGuess]] = {}
    for seen in files:
        for name in seen.names:
            if not seen.has_numbers(name):
                continue
            found = guess_actuator(
                name_and_place(seen, name, files), seen.numbers(name), seen.units.get(name, "")
            )
            if found and (found.channel not in best or rank(found) > rank(best[found.channel][1])):
                best[found.channel] = (seen, name), found
    return one_drive_each(best)


def name_and_place(seen: SeenColumns, name: str, files: Sequence[SeenColumns]) -> str:
    """What there is to read about a column: of several files also where its own lies, and of RPM_P beside
    RPM_S the side."""
    if side := side_of(name, seen.names):
        return f"{name[:-1]}{side}"
    if len(files) < 2 or seen.groups.get(name):
        return seen.said(name)
    parts = seen.path.with_suffix("").parts
    common = min(
        sum(a == b for a, b in zip(parts, f.path.with_suffix("").parts, strict=False)) for f in files
    )
    return " ".join((*parts[common:], seen.labels.get(name, name)))


def side_of(name: str, names: Sequence[str]) -> str:
    """The side that a single letter behind a name tells where the other side's stands beside it; else
    ""."""
    letter = ONE_LETTER.fullmatch(name)
    other = letter and f"{name[:-1]}{OTHER_SIDE[name[-1]]}"
    return SIDES_BY_LETTER[name[-1].lower()] if other in names else ""


def rank(found: ActuatorGuess) -> tuple[bool, float]:
    """A feedback before an order, then by the words that spoke."""
    return (not found.order or found.last in ("pwm_us", "command"), found.score)


def one_drive_each(best: dict[str, tuple[Where, ActuatorGuess]]) -> dict[str, tuple[Where, ActuatorGuess]]:
    """Without the second best of what says how hard each pushes, and without what only steers where nothing
    pushes."""
    by_owner: dict[str, list[str]] = defaultdict(list)
    for _, found in best.values():
        by_owner[found.owner].append(found.last)
    pushed = {
        o: next(p for p in PREFERRED if p in lasts)
        for o, lasts in by_owner.items()
        if set(lasts) & set(PREFERRED)
    }
    return {
        c: w
        for c, w in best.items()
        if w[1].owner in pushed and (w[1].last not in PREFERRED or w[1].last == pushed[w[1].owner])
    }


def several(found: dict[str, Any]) -> bool:
    """Whether more than one actuator is there."""
    return len({channel.partition(".")[0] for channel in found}) > 1


def why_of(found: ActuatorGuess, values: np.ndarray) -> list[str]:
    """The range, and what a person should look at. `values` (N,) in the unit of the file."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    said = [f"{as_given(low, 6)} to {as_given(high, 6)}"]
    said += ["an order, not what was measured"] * (found.order and found.last not in ("pwm_us", "command"))
    said += [OF_FULL_PITCH] * (found.last == "pitch_ratio" and float(np.nanmax(np.abs(values))) > MOST_PITCH)
    return [*said, "sign? CONFIRM"] if found.last in ("pwm_us", "command", "thrust_n") else said


def entry_keys(where: Where, found: ActuatorGuess) -> dict[str, Any]:
    """The keys of the map's entry."""
    seen, name = where
    return {"column": seen.key(name), **keys_of(found, seen.numbers(name))}


def shared_rudder(columns: dict[str, Any], rudder: Any) -> dict[str, Any]:
    """One rudder angle behind several shafts: it is each one's."""
    owners = dict.fromkeys(c.partition(".")[0] for c in columns if c.endswith(".rate_rpm"))
    return {f"{o}.angle_deg": rudder for o in owners if f"{o}.angle_deg" not in columns}


def means_of_two(columns: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Of two rudders behind two shafts, read alike, the entries of their means, as a ship file with one
    rudder and one propeller has them; none where there are other actuators. `columns`: channel -> keys."""
    owners = list(dict.fromkeys(c.partition(".")[0] for c in columns if "." in c))
    out = {}
    for channel, last in zip(CONTROLS, ("angle_deg", "rate_rpm"), strict=False):
        both = [columns.get(f"{owner}.{last}", {}) for owner in owners]
        how = [{k: v for k, v in keys.items() if k != "column"} for keys in both]
        if len(both) != 2 or not all(both) or how[0] != how[1]:
            return {}
        out[channel] = {"column": [keys["column"] for keys in both], "factors": [0.5, 0.5], **how[0]}
    return out
