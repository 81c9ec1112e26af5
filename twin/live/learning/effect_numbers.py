"""The numbers of the named effects, learned on board from the force that all three rows together miss.

    x = (theta - theta_file)/sd,   d_r = c_r x + what the rows' own numbers explain (adapt.py)
    x = argmin  sum_r sum_k exp(-(t - t_k)/MEMORY) h (d_r - c_r x)^2/(NOISE_S s_r^2) + |x|^2,
        low <= theta <= high

Few numbers and three rows to learn them from, so the memory is half of a row's. theta_file + g (theta -
theta_file) acts, in the known physics; the gate g asks how much of what x promised a while ago has come true
(skill.py). What has a name explains first; the rows explain what is left."""

from copy import copy, deepcopy
from math import isfinite, sqrt

from twin.live.learning.filtered_regression import Three
from twin.live.learning.movable import Columns, movable, moved
from twin.live.learning.ridge import HINDSIGHT, NOISE_S, SPREAD, deviations, factor, solve
from twin.live.learning.skill import Proof
from twin.physics.effect import Effect
from twin.physics.maths import dot
from twin.physics.ship import Ship
from twin.physics.state import Force

MEMORY = 10.0  # in L/U_0
EXCITED = 0.01  # prior deviations by which what acts must have moved before the model is made anew


class Named:
    """Learns x; `effects` are those of the ship with the numbers that act, the same object until one of them
    moves."""

    def __init__(self, ship: Ship, scale: Force):
        self.numbers = movable(ship.effects, ship)
        self.columns = Columns(self.numbers, scale)
        n = len(self.numbers)
        self._boxes = [((m.low - m.start) / m.sd, (m.high - m.start) / m.sd) for m in self.numbers]
        self._prior = [1.0] * n
        self.x, self._b = [0.0] * n, [0.0] * n
        self._I = [[0.0] * n for _ in self.numbers]
        self._L = factor(self._I, self._prior)
        self.sigma, self._then, self._next = [1.0] * n, [0.0] * n, [0.0] * n
        self._age = 0.0
        self._spread = [0.05] * 3
        self._proof = Proof()
        self.effects: tuple[Effect, ...] = ship.effects
        self._acting = [0.0] * n

    def __bool__(self) -> bool:
        return bool(self.numbers)

    @property
    def gate(self) -> float:
        """How far the numbers act, 0 to 1."""
        return self._proof.gate

    def acting(self) -> list[float]:
        """g x: what acts, in prior deviations from the ship file's numbers."""
        return [self.gate * x for x in self.x]

    def shift(self, columns: list[float]) -> Three:
        """What the numbers that act do more than the ship file's would, in units of the force scale."""
        a = self._acting
        return dot(a, columns[0::3]), dot(a, columns[1::3]), dot(a, columns[2::3])

    def learn(self, r: int, wanted: float, c: list[float], h: float) -> None:
        """What row r wants beyond the ship file's numbers, its columns, and the time since it was last asked
        [L/U_0]."""
        limit = 3.0 * sqrt(self._spread[r])
        error = min(max(wanted - dot(self.x, c), -limit), limit)
        if not (isfinite(error) and h > 0.0):
            return
        self._spread[r] += min(h / SPREAD, 0.2) * (error * error + 1e-5 - self._spread[r])
        self._proof.weigh(r, wanted, dot(self._then, c), self._spread[r], h)
        self._keep(h)
        # a third: each of three rows fades it
        keep, weight = 1.0 - min(h / MEMORY, 0.5) / 3.0, h / (NOISE_S * self._spread[r])
        y = weight * (dot(self.x, c) + error)
        self._I = [
            [keep * i + w * x for i, x in zip(line, c, strict=True)]
            for line, w in zip(self._I, [weight * x for x in c], strict=True)
        ]
        self._b = [keep * b + y * x for b, x in zip(self._b, c, strict=True)]
        self._L = factor(self._I, self._prior)
        self.x = [
            min(max(x, lo), hi) for x, (lo, hi) in zip(solve(self._L, self._b), self._boxes, strict=True)
        ]
        self._act()

    def _keep(self, h: float) -> None:
        """The numbers of now, for a while later."""
        self._age += h / 3.0
        if self._age > HINDSIGHT:
            self._then, self._next, self._age = self._next, list(self.x), 0.0
            self.sigma = deviations(self._L)

    def _act(self) -> None:
        """New effects once what acts has moved by more than nothing."""
        acting = self.acting()
        if max(abs(a - b) for a, b in zip(acting, self._acting, strict=True)) > EXCITED:
            self._acting = acting
            self.effects = moved(self.effects, self.numbers, self._values(acting))

    def held(self) -> "Named":
        """A copy that does not learn on."""
        other = copy(self)
        other._spread, other._proof = list(self._spread), deepcopy(self._proof)
        return other

    def values(self) -> list[float]:
        """theta as learned, each in its own unit; what acts is between it and the ship file's."""
        return self._values(self.x)

    def _values(self, x: list[float]) -> list[float]:
        return [min(max(m.start + m.sd * y, m.low), m.high) for m, y in zip(self.numbers, x, strict=True)]

    def begin(self, values: dict[str, float]) -> None:
        """Old values (by label), clamped; the gate stays shut: they must prove themselves again."""
        fresh = [(float(values[m.label]) - m.start) / m.sd for m in self.numbers]
        if not all(map(isfinite, fresh)):
            raise ValueError("numbers of effects that are not finite")
        self.x = [min(max(x, lo), hi) for x, (lo, hi) in zip(fresh, self._boxes, strict=True)]
        self._b, self._then, self._next = list(self.x), list(self.x), list(self.x)
