"""Does the rudder turn this ship as its sign and unit say?

    dr/dt = b U^2 delta - a U r - d |r| r + c   with b > 0: a rudder to starboard turns the ship to starboard

Nomoto's first order, its gains as they grow with speed, and Norrbin's cubic damping in its quadratic form.
"""

import numpy as np

from twin.num import num
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.voyage_view import VoyageView, fit

RUDDER_SHARE = 0.15  # the rudder must explain this share of the changes of yaw rate to be asked for its sign
HELD_RUDDER_DEG, HELD_TURN_DEG = 5.0, 30.0
PROOF_SHARE = 0.5  # and this share to prove it
WINDOWS_A_NUMBER = 10  # fewer windows for each number that is fitted agree with anything by chance
LEAST_RUDDER_DEG = 0.7  # a ship that manoeuvres with less than this has it in radians


def rudder_sign(view: VoyageView) -> Check:
    """Which way the rudder turns the ship: where it is held over, or by its share in changes of yaw rate."""
    name = "rudder_sign"
    if not view.voyage.has("rudder_angle_deg"):
        return cannot_tell(name, view.not_recorded("rudder"))
    if not view.way_on:
        return cannot_tell(
            name, "it has no way on, and a rudder turns only a ship that moves through the water."
        )
    same, against = held_turns(view)
    if same + against and min(same, against) == 0:
        return sign_seen(
            name, f"with the rudder held over ({same + against} x) the ship turns", same > 0, True
        )
    share, b = best_gain(view)
    saw = f"the rudder explains {100 * share:.0f} % of the changes of yaw rate"
    if share < RUDDER_SHARE:
        return cannot_tell(
            name, f"{saw}; held over until it has turned by {HELD_TURN_DEG:.0f} deg it would show."
        )
    return sign_seen(name, saw, b > 0.0, share > PROOF_SHARE)


def seen_gain(view: VoyageView) -> tuple[float, bool] | None:
    """(share that the rudder explains, whether it turns it to its own side); None where it cannot show."""
    if not view.voyage.has("rudder_angle_deg") or not view.way_on:
        return None
    same, against = held_turns(view)
    if same + against and min(same, against) == 0:
        return 1.0, same > 0
    share, b = best_gain(view)
    return share, b > 0.0


def sign_seen(name: str, saw: str, to_own_side: bool, proved: bool) -> Check:
    """What the side to which the ship turns says of the rudder's sign; `proved`: enough to call it wrong."""
    if to_own_side:
        return good(name, f"{saw}, always to the rudder's own side.")
    believed = "it is believed to be positive to port. In the map: sign = -1 for rudder_angle_deg."
    text = f"{saw}, to the other side: {believed}"
    return wrong(name, text) if proved else doubtful(name, text)


def held_turns(view: VoyageView) -> tuple[int, int]:
    """How often a rudder held over turned the ship by HELD_TURN_DEG: (to its own side, to the other)."""
    rudder = view.even["rudder_angle_deg"]
    most = float(np.nanmax(np.abs(rudder)))
    if not most >= HELD_RUDDER_DEG:
        return 0, 0
    ahead = view.velocity.real > 0.2 * view.speed
    side = np.where((np.abs(rudder) > 0.6 * most) & ahead, np.sign(rudder), 0.0)
    starts = np.flatnonzero(np.r_[True, np.diff(side) != 0.0])
    ends = np.r_[starts[1:], side.size] - 1
    turned = np.degrees(view.psi[ends] - view.psi[starts]) * side[starts]
    return int(np.sum(turned > HELD_TURN_DEG)), int(np.sum(turned < -HELD_TURN_DEG))


def best_gain(view: VoyageView, push: np.ndarray | None = None) -> tuple[float, float]:
    """`rudder_gain` over the window length at which the rudder explains most. `push` (N,): how it turns the
    ship [rad/s2, or another unit that b then has], U^2 delta where it is not given."""
    r = view.si("yaw_rate_degps")
    r = np.where(view.velocity.real > 0.2 * view.speed, r, np.nan)  # astern the rudder works the other way
    if push is None:
        push = view.si("rudder_angle_deg") * np.abs(view.velocity) ** 2
    lengths = view.step_s * np.array([2, 5, 10, 20, 40, 80, 160])
    usable = lengths[lengths < view.voyage.duration_s / 10.0]
    return max((rudder_gain(view, push, r, w) for w in usable), default=(0.0, 0.0))


def rudder_gain(view: VoyageView, push: np.ndarray, r: np.ndarray, seconds: float) -> tuple[float, float]:
    """(share of the changes of r that the rudder explains beside r itself, b). `push` (N,) [rad/s2 over the
    unit of b], how it turns the ship, and `r` (N,) [rad/s] on the view's even grid."""
    first, last = view.windows(seconds)
    change, speed = r[last] - r[first], np.abs(view.velocity)
    held = view.summed(push, first, last)
    damping = [
        view.summed(speed * r, first, last),
        view.summed(np.abs(r) * r, first, last),
        np.ones(first.size),
    ]
    both = np.isfinite(change) & np.isfinite(held) & np.isfinite(damping[0])
    if np.count_nonzero(both) < WINDOWS_A_NUMBER * (1 + len(damping)):
        return 0.0, 0.0
    others = [x[both] for x in damping]
    x, error, left = fit([held[both], *others], change[both])
    without = fit(others, change[both])[2]
    if without <= 0.0 or abs(x[0]) < 4.0 * error[0]:
        return 0.0, 0.0
    return float(1.0 - left / without), float(x[0])


def rudder_unit(view: VoyageView) -> Check:
    """A ship that turns far with a rudder of less than a degree has it in radians."""
    name = "rudder_unit"
    if not view.voyage.has("rudder_angle_deg"):
        return cannot_tell(name, view.not_recorded("rudder"))
    most = float(np.nanmax(np.abs(view.voyage["rudder_angle_deg"])))
    swung = float(np.degrees(np.nanmax(view.psi) - np.nanmin(view.psi)))
    if most == 0.0:
        return cannot_tell(name, "the rudder is 0 all the time.")
    if most >= LEAST_RUDDER_DEG:
        return good(name, f"the rudder reaches {most:.1f} deg.")
    if swung < 20.0:
        return cannot_tell(
            name, f"the rudder stays within {num(most, 2)} deg, and the heading within {swung:.0f} deg."
        )
    return wrong(
        name,
        f"the rudder stays within {num(most, 2)} 'deg' while the heading swings {swung:.0f} deg: it is "
        "believed "
        "to be in "
        'radians. In the map: unit = "rad" for it.',
    )
