"""Do heading and yaw rate tell of the same turning?    d psi/dt = r, compared as sums over windows."""

import numpy as np

from twin.num import num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.voyage_view import VoyageView, fit, rms
from twin.recording.units import DEG_PER_RAD

RATES = (
    (1.0, "", ""),
    (-1.0, "it is positive to port", "sign = -1"),
    (DEG_PER_RAD, "it is in rad/s", 'unit = "rad/s"'),
    (-DEG_PER_RAD, "it is in rad/s and positive to port", 'unit = "rad/s", sign = -1'),
    (1.0 / 60.0, "it is in deg/min", 'unit = "deg/min"'),
    (-1.0 / 60.0, "it is in deg/min and positive to port", 'unit = "deg/min", sign = -1'),
    (1.0 / DEG_PER_RAD, "the heading is in radians", 'unit = "rad" for the heading'),
    (1e-3, "the time is in milliseconds", '[time] unit = "ms"'),
    (60.0, "the time is in minutes", '[time] unit = "min"'),
    (3600.0, "the time is in hours", '[time] unit = "h"'),
)


def window_s(view: VoyageView) -> float:
    """How long a window is [s]: a fiftieth of the voyage, five samples or more, half a minute at most."""
    return float(np.clip(view.voyage.duration_s / 50.0, 5.0 * view.step_s, 30.0))


def turned(view: VoyageView) -> tuple[np.ndarray, np.ndarray]:
    """(change of the heading, summed rate) [rad] in each window. Each (W,)."""
    first, last = view.windows(window_s(view))
    return view.psi[last] - view.psi[first], view.summed(view.si("yaw_rate_degps"), first, last)


def turning_ratio(view: VoyageView) -> tuple[float, float] | None:
    """(how much the heading turns for one radian of summed rate, share of its turning left over); None: too
    little turning."""
    swung, summed = turned(view)
    (k, _), (error, _), left = fit([summed, np.ones(summed.size)], swung)
    turn = np.degrees(rms(swung))
    if not np.isfinite(k) or (turn < 0.5 and np.degrees(rms(summed)) < 5.0):
        return None
    if (left > 0.5 or error > 0.3 * abs(k)) and turn < 2.0 and rms(summed) < 3.0 * rms(swung):
        return None
    return float(k), float(left)


def yaw_rate(view: VoyageView) -> Check:
    """The heading's change against the summed yaw rate."""
    name = "yaw_rate"
    if view.derived("yaw_rate_degps"):
        return cannot_tell(name, "no yaw rate was recorded; it is derived from the heading.")
    seconds = window_s(view)
    swung, summed = turned(view)
    (k, _), (error, _), left = fit([summed, np.ones(summed.size)], swung)
    turn = np.degrees(rms(swung))
    if not np.isfinite(k) or (turn < 0.5 and np.degrees(rms(summed)) < 5.0):
        return cannot_tell(
            name, f"the heading changes by {num(turn, 2)} deg in {num(seconds, 3)} s; a turn would show it."
        )
    ratio, said, fix = min(RATES, key=lambda c: abs(np.log(abs(k / c[0]))) if k * c[0] > 0 else np.inf)
    saw = f"the heading turns by {num(k, 3)} x the summed yaw rate"
    if left > 0.5 or error > 0.3 * abs(k):
        if rms(summed) < 3.0 * rms(swung) and turn < 2.0:
            return cannot_tell(
                name,
                f"the heading changes by {num(turn, 2)} deg in {num(seconds, 3)} s, too little beside the "
                "noise.",
            )
        return doubtful(
            name, f"heading and yaw rate do not tell of the same turning ({100 * left:.0f} % of it is left)."
        )
    if 0.75 < k < 1.33:
        return good(name, f"{saw} (1 expected).")
    if abs(np.log(abs(k / ratio))) < 0.25:
        return wrong(name, f"{saw}: {said}, that is believed. In the map: {fix}.")
    return doubtful(
        name, f"{saw}, and no known unit explains it. Look at the units of yaw rate, heading and time."
    )
