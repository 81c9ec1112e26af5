"""What force was missing? Measured accelerations without differentiating anything: the filtered
regression.

    y_f' = lam (y - y_f),  F_f' = lam (nu_dot_known - F_f),  q_f' = lam (q - q_f)
    d = S^-1 M [lam (y - y_f) - F_f]
        the force that the known ones do not explain, low-passed, in units of the force scale S

All pass the same filter, so d = (learned force)_f + noise, whatever the manoeuvre; and all pass it a second
time. Noise of speeds that are as good as differentiated, and waves, lie above the manoeuvres: behind one
filter they are most of d in a sea way, behind two little of it."""

from collections.abc import Sequence

from twin.live.observer.dynamics import KnownDynamics
from twin.physics.ship import Ship
from twin.physics.state import LIGHT, Force, Growth, Rates

Three = tuple[float, float, float]
SETTLED = 5.0  # time constants until d may be used: what both filters began with is 4 % by then


class Evidence:
    """The unexplained force, and how well the learned one explains it: mean squares over three ship
    lengths."""

    def __init__(self, ship: Ship, scale: Force):
        self.time_s = ship.L_pp / ship.U_0
        self.lam = 2.0 / self.time_s
        self.scale = scale
        self.unexplained: Three = (0.0, 0.0, 0.0)  # d [S], low-passed twice
        self.without = self.with_learned = 0.0  # mean |d|^2, mean |d - learned_f|^2
        self.ready = False
        self._low: list[float] = []  # nu, rates, learned, trained, regressors: low-passed
        self._twice: list[float] = []  # d, learned, trained, regressors: low-passed again
        self._heard_s = 0.0

    @property
    def left_over(self) -> float:
        """The yaw moment that neither the known forces nor the learned one explain, low-passed [S]."""
        return self._twice[2] - self._twice[5]

    @property
    def trained(self) -> list[float]:
        """What the trained last layer gives, low-passed [S]."""
        return self._twice[6:9]

    @property
    def regressors(self) -> list[float]:
        """The regressors, low-passed twice."""
        return self._twice[9:]

    def feed(
        self,
        nu: Three,
        known: Rates,
        learned: Three,
        trained: Three,
        regressors: Sequence[float],
        physics: KnownDynamics,
        dt: float,
        grown: Growth = LIGHT,
    ) -> None:
        """Measured nu, accelerations the known forces give, learned and trained force [S], seconds since
        the last time, growth of the added mass."""
        new = [*nu, *known, *learned, *trained, *regressors]
        a = min(self.lam * dt, 0.5)
        if len(self._low) != len(new):
            self._low, self._heard_s = new, 0.0
        self._low = low = _low_passed(self._low, new, a)
        # exact for steps of dt: the low-pass has already taken in a share a of the newest nu
        lam = self.lam / (1.0 - a)
        u, v, r = (lam * (y - f) - F for y, f, F in zip(nu, low[:3], low[3:6], strict=True))
        X, Y, N = physics.force_for(u, v, r, grown)
        x, y, n = X / self.scale.X, Y / self.scale.Y, N / self.scale.N
        once = [x, y, n, *low[6:]]
        self._twice = _low_passed(self._twice if self._heard_s else once, once, a)
        self.unexplained = self._twice[0], self._twice[1], self._twice[2]
        self._heard_s += dt
        self.ready = self._heard_s > SETTLED / self.lam
        if self.ready:
            b = min(dt / (3.0 * self.time_s), 0.5)
            self.without += b * (x * x + y * y + n * n - self.without)
            error = (x - low[6]) ** 2 + (y - low[7]) ** 2 + (n - low[8]) ** 2
            self.with_learned += b * (error - self.with_learned)

    def pause(self) -> None:
        """The measurements have a hole: begin again."""
        self._low, self._heard_s, self.ready = [], 0.0, False

    @property
    def judged(self) -> bool:
        """Long enough heard to compare with and without the learned force."""
        return self._heard_s > 3.0 * self.time_s


def _low_passed(low: list[float], new: list[float], a: float) -> list[float]:
    return [f + a * (x - f) for f, x in zip(low, new, strict=True)]
