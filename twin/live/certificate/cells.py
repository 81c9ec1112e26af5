"""How steep the equations of motion are in each part of the operating set: the set's motions are cut into
cells, and what a step needs to know is the greatest over the cells that the ship may be in.

Kept with the certificate: numbers only, so that no numpy is needed on board."""

from bisect import bisect_left, bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

from twin.live.observer.operating import NU

ROUNDED_UP = 6e-4  # relative: more than four digits lose
NUMBERS = 18
Span = tuple[tuple[int, int], tuple[int, int], tuple[int, int]]  # first cell and past the last, by axis


@dataclass(frozen=True)
class Cells:
    """edges: of the cells along u, v, r. steep: for each cell (r runs fastest) the greatest |slope| of nu_dot
    with (u, v, r) row by row (9), the greatest slope on the diagonal (3), the greatest |slope| with the heading
    (3), the greatest |nu_dot| (3); in SI, whatever the inputs of the set are, without a current."""

    edges: tuple[tuple[float, ...], ...]
    steep: tuple[tuple[float, ...], ...]

    def whole(self, ranges: Mapping[str, tuple[float, float]]) -> bool:
        """Whether the cells fill the set, and each has all of its numbers."""
        count = 1
        for name, edges in zip(NU, self.edges, strict=True):
            if not (edges[0], edges[-1]) == tuple(ranges[name]) or any(
                not a < b for a, b in zip(edges[:-1], edges[1:], strict=True)
            ):
                return False
            count *= len(edges) - 1
        return len(self.steep) == count and all(
            len(x) == NUMBERS and all(-inf < y < inf for y in x) and min(*x[:9], *x[12:]) >= 0.0
            for x in self.steep
        )

    def span(self, low: tuple[float, ...], high: tuple[float, ...]) -> Span:
        """The cells that this box of motions touches; of what lies outside the set, the nearest."""
        found = []
        for a, b, edges in zip(low, high, self.edges, strict=True):
            last = len(edges) - 2
            first = min(max(bisect_left(edges, a) - 1, 0), last)
            found.append((first, max(min(bisect_right(edges, b), last + 1), first + 1)))
        return found[0], found[1], found[2]

    def ends(self, span: Span) -> tuple[tuple[float, float], ...]:
        """(least, greatest) of u, v, r over these cells."""
        return tuple((edges[a], edges[b]) for edges, (a, b) in zip(self.edges, span, strict=True))

    def over(self, span: Span) -> tuple[float, ...]:
        """Its numbers over all of these cells."""
        (u0, u1), (v0, v1), (r0, r1) = span
        of_v, of_r = len(self.edges[1]) - 1, len(self.edges[2]) - 1
        rows = [
            row
            for u in range(u0, u1)
            for v in range(v0, v1)
            for row in self.steep[(u * of_v + v) * of_r + r0 : (u * of_v + v) * of_r + r1]
        ]
        return tuple(map(max, zip(*rows, strict=True)))


def of_slopes(edges: tuple[Any, ...], lo: Any, hi: Any) -> Cells:
    """From sure bounds (3, 5, cells) of the rates and their slopes with (u, v, r, psi) in each cell (arrays)."""
    rows = []
    for k in range(lo.shape[2]):
        size = [[max(-float(lo[i, j, k]), float(hi[i, j, k])) for j in range(5)] for i in range(3)]
        told = [x for row in size for x in row[1:4]]
        told += [float(hi[i, i + 1, k]) for i in range(3)]
        told += [row[4] for row in size] + [row[0] for row in size]
        rows.append(tuple(map(_up, told)))
    return Cells(tuple(tuple(map(float, x)) for x in edges), tuple(rows))


def _up(x: float) -> float:
    """No less, with four digits."""
    return float(f"{x + ROUNDED_UP * abs(x):.4g}")
