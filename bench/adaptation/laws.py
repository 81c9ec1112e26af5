"""Laws of adaptation that are compared with the one on board; all share its saturation, gate, boxes and ball
(twin/live/learning/adapt.py).

    gradient    a' = G q e/(1 + q'q) - sigma a
        sigma-modification [Ioannou & Kokotovic 1984]
    e-mod       a' = G q e/(1 + q'q) - mu |e| a
        e-modification [Narendra & Annaswamy 1987]
    dead zone   the same gradient, not below one usual error
    RLS         P' = P/M - P q q' P/R,  a' = P q e/R                  forgetting over M, P bounded from above
    Kalman      P' = Q - P q q' P/R - 2 P/T,
        a' = P q e/R - a/T      a random walk, leaking to the trained weights
"""

from math import sqrt
from typing import Any

from twin.live.learning.adapt import NOISE_S, Adaptation
from twin.live.learning.adapted_row import Row
from twin.live.learning.filtered_regression import Three
from twin.physics.maths import dot
from twin.physics.ship import Ship
from twin.physics.state import Force

GAIN, SIGMA, MU = 1.0, 1.0 / 60.0, 0.5  # per L/U_0
MEMORY = 20.0  # of RLS, in L/U_0
# what a law is told at each step: wanted, regressors, dt, frozen
Stream = list[tuple[Three, list[float], float, str]]
LEAK, WALK = 60.0, 0.016  # in L/U_0; of what is usual, squared, per L/U_0


class ForgettingLaw(Adaptation):
    """The law on board, were it told `at_s` after it began that the ship has changed: it forgets everything
    then."""

    def __init__(self, ship: Ship, scale: Force, components: int, at_s: float):
        super().__init__(ship, scale, components)
        self._anew, self._left_s = (ship, scale, components), at_s

    def learn(self, wanted: Three, regressors: list[float], dt: float, frozen: str) -> None:
        if self._left_s > 0.0 >= self._left_s - dt:
            super().__init__(*self._anew)
        self._left_s -= dt
        super().learn(wanted, regressors, dt, frozen)


class Gradient(Adaptation):
    """Normalised gradient with sigma-modification."""

    def _fit(self, row: Row, q: list[float], error: float, h: float) -> None:
        pull, leak = self._pull(row, q, error, h), 1.0 - h * self._leak(row, error)
        row.a = [leak * x + pull * y for x, y in zip(row.a, q, strict=True)]

    def _pull(self, row: Row, q: list[float], error: float, h: float) -> float:
        return GAIN * h * error / (1.0 + dot(q, q))

    def _leak(self, row: Row, error: float) -> float:
        return SIGMA


class EModified(Gradient):
    """It leaks as much as it errs."""

    def _leak(self, row: Row, error: float) -> float:
        return MU * abs(error)


class DeadZone(Gradient):
    """Errors that are usual teach nothing."""

    def _pull(self, row: Row, q: list[float], error: float, h: float) -> float:
        edge = sqrt(row.spread)
        beyond = max(abs(error) - edge, 0.0)
        return super()._pull(row, q, beyond if error > 0.0 else -beyond, h)


class Covariant(Adaptation):
    """What RLS and the Kalman filter share: a covariance P of each row, which begins as the prior of the law
    on board."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self._P = {
            id(row): [
                [u * u if i == j else 0.0 for j in range(self.width)] for i, u in enumerate(self._usual)
            ]
            for row in self._rows
        }

    def _fit(self, row: Row, q: list[float], error: float, h: float) -> None:
        P = self._P[id(row)]
        Pq = [dot(line, q) for line in P]
        gain = 1.0 / (NOISE_S * row.spread / h + dot(q, Pq))
        leak = self._leak(h)
        row.a = [leak * x + gain * error * y for x, y in zip(row.a, Pq, strict=True)]
        left = [
            [p - gain * x * y for p, y in zip(line, Pq, strict=True)] for line, x in zip(P, Pq, strict=True)
        ]
        self._P[id(row)] = self._later(left, h)

    def _leak(self, h: float) -> float:
        return 1.0

    def _later(self, P: list[list[float]], h: float) -> list[list[float]]:
        raise NotImplementedError


class Recursive(Covariant):
    """RLS: old evidence fades, so that P grows where nothing teaches; bounded by its trace."""

    def _later(self, P: list[list[float]], h: float) -> list[list[float]]:
        grown = [[p / (1.0 - h / MEMORY) for p in line] for line in P]
        trace = sum(grown[i][i] for i in range(self.width))
        most = sum(u * u for u in self._usual)
        return grown if trace <= most else [[p * most / trace for p in line] for line in grown]


class Kalman(Covariant):
    """A random walk that leaks."""

    def _leak(self, h: float) -> float:
        return 1.0 - h / LEAK

    def _later(self, P: list[list[float]], h: float) -> list[list[float]]:
        keep, walk = 1.0 - 2.0 * h / LEAK, [h * WALK * u * u for u in self._usual]
        return [
            [keep * p + (walk[i] if i == j else 0.0) for j, p in enumerate(line)] for i, line in enumerate(P)
        ]


class Writes(Adaptation):
    """Learns nothing, and writes down what it is told."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.heard: Stream = []

    def learn(self, wanted: Any, regressors: list[float], dt: float, frozen: str) -> None:
        self.heard.append((wanted, list(regressors), dt, frozen))
