"""Do position, velocity and heading tell of the same motion?

    d(north + i east)/dt = (u + i v) e^{i psi}

Compared as sums over windows, so that no measurement is differentiated. When they disagree, every mistake of
the table is tried, in every scale; the one that makes them agree is named.
"""

from dataclasses import dataclass

import numpy as np

from twin.num import num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.course_and_heading import course_against_heading
from twin.recording.checks.mistakes import AS_THEY_ARE, GEOMETRY, SCALES, Mistake, turned
from twin.recording.checks.voyage_view import VoyageView, fit, rms

NAME = "velocity_frame"
AGREES = 0.12  # share of the distance by which position and velocities may differ
SLIGHT = 0.005  # below this share nothing is concluded
EXPLAINS = 0.35  # a mistake is believed when the difference falls below this share of what it was


@dataclass(frozen=True)
class Legs:
    """The voyage in windows of (first, last) rows; `moved` [m] in each, and the position's `noise` [m]."""

    view: VoyageView
    first: np.ndarray
    last: np.ndarray
    moved: np.ndarray
    noise: float

    @property
    def noise_share(self) -> float:
        """The position's noise, as a share of the distance moved in a window."""
        return self.noise / max(rms(self.moved), 1e-12)

    @property
    def allowed(self) -> float:
        """Share of the distance by which a healthy voyage may differ."""
        return AGREES + 2.0 * self.noise_share

    def summed(self, rate: np.ndarray) -> np.ndarray:
        """(W,) integral of a rate (N,) over each window, in the unit of the rate times s."""
        return self.view.summed(rate, self.first, self.last)

    def miss(self, mistake: Mistake, scale: float = 1.0) -> float:
        """Share of the distance by which the position differs from the velocities, were this the mistake."""
        summed = scale * self.summed(mistake.flow(self.view))
        both = np.isfinite(summed) & np.isfinite(self.moved)
        return rms((self.moved - summed)[both]) / max(rms(self.moved[both]), 1e-12) if both.any() else 0.0


def velocity_frame(view: VoyageView) -> Check:
    """Position against surge, sway and heading."""
    if view.derived("north_m", "surge_velocity_mps"):
        return course_against_heading(NAME, view)
    legs = cut(view)
    if not enough_way(legs):
        far = (
            f"the ship moves {num(rms(legs.moved), 2)} m in a window, the position's noise is "
            f"{num(legs.noise, 2)} m."
        )
        return cannot_tell(NAME, far)
    off = legs.miss(AS_THEY_ARE)
    if off <= legs.allowed:
        return nearly_straight(legs) or sway_sign(legs, off)
    saw = f"position and velocities differ by {100 * off:.0f} % of the distance"
    return named(legs, saw, off) or turned_or_drifting(legs, saw, off) or nothing_known(saw)


def enough_way(legs: Legs) -> bool:
    """Whether the ship moves by more in a window than its position is uncertain."""
    return bool(np.isfinite(legs.moved).any()) and rms(legs.moved) >= 5.0 * legs.noise + 1e-9


def cut(view: VoyageView) -> Legs:
    """Windows of a twentieth of the voyage, a minute at most, and of five samples or more."""
    longest = max(60.0, 50.0 * view.step_s)
    first, last = view.windows(np.clip(view.voyage.duration_s / 20.0, 5.0 * view.step_s, longest))
    return Legs(view, first, last, view.place[last] - view.place[first], position_noise(view.place))


def position_noise(place: np.ndarray) -> float:
    """White noise of the position [m], from its second differences. `place` (N,): north + i east [m]."""
    bend = place[2:] - 2.0 * place[1:-1] + place[:-2]
    return rms(bend) / np.sqrt(6.0)


def nearly_straight(legs: Legs) -> Check | None:
    """A mistake that shows only in small swings of the heading.

    A constant turn of the heading, a factor and an antenna off midship are allowed for before it is believed.
    """
    swing = np.exp(1j * legs.view.psi)
    summed, arm = legs.summed(AS_THEY_ARE.flow(legs.view)), swing[legs.last] - swing[legs.first]
    x, _, left_over = fit([summed, 1j * summed, arm, 1j * arm], legs.moved)
    if not np.isfinite(x).all():  # too few windows
        return None
    best = float(np.sqrt(left_over))
    saw = (
        f"position and velocities differ by {100 * best:.1f} % of the distance whatever the heading's offset"
    )
    left, mistake = min(((legs.miss(m), m) for m in GEOMETRY[1:]), key=lambda t: t[0])
    stream, drifting = steady_stream(legs, saw)
    if best < SLIGHT + 3.0 * legs.noise_share or min(left, stream) > EXPLAINS * best:
        return None
    if stream < left:
        return drifting
    return wrong(NAME, f"{saw}, but by {100 * left:.1f} % if {mistake.text}. In the map: {mistake.fix}.")


