"""Even B-splines: a smooth curve as a few numbers, and the weights by which each number enters a value or a
slope.

Cubic: knots every h, c_0 ... c_{K-1}; at time t four of them count. Linear: two. [de Boor (2001) A Practical
    Guide to Splines]
"""

from dataclasses import dataclass

import numpy as np

Weights = tuple[np.ndarray, np.ndarray]  # (n,) first coefficient, (n, m) weights of it and of those behind it
# by powers of the share of a step
CUBIC = np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6.0


@dataclass(frozen=True)
class Spline:
    """A grid of `size` coefficients, `h` [s] apart, that covers [start, end] [s]."""

    start: float
    h: float
    size: int
    degree: int

    @classmethod
    def over(cls, start: float, end: float, h: float, degree: int = 3) -> "Spline":
        """The grid of this degree (3 cubic, 1 linear) that covers [start, end] [s] in steps of h [s]."""
        return cls(start, h, int(np.ceil((end - start) / h)) + degree, degree)

    @property
    def times(self) -> np.ndarray:
        """(K,) the time in the middle of each coefficient's reach [s]."""
        return self.start + self.h * (np.arange(self.size) - 0.5 * (self.degree - 1))

    def weights(self, t: np.ndarray, slope: int = 0) -> Weights:
        """The weights of the value (slope 0), its first or its second derivative at t (n,); outside the grid
        those of its end."""
        last = self.size - self.degree
        at = np.clip((t - self.start) / self.h, 0.0, last - 1e-9)
        first = at.astype(int)
        x = at - first
        one, none = np.ones_like(x), np.zeros_like(x)
        if self.degree == 1:
            return first, np.column_stack([1.0 - x, x] if slope == 0 else [-one / self.h, one / self.h])
        if slope == 0:
            powers = (one, x, x**2, x**3)
        else:
            powers = (none, one, 2 * x, 3 * x**2) if slope == 1 else (none, none, 2 * one, 6 * x)
        return first, np.column_stack(powers) @ CUBIC.T / self.h**slope

    def value(self, c: np.ndarray, w: Weights) -> np.ndarray:
        """(n, ...) values of the curve with coefficients c (size, ...)."""
        first, share = w
        picked = c[first[:, None] + np.arange(share.shape[1])]
        return np.einsum("nm,nm...->n...", share, picked)
