"""How steep the equations of motion are in each part of the operating set: its motions are cut into cells,
and what a step needs to know is the greatest over the cells in which the ship may be.

Kept with the certificate as numbers, so that no numpy is needed on board."""

from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import Any, NamedTuple

from twin.live.certificate.comparison_systems import Row
from twin.live.observer.operating import NU

IN_CELLS = {"u": 6, "v": 10, "r": 10}
ROUNDED_UP = 6e-4  # relative: more than what is lost beyond four digits
Ends = tuple[tuple[float, float], ...]  # (least, greatest) of u, v, r
Span = tuple[tuple[int, int], ...]  # first cell and past the last, by axis


class Steepness(NamedTuple):
    """size: the greatest |slope| of nu_dot with (u, v, r), row by row (9); top: the greatest slope of each
    rate with its own speed; heading: |slope| with psi; most: |nu_dot|. In SI, for all inputs of the set, in
    water without a current."""

    size: tuple[float, ...]
    top: Row
    heading: Row
    most: Row


@dataclass(frozen=True)
class Cells:
    """edges: of the cells along u, v, r; steep: the Steepness of each as one row of numbers, r runs fastest;
    moved: see Plant, all over these cells."""

    edges: tuple[tuple[float, ...], ...]
    steep: tuple[tuple[float, ...], ...]
    moved: Row = (0.0, 0.0, 0.0)

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """The set that they fill."""
        return {name: (edges[0], edges[-1]) for name, edges in zip(NU, self.edges, strict=True)}

    def whole(self, ranges: Mapping[str, tuple[float, float]]) -> bool:
        """Whether the cells fill these ranges, and each has all of its numbers."""
        count = 1
        for edges in self.edges:
            if not all(a < b for a, b in pairwise(edges)):
                return False
            count *= len(edges) - 1
        filled = all(self.ranges[name] == tuple(ranges[name]) for name in NU)
        told = (*self.steep, (0.0,) * 15 + self.moved)
        return filled and len(self.steep) == count and all(map(_plain, told))

    def span(self, low: Sequence[float], high: Sequence[float]) -> Span:
        """The cells that this box of motions touches; for what lies outside all of them the nearest."""
        found = []
        for a, b, edges in zip(low, high, self.edges, strict=True):
            last = len(edges) - 2
            first = min(max(bisect_left(edges, a) - 1, 0), last)
            found.append((first, max(min(bisect_right(edges, b), last + 1), first + 1)))
        return tuple(found)

    def ends(self, span: Span) -> Ends:
        """(least, greatest) of u, v, r in these cells."""
        return tuple((edges[a], edges[b]) for edges, (a, b) in zip(self.edges, span, strict=True))

    def over(self, span: Span) -> Steepness:
        """The greatest over these cells."""
        (u0, u1), (v0, v1), (r0, r1) = span
        of_v, of_r = len(self.edges[1]) - 1, len(self.edges[2]) - 1
        starts = [(u * of_v + v) * of_r for u in range(u0, u1) for v in range(v0, v1)]
        x = tuple(map(max, zip(*[row for k in starts for row in self.steep[k + r0 : k + r1]], strict=True)))
        return Steepness(x[:9], x[9:12], x[12:15], x[15:])  # type: ignore[arg-type]


def of_slopes(edges: tuple[Any, ...], lo: Any, hi: Any, moved: Row) -> Cells:
    """From sure bounds (3, 5, cells), arrays, of rates and their slopes with (u, v, r, psi) in each cell."""
    rows = []
    for k in range(lo.shape[2]):
        size = [[max(-float(lo[i, j, k]), float(hi[i, j, k])) for j in range(5)] for i in range(3)]
        told = [x for row in size for x in row[1:4]] + [float(hi[i, i + 1, k]) for i in range(3)]
        rows.append(tuple(map(_up, told + [row[4] for row in size] + [row[0] for row in size])))
    return Cells(tuple(tuple(map(float, x)) for x in edges), tuple(rows), moved)


def _up(x: float) -> float:
    """No less, in four digits."""
    return float(f"{x + ROUNDED_UP * abs(x):.4g}")


def _plain(x: tuple[float, ...]) -> bool:
    """Whether these are the numbers of one cell."""
    return len(x) == 18 and all(-inf < y < inf for y in x) and min(*x[:9], *x[12:]) >= 0.0