def sway_sign(legs: Legs, off: float) -> Check:
    """The rest agrees; sway, small beside surge, is asked for by itself (an antenna off midship allowed)."""
    view, swing = legs.view, np.exp(1j * legs.view.psi)
    ahead = legs.summed(turned(view.velocity.real + 0j, view.psi))
    aside = legs.summed(turned(1j * view.velocity.imag, view.psi))
    x, error, _ = fit([ahead, aside, swing[legs.last] - swing[legs.first]], legs.moved)
    saw = f"position and velocities agree to {100 * off:.1f} % of the distance"
    if error[1] < 0.1 and -1.4 < x[1] < -0.6:
        better = f"{saw}, but better with sway positive to port ({x[1]:.2f})."
        return wrong(NAME, f"{better} In the map: sign = -1 for sway.")
    return good(NAME, f"{saw}.")


def named(legs: Legs, saw: str, off: float) -> Check | None:
    """The mistake and the scale that explain the disagreement."""
    tried = ((legs.miss(m, scale), m, said, fix) for m in GEOMETRY for scale, said, fix in SCALES)
    left, mistake, said, fix = min(tried, key=lambda t: t[0])
    if left > max(EXPLAINS * off, 0.5 * legs.allowed) or left > 2.0 * legs.allowed:
        return None
    also = mistake is not AS_THEY_ARE
    what = " and ".join(([mistake.text] if also else []) + ([said] if said else []))
    do = "; ".join(([mistake.fix] if also else []) + ([fix] if fix else []))
    return wrong(NAME, f"{saw}, but by {100 * left:.0f} % if {what}: that is believed. In the map: {do}.")


def turned_or_drifting(legs: Legs, saw: str, off: float) -> Check | None:
    """A constant turn of the heading, or a steady stream between ship and ground; only a turn can tell."""
    turn, offset = constant_turn(legs, saw)
    stream, drifting = steady_stream(legs, saw)
    least = min(turn, stream)
    if least > max(EXPLAINS * off, 0.5 * legs.allowed):
        return None
    if max(turn, stream) < 2.0 * least + SLIGHT:
        return doubtful(NAME, f"{offset.text} Or: {drifting.text} A turn would tell which.")
    return offset if turn < stream else drifting


def constant_turn(legs: Legs, saw: str) -> tuple[float, Check]:
    """(share of the distance that is left, the answer) if the heading is a constant angle off."""
    summed = legs.summed(AS_THEY_ARE.flow(legs.view))
    (a, b), _, left = fit([summed, 1j * summed], legs.moved)
    angle, factor = float(np.degrees(np.arctan2(b, a))), float(np.hypot(a, b))
    return float(np.sqrt(left)), wrong(
        NAME,
        f"{saw}; the heading is {angle:.1f} deg off and the ground passes {num(factor, 3)} times as fast as "
        "the "
        f"speeds say. A magnetic or grid heading? In the map: offset = {angle:.1f} for it.",
    )


def steady_stream(legs: Legs, saw: str) -> tuple[float, Check]:
    """(share of the distance that is left, the answer) if ship and ground differ by a steady stream."""
    astray = legs.moved - legs.summed(AS_THEY_ARE.flow(legs.view))
    seconds = (legs.last - legs.first) * legs.view.step_s + 0j
    (p, q), _, left = fit([seconds, 1j * seconds], astray)
    speed, towards = float(np.hypot(p, q)), float(np.degrees(np.arctan2(q, p)) % 360.0)
    share = np.sqrt(left) * rms(astray) / max(rms(legs.moved), 1e-12)
    return share, wrong(
        NAME,
        f"{saw}; a steady stream of {speed:.2f} m/s towards {towards:.0f} deg explains it: the velocities "
        "are believed to be through water. In the map call them surge_ and sway_velocity_through_water_mps.",
    )


def nothing_known(saw: str) -> Check:
    """The answer when no known mistake explains what was seen."""
    return doubtful(
        NAME,
        f"{saw}, and no mistake that is known explains it. Look at the units, signs and frames of "
        "position, surge, sway and heading, and at delays between the sensors.",
    )
