"""GNSS is late: what it says now was true `delay` seconds ago, to first order in the delay.

    (x, y)_m = (x, y) - delay R(psi) (u, v)
    u_m = u + delay r v,   v_m = v - delay r u      (the velocity's turning; its change of size is second to it and left out)
"""

from dataclasses import replace

from twin.physics.effect import SensorFault, param
from twin.physics.maths import cos, sin
from twin.physics.state import Situation


class SensorDelay(SensorFault):
    """Satellite position and velocity come late, so she seems to lag behind herself on the track."""

    source = "Skog & Haendel (2011) Time synchronization errors in loosely coupled GPS-aided INS, IEEE Trans. ITS 12, 1014-1023, eq. (4)"

    delay: float = param(0.6, unit="s", lo=0.0, hi=6.0, sd=0.6, doc="age of position and velocity over ground")

    def read(self, s: Situation, ship: object) -> Situation:
        c, si, d = cos(s.psi), sin(s.psi), self.delay
        return replace(
            s,
            x=s.x - d * (s.u * c - s.v * si),
            y=s.y - d * (s.u * si + s.v * c),
            u=s.u + d * s.r * s.v,
            v=s.v - d * s.r * s.u,
        )
