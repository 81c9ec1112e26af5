"""The theorem of an inner step over that part of the operating set in which the ship surely is during it.

    nu_hat +- (x + h way)  inside the cells C:   x  <=  M_C x + d_C,    slopes, way and damping those of C

Until the ship, its estimate or a stage of the step leaves C all of them move no faster than `way` of C, so
they do not leave it (docs/stability.md, section 4b)."""

from dataclasses import replace
from math import ceil

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.cells import Cells, Span
from twin.live.certificate.certificate import Certificate
from twin.live.certificate.comparison_systems import AXES, Row
from twin.live.certificate.plant import Plant
from twin.live.certificate.rolled import InnerStep, inner, way
from twin.live.observer.operating import EVERYTHING

STREAMS = 8  # steps in which the current's speed is rounded up
KEPT = 400  # parts of the set that are remembered

Rows5 = tuple[tuple[float, ...], ...]


class Region:
    """Some cells of the set, under a current up to some speed [m/s]. `rows` of (M, d), `way` [m/s2, m/s2,
    rad/s2]; `low`, `high`: where a motion with no error may begin a step."""

    __slots__ = ("_ends", "_force", "_length", "_one", "_plant", "high", "low", "rows", "stream", "way")

    def __init__(self, plant: Plant, ends: tuple[tuple[float, float], ...], stream: float) -> None:
        self._plant, self._ends, self.stream = plant, ends, stream
        self._one, self._length = InnerStep(plant, clipped=False), plant.h
        self._force: Row | None = None
        self.rows: Rows5 = ()
        self.way: Row = (0.0, 0.0, 0.0)

    def under(self, force: Row) -> "Region":
        """The same under a force that nobody knows, of this size [N, N, N m]."""
        if force is not self._force:
            self._force, self.way = force, way(self._plant, force)
            d = self._one.pushes(force, self.way[2])
            self.rows = tuple((*row, x) for row, x in zip(self._one.M, d, strict=True))
            self.low = tuple(a + self._length * w for (a, _), w in zip(self._ends, self.way, strict=True))
            self.high = tuple(b - self._length * w for (_, b), w in zip(self._ends, self.way, strict=True))
        return self

    def holds(self, motion: tuple[float, ...], x: tuple[float, ...]) -> bool:
        """Whether a step from this motion (and current), known within x, surely stays in it."""
        u, v, r, c = motion
        (u0, v0, r0), (u1, v1, r1) = self.low, self.high
        return (
            u0 + x[0] <= u <= u1 - x[0]
            and v0 + x[1] <= v <= v1 - x[1]
            and r0 + x[2] <= r <= r1 - x[2]
            and c <= self.stream
        )


class Regions:
    """Of one certificate, each worked out when it is first needed."""

    def __init__(self, certificate: Certificate, cells: Cells) -> None:
        self._cells, self._plant = cells, inner(certificate.plant, certificate.inner)
        self._most = certificate.operating.ranges.get("stream", EVERYTHING)[1]
        self._far: Row = way(certificate.plant, certificate.disturbance.calm)
        self._found: dict[tuple[Span, int], Region] = {}

    def around(
        self, motion: tuple[float, ...], x: tuple[float, ...], force: Row, last: Row | None = None
    ) -> Region | None:
        """The smallest of cells that surely holds a step from this motion; None: it may leave the set."""
        reach = last or self._far
        for _ in range(2):
            region = self._of(motion, x, reach, force)
            if region.holds(motion, x):
                return region
            reach = region.way
        region = self._of(motion, x, way(self._plant, force), force)
        return region if region.holds(motion, x) else None

    def _of(self, motion: tuple[float, ...], x: tuple[float, ...], reach: Row, force: Row) -> Region:
        h = self._plant.h
        most = [b + h * w for b, w in zip(x, reach, strict=False)]
        span = self._cells.span(
            tuple(a - b for a, b in zip(motion, most, strict=False)),
            tuple(a + b for a, b in zip(motion, most, strict=False)),
        )
        level = min(ceil(STREAMS * motion[3] / self._most - 1e-9), STREAMS) if self._most else 0
        key = span, level
        if key not in self._found:
            if len(self._found) >= KEPT:
                self._found.clear()
            self._found[key] = self._made(span, level * self._most / STREAMS)
        return self._found[key].under(force)

    def _made(self, span: Span, stream: float) -> Region:
        """A current adds r x nu_c, itself to the slope with r, and what turning nu_c does to that with the
        heading."""
        told, ends = self._cells.over(span), self._cells.ends(span)
        r = max(map(abs, ends[2]))
        own = (stream, stream, 0.0)
        size = [[*told[3 * i : 3 * i + 3]] for i in AXES]
        heading = c3.row(
            told[12 + i] + stream * (size[i][0] + size[i][1]) + r * own[i] for i in AXES
        )
        for i in AXES:
            size[i][2] += own[i]
        plant = replace(
            self._plant,
            lo=c3.matrix(lambda i, j: -size[i][j]),
            hi=c3.matrix(lambda i, j: told[9 + i] if i == j else size[i][j]),
            heading=heading,
            most=c3.row(told[15 + i] + r * own[i] for i in AXES),
            cells=None,
        )
        return Region(plant.at_period(plant.h), ends, stream)
