"""Play between steering gear and rudder: a worn linkage, coupling or key, behind the place where the angle is
measured.

The rudder stays where it is until the gear has taken up the play on the other side: |angle shown - delta| <=
gap."""

from math import pi

from twin.physics.effect import Lag, param
from twin.physics.maths import clip
from twin.physics.state import Number


class RudderPlay(Lag):
    """The rudder hangs loose in its linkage: it stops short of the angle that is shown, on either side, and
    lags behind each time it turns back."""

    one_screw = True
    source = (
        "Tao & Kokotovic (1996) Adaptive control of systems with actuator and sensor nonlinearities, "
        "ch. 2 (backlash)"
    )

    gap: float = param(
        2.0 * pi / 180.0,
        unit="rad",
        lo=0.0,
        hi=12.0 * pi / 180.0,
        sd=3.0 * pi / 180.0,
        doc="half of the play, at the rudder",
    )

    def dead_time(self) -> Number:
        return 0.0

    def step(self, actual: Number, order: Number, h: Number) -> Number:
        return clip(actual, order - self.gap, order + self.gap)
