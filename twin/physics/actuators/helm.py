"""What is told to the actuators when somebody only says "helm over" and "so much power"."""

from collections.abc import Mapping
from math import pi
from types import MappingProxyType

from twin.physics.ship import Ship
from twin.physics.state import Number

from .actuator import Actuator
from .actuator_channels import DRIVES
from .kinds import SPAN_US, STOP_US

ACROSS = "tunnel_thruster"  # drives no ship ahead
FULL_HELM_RAD = 35.0 * pi / 180.0  # helm at which thrusters that cannot turn give all and nothing


def actuator_orders(
    ship: Ship,
    helm: Number,
    power: Number,
    side: Number = 0.0,
    alone: Mapping[str, Number] = MappingProxyType({}),
) -> dict[str, Number]:
    """`name.attribute` -> value of every actuator. `helm` [rad] is positive to starboard; `power` is a share
    of full (of the turns that drive the ship at service speed where turns are recorded); `side` the same of
    what tunnel thrusters push to starboard; `alone`: the factor on the power of single actuators, by name.

    What turns is turned; a ship with nothing that turns is steered by the thrust of its two sides."""
    turning = any("angle" in a.attributes for a in ship.actuators)
    out: dict[str, Number] = {}
    for a in ship.actuators:
        own = side + 0.0 * power if a.kind == ACROSS else alone[a.name] * power if a.name in alone else power
        for attribute in a.attributes:
            out[f"{a.name}.{attribute}"] = _one(a, attribute, ship, helm, own, turning)
    return out


def _one(a: Actuator, attribute: str, ship: Ship, helm: Number, power: Number, turning: bool) -> Number:
    if attribute == "pitch":
        return a.pitch_0
    if attribute == "angle":
        return helm if a.kind != "azimuth" else (-helm if a.x < 0.0 else helm)
    assert attribute in DRIVES
    if a.kind == ACROSS:
        share = power
    else:
        share = (
            power
            if turning or not a.y
            else power * (1.0 - helm / FULL_HELM_RAD * (1.0 if a.y > 0.0 else -1.0))
        )
    if attribute == "pwm":
        return STOP_US + SPAN_US * share
    if attribute == "rate":
        return share * 1.6 * ship.U_0 / a.D  # advance ratio 0.6
    return share if attribute == "command" else share * 2.0 * ship.scale("force")
