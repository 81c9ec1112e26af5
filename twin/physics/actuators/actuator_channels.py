"""What may be recorded of an actuator: the last part of a channel's name, behind the actuator's own."""

from math import pi
from typing import NamedTuple

from twin.physics.maths import DEG

ANGLE = "angle: see the actuator's kind"


class ActuatorChannel(NamedTuple):
    """One channel of one actuator; `attribute` is its name inside physics and `to_si` the factor there."""

    attribute: str
    to_si: float
    low: float
    high: float
    doc: str
    unit: str
    turn: float = 0.0  # of an angle: by how much two readings of one direction may differ


CHANNELS_OF: dict[str, ActuatorChannel] = {
    "command": ActuatorChannel(
        "command", 1.0, -1.5, 1.5, "order as a share of full ahead, negative astern", "-"
    ),
    "pwm_us": ActuatorChannel("pwm", 1.0, 500.0, 2500.0, "pulse width of its controller, 1500 is stop", "us"),
    "rate_rpm": ActuatorChannel("rate", 1.0 / 60.0, -20000.0, 20000.0, "turns, positive ahead", "1/min"),
    "rate_rev_s": ActuatorChannel("rate", 1.0, -330.0, 330.0, "turns, positive ahead", "1/s"),
    "thrust_n": ActuatorChannel("thrust", 1.0, -1e7, 1e7, "thrust, positive ahead", "N"),
    "angle_deg": ActuatorChannel("angle", DEG, -720.0, 720.0, ANGLE, "deg", 360.0),
    "angle_rad": ActuatorChannel("angle", 1.0, -13.0, 13.0, ANGLE, "rad", 2.0 * pi),
    "pitch_ratio": ActuatorChannel("pitch", 1.0, -2.5, 2.5, "pitch over diameter, positive ahead", "-"),
}
DRIVES = ("command", "pwm", "rate", "thrust")  # one of them says how hard it pushes


def attribute_of(channel: str) -> str:
    """What a channel (`rate_rpm`, or `port.rate_rpm`) is called inside physics (`rate`, `port.rate`)."""
    name, dot, last = channel.rpartition(".")
    return f"{name}{dot}{CHANNELS_OF[last].attribute}"
