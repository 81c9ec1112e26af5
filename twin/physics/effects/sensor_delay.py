"""GNSS is late: what it says now was true `delay` seconds ago.

    (x, y)_m = (x, y) - delay R(psi - r delay/2) (u - du/dt delay/2, v - dv/dt delay/2)
        the velocity of half the delay ago
    u_m = u_late cos(a) + v_late sin(a),   u_late = u - delay du/dt
    v_m = v_late cos(a) - u_late sin(a),   v_late = v - delay dv/dt
    a = turned (r + (turned/2 - delay) dr/dt)
        what the ship turns from the moment that is shown to the one in which it is turned
`turned` = delay where a late velocity over ground is turned into body axes by the present heading (a
    compass), and 0 where
the receiver does so itself by an attitude of its own (an inertial unit). Second order in the turning: of
first order alone, a boat that turns fast would seem to have its antenna elsewhere.
"""

from dataclasses import replace
from types import MappingProxyType

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.ship_like import ShipLike
from twin.physics.state import Number, Situation


class SensorDelay(SensorFault):
    """Satellite position and velocity come late, so the ship seems to lag behind itself on the track."""

    ages = ("delay",)
    turning = "turned"
    by_readings = MappingProxyType({"gnss_delay": "delay"})
    source = (
        "Skog & Haendel (2011) Time synchronization errors in loosely coupled GPS-aided INS, IEEE "
        "Trans. ITS 12, 1014-1023"
    )

    delay: float = param(
        0.6, unit="s", lo=0.0, hi=6.0, sd=0.6, doc="age of position and velocity over ground"
    )
    turned: float = param(
        0.0,
        unit="s",
        lo=0.0,
        hi=6.0,
        sd=0.6,
        doc="age of the turning of the velocity: delay, or 0 (see above)",
    )

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        d, half = self.delay, 0.5 * self.delay
        u, v, psi = s.u - half * s.u_dot, s.v - half * s.v_dot, s.psi - half * s.r
        c, si = cos(psi), sin(psi)
        late_u, late_v = s.u - d * s.u_dot, s.v - d * s.v_dot
        a = self.turned * (s.r + (0.5 * self.turned - d) * s.r_dot)
        turned_c, turned_s = cos(a), sin(a)
        return replace(
            s,
            x=s.x - d * (u * c - v * si),
            y=s.y - d * (u * si + v * c),
            u=late_u * turned_c + late_v * turned_s,
            v=late_v * turned_c - late_u * turned_s,
        )

    def prompt(self) -> tuple[Number, SensorFault]:
        return self.delay, self.but(delay=0.0)
