"""What engine and helm must tell the loop: rudder and shaft, or every channel of the ship's actuators, and
where each stands until somebody has told."""

from collections.abc import Mapping
from math import remainder

from twin.live.signals.channels import BY_NAME
from twin.physics.actuators.helm import actuator_orders
from twin.physics.ship import Ship
from twin.physics.state import Situation

ONE_SCREW = {"delta": "rudder_angle_deg", "n": "propeller_rate_rpm"}


def controls_of(ship: Ship) -> dict[str, str]:
    """Attribute of physics -> channel."""
    if not ship.actuators:
        return ONE_SCREW
    return {BY_NAME[c].attribute: c for c in actuator_channels(ship)}


def actuator_channels(ship: Ship) -> tuple[str, ...]:
    """Every channel of the ship's actuators by its whole name (`port.rate_rpm`)."""
    return tuple(c for a in ship.actuators for c in a.columns())


def at_rest(ship: Ship) -> dict[str, float]:
    """What actuators are told that give nothing, by `name.attribute` [SI]; of a ship without any {}."""
    return {k: float(x) for k, x in actuator_orders(ship, 0.0, 0.0).items()} if ship.actuators else {}


def nearest_turn(channel: str, value: float, before: float) -> float:
    """An actuator's angle on the turn that is nearest to where it stood before (a pod that goes from 359 to
    1 deg does not swing round astern); any other control as it is. All in SI."""
    turn = BY_NAME[channel].turn * BY_NAME[channel].to_si
    return before + remainder(value - before, turn) if turn else value


def with_measured_controls(s: Situation, si: Mapping[str, float]) -> None:
    """Puts what is measured of the actuators into a situation that had something else of them."""
    if s.orders:
        s.orders = {k: si.get(k, x) for k, x in s.orders.items()}
