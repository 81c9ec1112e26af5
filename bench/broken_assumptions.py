"""Which assumption of the certificate a lying instrument exceeds, and by how much (docs/stability.md, section
2): A4 by a reading of motion or heading, A3 by what rudder and shaft are said to do. The bound does not rest
on positions or the log: to lie about them exceeds none."""

from collections.abc import Sequence
from math import cos, radians, sin
from typing import NamedTuple

import numpy as np

from bench.lie_kinds import Row
from twin.live.loop import Loop
from twin.live.signals.derive import turn
from twin.physics import core
from twin.physics.core import Tau
from twin.physics.model import Model
from twin.study.reference.split import SplitVoyage

MOTION = ("surge_velocity_mps", "sway_velocity_mps", "yaw_rate_degps", "heading_true_north_deg")
CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm")
NONE = ""


class Exceeded(NamedTuple):
    """How far a lie goes, in shares of the limit of the assumption (A3, A4, or none) that it comes nearest
    to."""

    share: float = 0.0
    assumption: str = NONE

    @property
    def breaks(self) -> bool:
        """Whether it is beyond that limit."""
        return self.share > 1.0


def exceeded(loop: Loop, voyage: SplitVoyage, k: int, honest: Row, lied: Row) -> Exceeded:
    """Of one row, the k-th of the voyage, of what the instruments say and should say."""
    tube = loop.stabilizer.tube
    assert tube is not None
    noise = (*tube.noise, tube.heading_noise)
    readings = [
        _off(name, honest, lied) / most for name, most in zip(MOTION, noise, strict=True) if name in lied
    ]
    disturbance, saturation = tube.certificate.disturbance.at(voyage.H_s), tube.certificate.saturation
    force = [
        abs(a - b) / (most - learned)
        for a, b, most, learned in zip(
            _moved_by(loop, voyage, k, lied),
            _moved_by(loop, voyage, k, honest),
            disturbance,
            saturation,
            strict=True,
        )
    ]
    return max(Exceeded(_greatest(readings), "A4"), Exceeded(_greatest(force), "A3"))


def _off(name: str, honest: Row, lied: Row) -> float:
    """How far a reading is off [m/s, rad/s, rad]; NaN where there is none."""
    by = lied[name] - honest[name]
    if name == "heading_true_north_deg":
        return abs(turn(radians(by)))
    return abs(radians(by) if name == "yaw_rate_degps" else by)


def _moved_by(loop: Loop, voyage: SplitVoyage, k: int, row: Row) -> Tau:
    """What propeller and rudder do to the ship as these readings have them [N, N, N m]."""
    c, psi = Model.of(loop.ship).c, float(voyage.psi[k])
    (u, v, r), (north, east) = voyage.nu[:, k].tolist(), voyage.current[:, k].tolist()
    u, v = u - north * cos(psi) - east * sin(psi), v + north * sin(psi) - east * cos(psi)
    delta, n = radians(row[CONTROLS[0]]), row[CONTROLS[1]] / 60.0
    thrust = core.thrust(u, n, c)
    parts = core.propeller(thrust, c), core.rudder(u, v, r, delta, thrust, c)
    X, Y, N = np.array(parts, float).sum(axis=0).tolist()
    return X, Y, N


def _greatest(shares: Sequence[float]) -> float:
    return max((x for x in shares if x == x), default=0.0)
