"""The learned force: trained last layer and adapted part on the trunk's features, inside a ball it can
never leave.

    f = w [W phi + g A q],  |f| <= bound (in units of the force scale S),  force = S f

w is how far the features may be believed. Without a residual the force is zero, and says why.
"""

from copy import copy
from dataclasses import dataclass, field
from math import sqrt

from twin.live.gates.rudder_feedback import helm_of
from twin.live.learning.adapt import Adaptation
from twin.live.learning.filtered_regression import Evidence, Three
from twin.live.learning.movable import movable
from twin.live.learning.residual import Residual
from twin.live.observer.dynamics import Forces, KnownDynamics
from twin.physics.effect import Effect
from twin.physics.ship import Ship
from twin.physics.state import Force, Situation

LEARN_S = 0.095  # learning is slow: ten times a second is enough
ZERO = Force(0.0, 0.0, 0.0)


@dataclass(slots=True)
class Learned:
    """What the twin learned to add: `force` acts, `shadow` (in S) is what would, were it allowed to;
    `trained` is W phi alone."""

    force: Force = ZERO
    shadow: Three = (0.0, 0.0, 0.0)
    trained: Three = (0.0, 0.0, 0.0)
    weight: float = 0.0
    bound_N: float = 0.0
    bound_Nm: float = 0.0
    clipped: bool = False
    why: str = ""
    components: list[float] = field(default_factory=list)  # whitened, of the network's features


class LearnedForce:
    """Residual and adaptation together; `at` has no memory, so the predictor uses it too."""

    def __init__(self, ship: Ship, residual: Residual | None, why_not: str = "", adapt: bool = True):
        self.ship, self.residual, self.why_not = ship, residual, why_not
        self.scale = residual.manifest.force_scale if residual else scale_of(ship)
        self.bound = residual.manifest.output_bound if residual else 0.0
        rows = residual.manifest.whitening[1] if residual and residual.manifest.whitening else ()
        learns = adapt and (residual is not None or bool(movable(ship.effects, ship)))
        self.adaptation = Adaptation(ship, self.scale, len(rows), residual is not None) if learns else None
        self.evidence, self.helm = Evidence(ship, self.scale), helm_of(ship)
        self.bound_N = self.bound * max(self.scale.X, self.scale.Y)
        self.bound_Nm = self.bound * self.scale.N
        self._waited_s = 0.0

    def at(self, s: Situation, forces: Forces, allowed: bool = True) -> Learned:
        """The learned force of one situation (s.u_r, s.v_r set) beside its known ones."""
        if self.residual is None:
            return Learned(why=self.why_not)
        said, components, w, why = self.residual.features(s)
        if w == 0.0:
            return Learned(why=why, bound_N=self.bound_N, bound_Nm=self.bound_Nm)
        trained = x, y, n = w * said[0], w * said[1], w * said[2]
        clipped = x * x + y * y + n * n > self.bound * self.bound  # the network alone; adaptation may press
        adaptation = self.adaptation
        if adaptation is not None and adaptation.open:
            ax, ay, an = adaptation.correction(adaptation.regressors(components, forces))
            x, y, n = x + w * ax, y + w * ay, n + w * an
        size = sqrt(x * x + y * y + n * n)
        if size > self.bound:
            x, y, n = x * self.bound / size, y * self.bound / size, n * self.bound / size
        S = self.scale
        force = Force(x * S[0], y * S[1], n * S[2]) if allowed else ZERO
        return Learned(
            force,
            (x, y, n),
            trained,
            w if allowed else 0.0,
            self.bound_N,
            self.bound_Nm,
            clipped,
            why,
            components,
        )

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The ship's named effects with the numbers that act."""
        return self.adaptation.named.effects if self.adaptation else self.ship.effects

    def as_known_now(self) -> "LearnedForce":
        """A copy that does not learn on: what a prediction made now may use."""
        kept = copy(self)
        kept.adaptation = self.adaptation.held() if self.adaptation else None
        return kept

    def share(self, learned: Learned, forces: Forces) -> float:
        """The learned force's part of all force, each summed by its size."""
        if learned.weight == 0.0:
            return 0.0
        x, y, n = learned.shadow
        size = abs(x) + abs(y) + abs(n)
        for X, Y, N in forces:
            x, y, n = (
                abs(x) + abs(X / self.scale[0]),
                abs(y) + abs(Y / self.scale[1]),
                abs(n) + abs(N / self.scale[2]),
            )
        return size / (abs(x) + abs(y) + abs(n) or 1.0)

    def learn(
        self,
        nu: Three | None,
        s: Situation,
        forces: Forces,
        learned: Learned,
        physics: KnownDynamics,
        dt: float,
        frozen: str,
    ) -> None:
        """Weigh the evidence of one tick (`nu` None: not measured), and adapt unless `frozen` says why
        not."""
        self._waited_s += dt
        adaptation = self.adaptation
        if (self.residual is None and adaptation is None) or (
            0.0 <= self._waited_s < LEARN_S and nu is not None
        ):
            return
        dt, self._waited_s = self._waited_s, 0.0
        if nu is None or not 0.0 < dt < 1.0:
            self.evidence.pause()
            self.helm.pause()
            if adaptation:
                adaptation.frozen = frozen or "speed, rate of turn or controls are not measured"
            return
        evidence = self.evidence
        regressors = adaptation.regressors(learned.components, forces) if adaptation else []
        named = adaptation.named if adaptation else None
        if named:
            columns = named.columns.at(s, forces, physics, learned.force)
            regressors = [*regressors, *columns, *named.shift(columns)]
        evidence.feed(
            nu, physics.rates_of(s, forces), learned.shadow, learned.trained, regressors, physics, dt, s.grown
        )
        if evidence.ready:
            self._doubt_the_helm(s, forces, dt)
        frozen = frozen or self.helm.stuck or self.helm.resting
        if adaptation:
            frozen = frozen or ("" if evidence.ready else "has just begun")
            dx, dy, dn = evidence.unexplained
            tx, ty, tn = evidence.trained
            regressors, (sx, sy, sn) = (
                (evidence.regressors[:-3], evidence.regressors[-3:]) if named else (evidence.regressors, ZERO)
            )
            adaptation.learn((dx - tx + sx, dy - ty + sy, dn - tn + sn), regressors, dt, frozen)

    def _doubt_the_helm(self, s: Situation, forces: Forces, dt: float) -> None:
        """What a rudder that stands still taught counts once it has moved again, and is taken back when it
        does not."""
        came_to_stand = self.helm.feed(s, forces, self.evidence.left_over * self.scale.N, dt)
        if self.adaptation and came_to_stand:
            self.adaptation.remember()
        if self.adaptation and (self.helm.stuck or self.helm.resting):
            self.adaptation.take_back()


def scale_of(ship: Ship) -> Force:
    """The usual size of what is left over: 1/2 rho L T U_0^2 by 1 % ahead, 3 % aside, 1 % of it times L
    turning."""
    force = ship.scale("force")
    return Force(force, 3.0 * force, force * ship.L_pp)
