"""What is told to an actuator while the ship lies still: that is its stop.

A ship that is pushed by a share c of its thrust goes at sqrt(c) of its speed, for resistance grows with the
square of it.
"""

from itertools import pairwise

import numpy as np

from twin.num import as_given, num
from twin.physics.actuators import Actuator
from twin.physics.actuators.actuator_channels import DRIVES
from twin.physics.actuators.kinds import SPAN_US, STOP_US
from twin.physics.ship import Ship
from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.checks.wirings import OrderArrays

LONG_S = 8.0  # told the same for so long, and so many ship lengths at service speed
LENGTHS = 10.0
RUNNING_OUT = 0.25  # of that time, in which it may still be running out
HELD = {"pwm": 2.0, "command": 0.005}  # by which what is told may stray meanwhile
DRIFT_SHARE = 0.05  # of service speed: it drifts no faster, and yaws no faster over its length
DRIVEN = 4.0  # times its speed that what is told should give


def actuator_zero(view: VoyageView) -> Check:
    """Commands and pulse widths at which the ship lay still against those at which its file says that its
    actuators stand still."""
    name = "actuator_zero"
    ship = view.ship
    parts = () if ship is None else tuple(a for a in ship.actuators if _drive(a) in HELD)
    if ship is None or not parts:
        return cannot_tell(name, "no ship file with actuators that are told a command or a pulse width.")
    if not all(view.voyage.has(*a.columns()) for a in ship.actuators):
        return cannot_tell(name, "not every actuator was recorded.")
    rests = _rests(view, ship, parts)
    if not rests:
        still, seconds = DRIFT_SHARE * float(ship.U_0), _least_s(ship) / (1.0 - RUNNING_OUT)
        return cannot_tell(
            name,
            f"it never lies still (below {num(still, 2)} m/s over ground) for {seconds:.0f} s with its "
            "actuators told the same.",
        )
    first, last = max(rests, key=lambda ab: ab[1] - ab[0])
    told = {a.name: float(np.median(view.si(_channel(a))[first:last])) for a in parts}
    speed = float(np.median(np.abs(view.velocity[first:last])))
    pushed = {a.name: _share(a, told[a.name]) for a in parts}
    driven = float(ship.U_0) * abs(sum(pushed.values()) / len(parts)) ** 0.5
    saw = f"it lies still ({num(speed, 2)} m/s) for {(last - first) * view.step_s:.0f} s while " + ", ".join(
        f"{a.name} is told {as_given(told[a.name], 5)}" for a in parts
    )
    if driven < DRIVEN * max(speed, DRIFT_SHARE * float(ship.U_0) / DRIVEN):
        return good(name, f"{saw}, at which the ship file has it stand still.")
    zeros = ", ".join(
        f"{num(_share_ordered(a, told[a.name]), 3)} for {a.name}" for a in parts if pushed[a.name]
    )
    return doubtful(
        name,
        f"{saw}; by its ship file that would drive it at {num(driven, 2)} m/s or more: that is their stop. "
        f"In the ship file: zero = {zeros}.",
    )


def _drive(a: Actuator) -> str:
    return next(n for n in a.attributes if n in DRIVES)


def _channel(a: Actuator) -> str:
    return dict(zip(a.attributes, a.columns(), strict=True))[_drive(a)]


def _share_ordered(a: Actuator, told: float) -> float:
    return (told - STOP_US) / SPAN_US if _drive(a) == "pwm" else told


def _share(a: Actuator, told: float) -> float:
    """Share of its thrust ahead that it gives at rest, by its bollard curve; with the sign of its push."""
    c = _share_ordered(a, told) - float(a.zero)
    e = max(abs(c) - float(a.dead), 0.0) / (1.0 - float(a.dead))
    full = 1.0 if c > 0.0 else float(a.astern) / float(a.ahead)
    return float(np.sign(c)) * full * float(a.linear + (1.0 - a.linear) * e) * e


def _least_s(ship: Ship) -> float:
    """How long it must lie still [s], when it has run out."""
    return max(LONG_S, LENGTHS * float(ship.scale("time")))


def _rests(view: VoyageView, ship: Ship, parts: tuple[Actuator, ...]) -> list[tuple[int, int]]:
    """From where to where it lay still, all of them told the same."""
    told: OrderArrays = {a.name: view.si(_channel(a)) for a in parts}
    still = (np.abs(view.velocity) < DRIFT_SHARE * float(ship.U_0)) & (
        np.abs(view.si("yaw_rate_degps")) < DRIFT_SHARE * float(ship.U_0) / float(ship.L_pp)
    )
    changes = np.zeros(still.size, bool)
    for a in parts:
        changes[1:] |= np.abs(np.diff(told[a.name])) > HELD[_drive(a)]
    cut = np.flatnonzero(changes | ~still)
    least = _least_s(ship) / view.step_s
    out = []
    for a, b in pairwise([-1, *cut.tolist(), still.size]):
        start = a + 1 + round(RUNNING_OUT * (b - a))
        if b - start > least:
            out.append((start, b))
    return out
