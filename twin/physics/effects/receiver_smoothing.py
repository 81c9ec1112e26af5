"""A satellite receiver that smooths course and speed over ground, and not the position.

    d(V_m)/dt = (V - V_m)/time      for the velocity over ground V in earth axes
In the axes of a ship that turns steadily:
    u_m = (u + a v)/(1 + a^2) - time du/dt,   v_m = (v - a u)/(1 + a^2) - time dv/dt,      a = time r
Exact in a steady turn, of first order in what changes besides.
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation


class ReceiverSmoothing(SensorFault):
    """The receiver smooths course and speed over ground, so in a turn they come later than the position
    does."""

    kinematic = True
    of_velocity = True
    suspected_first = True
    by_readings = MappingProxyType({"smoothing": "time"})
    source = (
        "Kaplan & Hegarty (2017) Understanding GPS/GNSS, 3rd ed., ch. 8 and 13 (loop bandwidth, "
        "navigation filter); IEC 61108-1"
    )

    time: float = param(
        1.0,
        unit="s",
        lo=0.0,
        hi=15.0,
        sd=1.0,
        doc="time constant with which course and speed over ground are smoothed",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        a = self.time * s.r
        less = 1.0 / (1.0 + a * a)
        return replace(
            s, u=(s.u + a * s.v) * less - self.time * s.u_dot, v=(s.v - a * s.u) * less - self.time * s.v_dot
        )
