"""Shaft and rudder against what the ship does: the force that its equations lack, if both are where their
feedback says.

    lacking = M (nu_hat(t) - nu_hat(0) - integral of nu_dot(model)) / t          over blocks of time

A model is never exact, so a share of the forces at work is allowed, and a rudder's worth of SLACK; what is
beyond counts. Of the rudder only while its feedback stands: one that moves is not stuck. An estimate that
began at one noisy sample is pulled to its place for SETTLED/K, and that pull is no force: till then nothing
counts.
"""

from math import inf, radians
from typing import NamedTuple

from twin.live.gates.cusum import Cusum
from twin.live.gates.rudder_feedback import HULL, RUDDER, Helm
from twin.live.observer.dynamics import Forces, KnownDynamics
from twin.live.observer.observer import Observer
from twin.live.observer.operating import propeller_rate
from twin.live.signals.measured import Measured
from twin.physics.model import CORE, Model
from twin.physics.ship import Ship
from twin.physics.state import Situation

SHAFT_SAID = "propeller_rate_rpm against the speed: the ship moves as if the shaft turned otherwise"
RUDDER_SAID = "rudder_angle_deg against the turning: the ship turns as if the rudder stood otherwise"
PROPELLER = CORE.index("propeller")
RUDDER_REST_RAD = radians(0.5)
SLACK, OF_MOMENTS = radians(4.0), 0.15  # as in rudder_feedback.py
OF_FORCES = 0.35
SETTLED = 3.0  # time constants of the observer: a twentieth of the first sample's noise is left
USUAL_BLOCKS = 8.0  # over which the moment that is lacking is taken to be usual, while the rudder moves
# blocks in L/U_0, and their least length [s]: for calm water, and to see through waves
FAST, SLOW = (1.0 / 16.0, 0.5), (0.25, 4.0)


class CorrectedTick(NamedTuple):
    """One tick as the checks see it: what is measured, the estimate corrected by it, and the known forces in
    it."""

    measured: Measured
    observer: Observer
    s: Situation
    physics: KnownDynamics
    forces: Forces
    dt: float  # [s] since the last one


class Lacking:
    """Fed with every tick; `reasons` say which feedback the ship contradicts."""

    def __init__(self, ship: Ship, block: tuple[float, float] = FAST):
        self.block_s = max(block[0] * ship.L_pp / ship.U_0, block[1])
        self.U_0 = ship.U_0
        self.per_rad = Helm._moment_of_a_radian(ship)
        model = Model(ship, ())
        at = Situation(u=model.loaded.U_0, n=propeller_rate(model))
        self.thrust = abs(float(model.forces(at, model.water(Situation()))[PROPELLER][0]))
        self._shaft, self._rudder = Cusum(0.03, 0.3), Cusum(radians(1.0), 0.0)
        self._stands: float | None = None  # where the feedback stands [rad]
        self._usual = 0.0  # rudder's worth of moment that was lacking while it moved
        self._start: tuple[float, ...] | None = None
        self._sums = [0.0] * 8
        self._restarts, self._settles_s = -1, 0.0

    @property
    def reasons(self) -> list[str]:
        """Which feedback the ship contradicts, in words."""
        return [SHAFT_SAID] * self._shaft.alarm + [RUDDER_SAID] * self._rudder.alarm

    def pause(self) -> None:
        """The measurements have a hole: begin a new stretch."""
        self._start = None

    def feed(self, now: CorrectedTick) -> None:
        """One tick; the observer's `rates` are those that carried the estimate to now."""
        measured, observer, s, physics, forces, dt = now
        e = observer.estimate
        if (
            not e.ready
            or not measured.has("u", "r", "delta", "n", "psi")
            or measured.derived & {"u", "r", "psi"}
            or measured.steps
        ):
            self._start = None
            return
        if observer.restarts != self._restarts:
            self._restarts, self._settles_s, self._start = observer.restarts, SETTLED / observer.gain, None
        if self._settles_s > 0.0:
            self._settles_s -= dt
            return
        if self._start is None:
            self._begin(e.u, e.v, e.r)
            return
        rates, sums = observer.rates, self._sums
        at_work = abs(float(forces[HULL][0])) + abs(float(forces[PROPELLER][0]))
        turning = abs(float(forces[HULL][2])) + abs(float(forces[RUDDER][2]))
        new = (rates.u, rates.v, rates.r, at_work, turning, float(s.delta), 1.0, abs(e.u))
        for i, x in enumerate(new):
            sums[i] += x * dt
        if sums[6] >= self.block_s - 1e-6:
            self._judge((e.u, e.v, e.r), s, physics)
            self._begin(e.u, e.v, e.r)

    def _begin(self, u: float, v: float, r: float) -> None:
        self._start, self._sums = (u, v, r), [0.0] * 8

    def _judge(self, nu: tuple[float, float, float], s: Situation, physics: KnownDynamics) -> None:
        assert self._start is not None
        span = self._sums[6]
        u_dot, v_dot, r_dot = (
            (now - then - due) / span for now, then, due in zip(nu, self._start, self._sums[:3], strict=True)
        )
        X, _, N = physics.force_for(u_dot, v_dot, r_dot, s.grown)
        _, _, _, at_work, turning, delta, _, speed = (total / span for total in self._sums)
        self._shaft.feed(float(X) / self.thrust, OF_FORCES * at_work / self.thrust)
        self._turning(float(N), turning, self.per_rad * max((speed / self.U_0) ** 2, 0.1), delta)

    def _turning(self, N: float, at_work: float, per_rad: float, delta: float) -> None:
        """What the moment that is lacking has changed by, in rudder angle, since the feedback came to stand;
        while it moves nothing counts."""
        lacks = N / per_rad
        if self._stands is None or abs(delta - self._stands) > RUDDER_REST_RAD:
            self._stands = delta
            self._usual += (lacks - self._usual) / USUAL_BLOCKS
            self._rudder.feed(lacks - self._usual, inf)
        else:
            self._rudder.feed(lacks - self._usual, SLACK + OF_MOMENTS * at_work / per_rad)
