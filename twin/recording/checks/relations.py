"""What must agree on any ship, each as one number: how far it is off, in parts of what a healthy voyage may
be.

place      position and velocity tell of the same way made good
turning    heading and rate of turn tell of the same turning
course     under way the ship goes nearly where it points
rudder     way on, a rudder over to starboard turns it to starboard
thrust     with a steady speed and its shaft turning ahead it goes ahead
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from twin.recording.checks.mistakes import AS_THEY_ARE
from twin.recording.checks.motion import cut, enough_way
from twin.recording.checks.rudder import RUDDER_SHARE, seen_gain
from twin.recording.checks.turning import turning_ratio
from twin.recording.checks.undo import by_heading
from twin.recording.checks.voyage_view import VoyageView, rms

MEAN_DRIFT, USUAL_DRIFT = np.radians(45.0), np.radians(40.0)  # more is no drift of a ship under way
ASTERN = 0.25  # share of the time under way, steady, that may go against the shaft
STEADY = 0.1  # change of speed in a window, in usual speeds
TURNS_ON = 0.3  # of the largest usual shaft rate: the thrust is on
LEAST_PAIRS = 10
WORST = 8.0  # a relation that is broken is broken


@dataclass(frozen=True)
class Relation:
    """`off(view)`: 0 to 1 agrees, above it does not; None: this voyage cannot tell. `usual`: what a healthy
    voyage shows."""

    name: str
    off: Callable[[VoyageView], float | None]
    usual: float


def place(view: VoyageView) -> float | None:
    """Position against velocity and heading: the miss, over what a healthy voyage may have."""
    if view.derived("north_m", "surge_velocity_mps"):
        return None
    legs = cut(view)
    return legs.miss(AS_THEY_ARE) / legs.allowed if enough_way(legs) else None


def turning(view: VoyageView) -> float | None:
    """Yaw rate against heading: the worse of its factor and of what it leaves unexplained, over what is
    healthy."""
    seen = turning_ratio(view)
    if view.derived("yaw_rate_degps") or seen is None:
        return None
    k, left = seen
    return max(WORST if k <= 0.0 else abs(np.log(k)) / np.log(1.33), left / 0.5)


def over_ground(view: VoyageView) -> np.ndarray | None:
    """(N,) complex. velocity over the earth [m/s] that the heading had no part in; None where there is
    none."""
    if by_heading(view.voyage) and not view.derived("surge_velocity_mps"):
        return view.velocity * np.exp(1j * view.psi)
    if view.derived("north_m"):
        return None
    first, last = np.arange(len(view.even) - 1), np.arange(1, len(view.even))
    span = max(round(10.0 / view.step_s), 1)
    first, last = np.maximum(first - span // 2, 0), np.minimum(last + span // 2, len(view.even) - 1)
    rate = (view.place[last] - view.place[first]) / ((last - first) * view.step_s)
    return np.r_[rate, rate[-1:]]


def drift(view: VoyageView) -> np.ndarray | None:
    """(N,) the angle from the heading to the way over ground [rad], where it has way on; None where there
    is none."""
    way = over_ground(view)
    if way is None:
        way = view.velocity * np.exp(1j * view.psi)
    if not view.way_on:
        return None
    under_way = np.abs(way) > 0.4 * view.speed
    beta = np.angle(way * np.exp(-1j * view.psi))
    return (
        np.where(under_way, beta, np.nan)
        if np.count_nonzero(np.isfinite(beta[under_way])) >= LEAST_PAIRS
        else None
    )


def course(view: VoyageView) -> float | None:
    """Heading against the way over ground: the larger of the mean drift angle over MEAN_DRIFT and its rms
    over USUAL_DRIFT."""
    beta = drift(view)
    if beta is None:
        return None
    mean = abs(np.angle(np.nanmean(np.exp(1j * beta))))
    return float(max(mean / MEAN_DRIFT, rms(beta) / USUAL_DRIFT))


def rudder(view: VoyageView) -> float | None:
    """Rudder against yaw rate: 0 when the ship turns to the rudder's side, above 1 when it turns to the
    other."""
    seen = seen_gain(view)
    if seen is None or seen[0] < RUDDER_SHARE:
        return None
    share, to_own_side = seen
    return 0.0 if to_own_side else 1.0 + 4.0 * share


def thrust(view: VoyageView) -> float | None:
    """Propeller rate against speed ahead: share of steady windows in which they have different signs, over
    ASTERN."""
    n, u = view.si("propeller_rate_rpm"), view.velocity.real
    if not np.isfinite(n).any() or not view.way_on:
        return None
    first, last = view.windows(max(20.0, 5.0 * view.step_s))
    steady = np.abs(u[last] - u[first]) < STEADY * view.speed
    turns, way = view.summed(n, first, last), view.summed(u, first, last)
    if not np.isfinite(turns).any():
        return None
    on = (
        steady
        & (np.abs(turns) > TURNS_ON * np.nanquantile(np.abs(turns), 0.9))
        & (np.abs(way) > 0.4 * view.speed * 20.0)
    )
    on &= np.abs(turns) > 0.0
    return float(np.mean(turns[on] * way[on] < 0.0) / ASTERN) if np.count_nonzero(on) >= LEAST_PAIRS else None


RELATIONS: tuple[Relation, ...] = (
    Relation("place", place, 0.1),
    Relation("turning", turning, 0.1),
    Relation("course", course, 0.3),
    Relation("rudder", rudder, 1.0),
    Relation("thrust", thrust, 0.3),
)
USUAL_SCATTER = {relation.name: relation.usual for relation in RELATIONS}


def offs(view: VoyageView) -> dict[str, float | None]:
    """Every relation of a voyage."""
    out: dict[str, float | None] = {}
    for relation in RELATIONS:
        value = relation.off(view)
        out[relation.name] = None if value is None or not np.isfinite(value) else min(float(value), WORST)
    return out
