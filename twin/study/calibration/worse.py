"""Whether a calibration made its ship's model worse, and what to sail then.

A calibrated ship file is written only when its open-loop error on what was not used for the fit did not
grow: a fit to short or one-sided voyages may explain them and lead the ship astray everywhere else."""

from collections.abc import Mapping, Sequence
from math import log
from typing import Any

import numpy as np

from twin.num import num
from twin.physics.ship import Ship
from twin.study.reference.path_error import MEANS
from twin.study.reference.path_error import of_ship as path_error_of

GREW = 0.05  # mean logarithm of the errors in place and heading over all horizons, from which they grew
FASTEST = 3.0  # times service speed: a model that gets farther off than that ran away
# what a ship does that a model knows nothing of, by where its error stands: under way, or at one place
KNOWING_NOTHING = {"kept_m": "keeping its speeds", "stood_m": "standing still"}
# what excites the numbers of hull and screw whose names begin so, all others of the hull, and the rudder's
MANOEUVRES = (
    (("X_", "K_T"), "speed changes from stop to full and back"),
    (("",), "zigzags and full turns to both sides at two speeds"),
)
ALONE = "stretches on which one actuator works alone"  # what excites a number that names its actuator


def refusal(ship: Ship, held_out: Sequence[Mapping[str, Any]], unexcited: Sequence[str]) -> str:
    """Why the uncalibrated numbers are kept: which horizon, before and after, and what to sail; "" when the
    error did not grow. `held_out`: by horizon, the errors after the fit and before it, and those of
    predictions that know nothing (held_out.knowing_nothing)."""
    judged = [e for e in held_out if e["windows"]]
    if not judged:
        return ""
    away = [e for e in judged if ran_away(ship, e)]
    idle = knows_nothing(judged)
    if not away and not idle and growth(judged) <= GREW:
        return ""
    e = max(away or judged, key=lambda e: e["position_m"] / max(e["before_m"], 1e-9))
    what = "runs away" if away else "is worse than the one it began from"
    if idle and not away:
        what += f", and in place worse than {KNOWING_NOTHING[idle]} ({_far(e[idle])})"
    before = f"{_far(e['before_m'])} and {num(e['before_deg'], 3)} deg"
    after = f"{_far(e['position_m'])} and {num(e['heading_deg'], 3)} deg"
    return (
        f"the calibrated model {what}: after {e['horizon_s']:.0f} s it is {before} off before and {after} "
        "after, on what was not used for the fit. The uncalibrated numbers are kept. Give longer reference "
        f"voyages on which nothing is wrong, with {to_sail(unexcited)}."
    )


def away_on_references(calibrated: Ship, unexcited: Sequence[str]) -> str:
    """Why a ship is not written that runs away on its own reference voyages, each left out in turn, though
    what was held back did not show it; "" when it does not. SettingsError: its file is damaged."""
    path = path_error_of(calibrated)
    if path is None:
        return ""
    reach = FASTEST * float(calibrated.U_0) * path.horizons_s
    away = np.flatnonzero(path.mean[:, MEANS.index("position_m")] > reach)
    if not away.size:
        return ""
    h = path.horizons_s[away[0]]
    return (
        f"the calibrated model runs away on its reference voyages, each left out in turn: after {h:.0f} s "
        f"it is {_far(path.expected('position_m', [h])[0])} off in the mean. The uncalibrated numbers are "
        f"kept. Give longer reference voyages on which nothing is wrong, with {to_sail(unexcited)}."
    )


def ran_away(ship: Ship, entry: Mapping[str, Any]) -> bool:
    """Whether the mean error is farther than the ship gets, and it was not before."""
    reach = FASTEST * float(ship.U_0) * entry["horizon_s"]
    return bool(entry["position_m"] > reach >= entry["before_m"])


def growth(judged: Sequence[Mapping[str, Any]]) -> float:
    """Mean logarithm of after over before, in place and heading over all horizons."""
    return 0.5 * (_grew(judged, "position_m", "before_m") + _grew(judged, "heading_deg", "before_deg"))


def knows_nothing(judged: Sequence[Mapping[str, Any]]) -> str:
    """The nearer of the predictions KNOWING_NOTHING, if the model got farther off in place than it was, and
    than that prediction, over all horizons: a better heading does not make up for that. "" if it did not."""
    told = [key for key in KNOWING_NOTHING if _all(judged, key)]
    if not told or _grew(judged, "position_m", "before_m") <= GREW:
        return ""
    grew = {key: _grew(judged, "position_m", key) for key in told}
    nearer = max(told, key=lambda key: grew[key])
    return nearer if grew[nearer] > GREW else ""


def _all(entries: Sequence[Mapping[str, Any]], key: str) -> bool:
    return all(np.isfinite(e.get(key, np.nan)) for e in entries)


def _grew(entries: Sequence[Mapping[str, Any]], after: str, before: str) -> float:
    """Mean logarithm of one error over another."""
    logs = [log(max(e[after], 1e-9) / max(e[before], 1e-9)) for e in entries]
    return sum(logs) / max(len(logs), 1)


def to_sail(unexcited: Sequence[str]) -> str:
    """Manoeuvres that show what these voyages left open."""
    out = list[str]()
    for name in unexcited or ("X_", "Y_"):
        what = ALONE if "." in name else next(w for starts, w in MANOEUVRES if name.startswith(starts))
        if what not in out:
            out.append(what)
    return " and ".join((", ".join(out[:-1]), out[-1])) if len(out) > 1 else out[0]


def _far(metres: float) -> str:
    return f"{num(metres, 3)} m" if metres < 1e4 else f"{num(metres / 1e3, 3)} km"
