"""What force was missing? Measured accelerations without differentiating anything: the filtered regression.

    y_f' = lam (y - y_f),  F_f' = lam (nu_dot_known - F_f),  q_f' = lam (q - q_f)
    d = S^-1 M [lam (y - y_f) - F_f]   the force that the known ones do not explain, low-passed, in units of the force scale S

Both sides pass the same filter, so d = (learned force)_f + noise, whatever the manoeuvre.
"""

from collections.abc import Sequence

from twin.live.dynamics import Known
from twin.physics.ship import Ship
from twin.physics.state import Force, Rates

Three = tuple[float, float, float]
SETTLED = 3.0  # time constants of the filter until d may be used


class Filtered:
    """A few numbers through the same first-order filter."""

    def __init__(self) -> None:
        self.value: list[float] | None = None

    def feed(self, values: Sequence[float], a: float) -> list[float]:
        old = self.value
        if old is None or len(old) != len(values):
            self.value = list(values)
        else:
            self.value = [f + a * (x - f) for f, x in zip(old, values, strict=True)]
        return self.value


class Evidence:
    """The unexplained force, and how well the learned one explains it: mean squares over three ship lengths."""

    def __init__(self, ship: Ship, scale: Force):
        self.time_s = ship.L_pp / ship.U_0
        self.lam = 2.0 / self.time_s
        self.scale = scale
        self.unexplained: Three = (0.0, 0.0, 0.0)  # d [S]
        self.without = self.with_learned = 0.0  # mean |d|^2, mean |d - learned_f|^2
        self.ready = False
        self._nu, self._rates, self._learned = Filtered(), Filtered(), Filtered()
        self._heard_s = 0.0

    def feed(self, nu: Three, known: Rates, learned: Three, physics: Known, dt: float) -> None:
        """One tick: measured nu, accelerations the known forces give, the learned force [S], seconds since the last."""
        a = min(self.lam * dt, 0.5)
        slow = self._nu.feed(nu, a)
        rates = self._rates.feed(known, a)
        explained = self._learned.feed(learned, a)
        force = physics.force_for(*(self.lam * (y - f) - g for y, f, g in zip(nu, slow, rates, strict=True)))
        self.unexplained = d = tuple([f / s for f, s in zip(force, self.scale, strict=True)])  # type: ignore[assignment]
        self._heard_s += dt
        self.ready = self._heard_s > SETTLED / self.lam
        if self.ready:
            b = min(dt / (3.0 * self.time_s), 0.5)
            self.without += b * (sum(x * x for x in d) - self.without)
            self.with_learned += b * (sum((x - y) ** 2 for x, y in zip(d, explained, strict=True)) - self.with_learned)

    def pause(self) -> None:
        """The measurements have a hole: begin again."""
        self._nu, self._rates, self._learned = Filtered(), Filtered(), Filtered()
        self._heard_s, self.ready = 0.0, False

    @property
    def judged(self) -> bool:
        """Long enough heard to compare with and without the learned force."""
        return self._heard_s > 3.0 * self.time_s
