"""The steering gear: after a dead time the rudder follows its order at no more than its greatest rate, and
eases into it.

Only where the recorded rudder is the order: an angle that is measured behind the gear hides it.

delta(t + h) = delta + clip((order(t - delay) - delta) h/(h + ease), -rate h, rate h),
    rate = 65 deg / travel_time
which for long steps is the order itself: h/(h + ease) is a step of d(delta)/dt = (order - delta)/ease that is
stable for any h."""

from math import pi

from twin.physics.effect import Lag, param
from twin.physics.maths import clip
from twin.physics.state import Number

TRAVEL = 65.0 * pi / 180.0  # 35 deg on one side to 30 deg on the other, SOLAS II-1/29
TINY = 1e-9  # s


class SteeringLag(Lag):
    """The rudder answers late and slowly: the gear's dead time, its greatest rate and how it eases into an
    angle stand between order and angle."""

    copies = ("ease",)
    one_screw = True
    role = "gear"
    ages = ("delay",)
    with_core = "the recorded rudder angle is its order"
    source = "SOLAS II-1/29 (65 deg in 28 s); Van Amerongen (1982) Adaptive steering of ships, ch. 2"

    delay: float = param(
        0.05,
        unit="s",
        lo=0.0,
        hi=0.5,
        sd=0.05,
        of="time",
        form=0.5,
        doc="dead time between order and movement",
    )
    travel_time: float = param(
        0.7,
        unit="s",
        lo=0.0,
        hi=10.0,
        sd=1.0,
        of="time",
        doc="35 deg one side to 30 deg the other, at full rate",
    )
    ease: float = param(
        0.0,
        unit="s",
        lo=0.0,
        hi=2.0,
        sd=0.3,
        of="time",
        form=0.5,
        doc="time constant with which the gear slows down near its order",
    )

    def dead_time(self) -> Number:
        return self.delay

    def step(self, actual: Number, order: Number, h: Number) -> Number:
        most = h * TRAVEL / (self.travel_time + TINY)
        return actual + clip((order - actual) * ((h + TINY) / (h + TINY + self.ease)), -most, most)
