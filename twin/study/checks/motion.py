"""Do position, velocity, heading and yaw rate tell of the same motion?

    d(north + i east)/dt = (u + i v) e^{i psi}         d psi/dt = r

Both are compared as sums over windows, so that no measurement is differentiated. When they disagree, every mistake of a
list is tried; the one that makes them agree is named.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from twin.study.checks.answer import Check, cannot_tell, doubtful, good, wrong
from twin.study.checks.view import View, fit, rms
from twin.study.units import DEG_PER_RAD, KNOT_MPS

AGREES = 0.12  # share of the distance by which position and velocities may differ
SLIGHT = 0.005  # below this share nothing is concluded
EXPLAINS = 0.35  # a mistake is believed when the difference falls below this share of what it was
Flow = Callable[[View], np.ndarray]


@dataclass(frozen=True)
class Mistake:
    """What the columns may really be, how velocity over the earth reads then, and what to write in the map."""

    text: str
    flow: Flow  # View -> velocity, north + i east [m/s]
    fix: str


def turned(w: np.ndarray, psi: np.ndarray) -> np.ndarray:
    return w * np.exp(1j * psi)


AS_THEY_ARE = Mistake("as they are", lambda a: turned(a.velocity, a.psi), "")
GEOMETRY = (
    AS_THEY_ARE,
    Mistake("surge and sway are earth-fixed (dx/dt and dy/dt)", lambda a: a.velocity, 'frame = "earth" for both'),
    Mistake(
        "surge and sway are earth-fixed and swapped (east, north)", lambda a: 1j * a.velocity.conj(),
        'frame = "earth" for both, and swap their columns',
    ),
    Mistake("north and east are swapped", lambda a: 1j * turned(a.velocity, a.psi).conj(), "swap their columns"),
    Mistake("surge and sway are swapped", lambda a: turned(1j * a.velocity.conj(), a.psi), "swap their columns"),
    Mistake("surge is positive astern", lambda a: turned(-a.velocity.conj(), a.psi), "sign = -1 for surge"),
    Mistake("surge and sway have the other sign", lambda a: turned(-a.velocity, a.psi), "sign = -1 for both"),
    Mistake("sway is positive to port", lambda a: turned(a.velocity.conj(), a.psi), "sign = -1 for sway"),
    Mistake("the heading is in radians", lambda a: turned(a.velocity, a.psi * DEG_PER_RAD), 'unit = "rad" for it'),
    Mistake(
        "the heading counts anticlockwise from east", lambda a: turned(a.velocity, np.pi / 2 - a.psi),
        "sign = -1 and offset = 90 for it",
    ),
    Mistake("the heading counts anticlockwise", lambda a: turned(a.velocity, -a.psi), "sign = -1 for it"),
    Mistake("the heading is 90 deg too small", lambda a: turned(a.velocity, a.psi + np.pi / 2), "offset = 90 for it"),
    Mistake("the heading is 90 deg too large", lambda a: turned(a.velocity, a.psi - np.pi / 2), "offset = -90 for it"),
    Mistake("east is positive to the west", lambda a: turned(a.velocity, a.psi).conj(), "sign = -1 for east_m"),
    Mistake("north is positive to the south", lambda a: -turned(a.velocity, a.psi).conj(), "sign = -1 for north_m"),
)  # fmt: skip
SCALES = (
    (1.0, "", ""),
    (KNOT_MPS, "the speeds are in knots", 'unit = "kn" for surge and sway'),
    (1.0 / 3.6, "the speeds are in km/h", 'unit = "km/h" for surge and sway'),
    (0.3048, "the speeds are in ft/s", 'unit = "ft/s" for surge and sway'),
    (1.0 / 0.3048, "the positions are in feet", 'unit = "ft" for them'),
    (
        1e-3,
        "the time is in milliseconds, or the positions in km",
        '[time] unit = "ms", or unit = "km" for positions',
    ),
    (60.0, "the time is in minutes", '[time] unit = "min"'),
    (3600.0, "the time is in hours", '[time] unit = "h"'),
)


def velocity_frame(view: View) -> Check:
    """Position against surge, sway and heading."""
    name = "velocity_frame"
    if view.derived("north_m", "surge_velocity_mps"):
        return course_against_heading(name, view)
    first, last = view.windows(
        np.clip(view.voyage.duration_s / 20.0, 5.0 * view.step_s, max(60.0, 50.0 * view.step_s))
    )
    moved = view.place[last] - view.place[first]
    noise = position_noise(view.place)
    way = rms(moved)
    if not np.isfinite(moved).any() or way < 5.0 * noise + 1e-9:
        return cannot_tell(
            name, f"the ship moves {way:.2g} m in a window, the position's noise is {noise:.2g} m."
        )
    allowed = AGREES + 2.0 * noise / way
    off = miss(view, AS_THEY_ARE, 1.0, moved, first, last)
    if off <= allowed:
        return nearly_straight(name, view, moved, first, last, noise / way) or sway_sign(
            name, view, moved, first, last, off
        )
    return named(name, view, moved, first, last, off, allowed)


def miss(
    view: View, m: Mistake, scale: float, moved: np.ndarray, first: np.ndarray, last: np.ndarray
) -> float:
    """Share of the distance by which the position differs from the summed velocities."""
    summed = scale * view.summed(m.flow(view), first, last)
    both = np.isfinite(summed) & np.isfinite(moved)
    return rms((moved - summed)[both]) / max(rms(moved[both]), 1e-12) if both.any() else 0.0


def nearly_straight(
    name: str, view: View, moved: np.ndarray, first: np.ndarray, last: np.ndarray, noise: float
) -> Check | None:
    """A mistake that shows only in small swings of the heading; a constant turn and an antenna off midship are allowed."""
    swing = np.exp(1j * view.psi)
    summed, arm = view.summed(AS_THEY_ARE.flow(view), first, last), swing[last] - swing[first]
    best = float(np.sqrt(fit([summed, 1j * summed, arm, 1j * arm], moved)[2]))
    left, m = min(((miss(view, m, 1.0, moved, first, last), m) for m in GEOMETRY[1:]), key=lambda t: t[0])
    if best < SLIGHT + 3.0 * noise or left > EXPLAINS * best:
        return None
    return wrong(
        name,
        f"position and velocities differ by {100 * best:.1f} % of the distance whatever the heading's offset, but by "
        f"{100 * left:.1f} % if {m.text}: that is believed. In the map: {m.fix}.",
    )


def named(
    name: str, view: View, moved: np.ndarray, first: np.ndarray, last: np.ndarray, off: float, allowed: float
) -> Check:
    """The mistake that explains the disagreement, or that none does."""
    tried = sorted(
        ((miss(view, m, s, moved, first, last), m, said, fix) for m in GEOMETRY for s, said, fix in SCALES),
        key=lambda t: t[0],
    )
    left, m, said, fix = tried[0]
    saw = f"position and velocities differ by {100 * off:.0f} % of the distance"
    if left <= max(EXPLAINS * off, 0.5 * allowed) and left <= 2.0 * allowed:
        what = " and ".join(t for t in (m.text if m is not AS_THEY_ARE else "", said) if t)
        do = "; ".join(t for t in (m.fix, fix) if t)
        return wrong(name, f"{saw}, but by {100 * left:.0f} % if {what}: that is believed. In the map: {do}.")
    flow = AS_THEY_ARE.flow(view)
    summed = view.summed(flow, first, last)
    return turned_or_drifting(name, saw, moved, summed, (last - first) * view.step_s, off, allowed)


def turned_or_drifting(
    name: str,
    saw: str,
    moved: np.ndarray,
    summed: np.ndarray,
    seconds: np.ndarray,
    off: float,
    allowed: float,
) -> Check:
    """A constant turn of the heading, a constant factor, or a constant stream between ship and ground."""
    (a, b), _, left = fit([summed, 1j * summed], moved)
    size, angle = float(np.hypot(a, b)), float(np.degrees(np.arctan2(b, a)))
    (p, q), _, streaming = fit([seconds + 0j, 1j * seconds], moved - summed)
    if np.sqrt(left) < EXPLAINS * off + allowed / 2.0:
        do = f"If the heading is magnetic or grid, offset = {angle:.1f} for it; speeds off by a factor {size:.3g}."
        return wrong(
            name,
            f"{saw}; the heading is {angle:.1f} deg off and the speeds {size:.3g} of the true ones. {do}",
        )
    if np.sqrt(streaming) < EXPLAINS:
        return wrong(
            name,
            f"{saw}; a steady stream of {np.hypot(p, q):.2f} m/s towards {np.degrees(np.arctan2(q, p)) % 360:.0f} deg "
            "explains it, so the velocities are believed to be through water. In the map call them "
            "surge_ and sway_velocity_through_water_mps.",
        )
    return doubtful(
        name,
        f"{saw}, and no mistake that is known explains it. Look at the units, signs and frames of position, surge, "
        "sway and heading, and at delays between the sensors.",
    )


def sway_sign(
    name: str, view: View, moved: np.ndarray, first: np.ndarray, last: np.ndarray, off: float
) -> Check:
    """The rest agrees; sway is small beside surge and is asked for by itself (an antenna off midship is allowed for)."""
    swing = np.exp(1j * view.psi)
    ahead = view.summed(turned(view.velocity.real + 0j, view.psi), first, last)
    aside = view.summed(turned(1j * view.velocity.imag, view.psi), first, last)
    x, error, _ = fit([ahead, aside, swing[last] - swing[first]], moved)
    saw = f"position and velocities agree to {100 * off:.1f} % of the distance"
    if error[1] < 0.1 and -1.4 < x[1] < -0.6:
        return wrong(
            name,
            f"{saw}, but better with sway positive to port ({x[1]:.2f}). In the map: sign = -1 for sway.",
        )
    return good(name, f"{saw}.")


def course_against_heading(name: str, view: View) -> Check:
    """Without an independent position: a ship goes nearly where she points."""
    w = view.velocity[np.abs(view.velocity) > 0.3 * view.speed]
    psi = view.psi[np.abs(view.velocity) > 0.3 * view.speed]
    keep = np.isfinite(w) & np.isfinite(psi)
    w, psi = w[keep], psi[keep]
    if w.size < 10 or view.speed < 0.02:
        return cannot_tell(name, "the ship hardly moves, and position and velocities are not independent.")
    drift, earth = rms(np.angle(w)), rms(np.angle(w * np.exp(-1j * psi)))
    saw = f"drift angle {np.degrees(drift):.0f} deg rms"
    if view.speed > 40.0:
        return wrong(
            name,
            f"the ship makes {view.speed:.3g} m/s: is the time in minutes or hours, the position in feet?",
        )
    if drift > np.radians(8.0) and earth < 0.5 * drift and not view.derived("surge_velocity_mps"):
        return wrong(
            name,
            f"{saw}, but {np.degrees(earth):.0f} deg if surge and sway are earth-fixed (dx/dt and dy/dt): that is "
            'believed. In the map: frame = "earth" for both.',
        )
    mean = float(np.degrees(np.angle(np.mean(w / np.abs(w)))))
    if abs(mean) > 45.0:
        return doubtful(
            name,
            f"the ship moves {mean:.0f} deg off her heading on average: are heading, north and east right?",
        )
    return good(name, f"{saw}; position and velocities are not independent, so no more can be said.")


def position_noise(place: np.ndarray) -> float:
    """White noise of the position [m], from its second differences."""
    bend = place[2:] - 2.0 * place[1:-1] + place[:-2]
    return rms(bend) / np.sqrt(6.0)


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


def yaw_rate(view: View) -> Check:
    """The heading's change against the summed yaw rate."""
    name = "yaw_rate"
    if view.derived("yaw_rate_degps"):
        return cannot_tell(name, "no yaw rate was recorded; it is derived from the heading.")
    first, last = view.windows(np.clip(view.voyage.duration_s / 50.0, 5.0 * view.step_s, 30.0))
    swung = view.psi[last] - view.psi[first]
    summed = view.summed(view.si("yaw_rate_degps"), first, last)
    (k, _), (error, _), left = fit([summed, np.ones(summed.size)], swung)
    turn = np.degrees(rms(swung))
    if not np.isfinite(k) or (turn < 0.5 and np.degrees(rms(summed)) < 5.0):
        return cannot_tell(name, f"the heading changes by {turn:.2g} deg in a window; a turn would show it.")
    ratio, said, fix = min(RATES, key=lambda c: abs(np.log(abs(k / c[0]))) if k * c[0] > 0 else np.inf)
    saw = f"the heading turns {k:.3g} times the summed yaw rate"
    if left > 0.5 or error > 0.3 * abs(k):
        if rms(summed) < 3.0 * rms(swung) and turn < 2.0:
            return cannot_tell(
                name, f"the heading changes by {turn:.2g} deg in a window, too little beside the noise."
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
