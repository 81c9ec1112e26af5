"""Gates of a ship's actuators: how fast each of their channels can change, by the actuator's own size.

An order may jump, so a share, a pulse width and a thrust may be anything within the table's range. Turns and
angles are gated: turns beyond FASTEST U_0/D are none, and from one sample to the next they change by no more
than that in FULL_S.
"""

from dataclasses import replace
from math import inf

from twin.live.gates.gate import Gate
from twin.live.signals.channels import BY_NAME
from twin.physics.actuators import Actuator
from twin.physics.maths import DEG
from twin.physics.ship import Ship

FASTEST = 15.0  # of U_0/D: three times what a thruster turns that slips as one does at a fifth of its pitch
FULL_S = 0.5  # the least time from stop to there
ANGLE_DEGPS, ANGLE_DEG = 400.0, 3.0  # a small outboard's servo; an angle's noise
OF_FULL = 0.02  # share of the greatest turns that noise may be


def gates_of(ship: Ship, sources: dict[str, str]) -> dict[str, Gate]:
    """By channel, those of every actuator; {} of a ship with one propeller and one rudder."""
    return {name: _gate(a, name, ship, sources.get(name)) for a in ship.actuators for name in a.columns()}


def _gate(a: Actuator, name: str, ship: Ship, source: str | None) -> Gate:
    channel = BY_NAME[name]
    if channel.attribute.endswith(".angle"):
        unit = DEG / channel.to_si  # of a degree in what is recorded
        turning = replace(channel, max_rate=ANGLE_DEGPS * unit, wraps=360.0 * unit)
        return Gate(turning, ANGLE_DEG * unit, source=source)
    if channel.attribute.endswith(".rate") and a.D is not None:
        full = FASTEST * ship.U_0 / a.D / channel.to_si
        gate = Gate(replace(channel, max_rate=full / FULL_S), OF_FULL * full, source=source)
        gate.low, gate.high = max(channel.low, -full), min(channel.high, full)
        return gate
    return Gate(channel, inf, source=source)
