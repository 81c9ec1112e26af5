"""The learned force: trained last layer and adapted part on the trunk's features, inside a ball it can never leave.

    f = w [W phi + g A q],  |f| <= bound (in units of the force scale S),  force = S f

w is how far the features may be believed. Without a residual the force is zero, and says why.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt

from twin.live.adapt import Adaptation
from twin.live.evidence import Evidence, Filtered, Three
from twin.live.dynamics import Known
from twin.live.residual import Residual, dot
from twin.physics.ship import Ship
from twin.physics.state import Force, Rates, Situation

ZERO = Force(0.0, 0.0, 0.0)


@dataclass(slots=True)
class Learned:
    """What the twin learned to add: `force` acts, `shadow` (in S) is what would, were it allowed to; `trained` is W phi alone."""

    force: Force = ZERO
    shadow: Three = (0.0, 0.0, 0.0)
    trained: Three = (0.0, 0.0, 0.0)
    weight: float = 0.0
    share: float = 0.0  # of all force, the known ones summed by their sizes
    bound_N: float = 0.0
    bound_Nm: float = 0.0
    clipped: bool = False
    why: str = ""


class LearnedForce:
    """Residual and adaptation together; `at` has no memory, so the predictor uses it too."""

    def __init__(self, ship: Ship, residual: Residual | None, why_not: str = "", adapt: bool = True):
        self.residual, self.why_not = residual, why_not
        self.scale = residual.manifest.force_scale if residual else scale_of(ship)
        self.bound = residual.manifest.output_bound if residual else 0.0
        rows = residual.manifest.whitening[1] if residual and residual.manifest.whitening else ()
        self.adaptation = Adaptation(ship, self.scale, len(rows)) if residual and adapt else None
        self.evidence = Evidence(ship, self.scale)
        self._trained = Filtered()

    def at(self, s: Situation, known: Mapping[str, Force], allowed: bool = True) -> tuple[Learned, list[list[float]]]:
        """The learned force of one situation (s.u_r, s.v_r set), and the regressors behind it."""
        if self.residual is None:
            return Learned(why=self.why_not), []
        features = self.residual.features(s)
        regressors = self.adaptation.regressors(features.components, known) if self.adaptation else []
        if features.weight == 0.0:
            return Learned(why=features.why, **self._bounds()), regressors
        W, w = self.residual.manifest.W, features.weight
        trained = tuple([w * dot(row, features.phi) for row in W])
        more = self.adaptation.correction(regressors) if self.adaptation else (0.0, 0.0, 0.0)
        f = [t + w * m for t, m in zip(trained, more, strict=True)]
        size = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2])
        if not size < 1e9:
            return Learned(why="the learned force is not finite or absurd", **self._bounds()), regressors
        clipped = size > self.bound
        shadow = tuple([x * self.bound / size for x in f]) if clipped else tuple(f)
        force = Force(*[x * s_ for x, s_ in zip(shadow, self.scale, strict=True)]) if allowed else ZERO
        share = self._share(shadow, known) if allowed else 0.0
        learned = Learned(force, shadow, trained, w if allowed else 0.0, share, clipped=clipped, why=features.why, **self._bounds())  # type: ignore[arg-type]
        return learned, regressors

    def learn(
        self, nu: Three | None, rates: Rates, learned: Learned, regressors: list[list[float]], physics: Known, dt: float, frozen: str
    ) -> None:
        """Weigh the evidence of one tick (`nu` None: not measured), and adapt unless `frozen` says why not."""
        if nu is None or not 0.0 < dt < 1.0:
            self.evidence.pause()
            if self.adaptation:
                self.adaptation.frozen = frozen or "speed, rate of turn or controls are not measured"
            return
        evidence = self.evidence
        evidence.feed(nu, rates, learned.shadow, physics, dt)
        if self.adaptation and regressors:
            trained = self._trained.feed(learned.trained, min(evidence.lam * dt, 0.5))
            frozen = frozen or ("" if evidence.ready else "has just begun")
            self.adaptation.learn(evidence.unexplained, trained, regressors, evidence.lam, dt, frozen)

    def _bounds(self) -> dict[str, float]:
        return {"bound_N": self.bound * max(self.scale.X, self.scale.Y), "bound_Nm": self.bound * self.scale.N}

    def _share(self, f: Three, known: Mapping[str, Force]) -> float:
        learned = sum(abs(x) for x in f)
        total = sum(abs(x / s) for force in known.values() for x, s in zip(force, self.scale, strict=True))
        return learned / (learned + total) if learned else 0.0


def scale_of(ship: Ship) -> Force:
    """The usual size of what is left over: 1/2 rho L T U_0^2 by 1 % ahead, 3 % aside, 1 % of it times L turning."""
    force = ship.scale("force")
    return Force(force, 3.0 * force, force * ship.L_pp)
