"""The theorem of an inner step over that part of the operating set in which the ship surely is during it.

    nu_hat +- (x + h way)  inside the cells C:   x  <=  M x + d      slopes, damping and way those of C

Up to the moment at which ship, estimate or a stage of the step left C all of them would move no faster than
`way`, so they do not leave it (docs/stability.md, section 4b)."""

from dataclasses import replace
from math import ceil

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.certificate import Certificate
from twin.live.certificate.comparison_systems import AXES, Row
from twin.live.certificate.plant import Plant
from twin.live.certificate.rolled import InnerStep, inner, way
from twin.live.certificate.set_cells import Cells, Ends, Span
from twin.live.observer.operating import EVERYTHING, OperatingSet

STREAMS = 8  # steps in which the current's speed is rounded up
PARTS_KEPT = 200  # parts of the set that are remembered
ROUNDING = 1e-9

Floats = tuple[float, ...]


class SetPart:
    """Some cells of the set, under a current of up to `stream` [m/s]. `rows`: (M, d) of u, v, r, psi; `way`:
    how fast anything in it moves [m/s2, m/s2, rad/s2]."""

    __slots__ = ("_ends", "_far", "_fit", "_force", "_pushed", "rows", "stream", "way")

    def __init__(self, plant: Plant, ends: Ends, stream: float) -> None:
        one, still = InnerStep(plant, clipped=False), (0.0, 0.0, 0.0)
        calm = one.pushes(still, plant.most[2])
        # d and the way are straight in the force: by each of its three, and without it
        by_each = [
            [x - c for x, c in zip(one.pushes(unit, way(plant, unit)[2]), calm, strict=True)]
            for unit in c3.IDENTITY
        ]
        self._pushed = [(row, *by, c) for row, *by, c in zip(one.M, *by_each, calm, strict=True)]
        self._far = [(*row, most) for row, most in zip(plant.inertia, plant.most, strict=True)]
        self._ends, self.stream, self._force = [(a, b, plant.h) for a, b in ends], stream, still
        self._fit: list[float] = []
        self.rows: list[Floats] = []
        self.way: Row = still

    def under(self, force: Row) -> "SetPart":
        """The same where nobody knows a force of this size [N, N, N m]."""
        if force is not self._force:
            self._force, (X, Y, N) = force, force
            self.rows = [(*row, x * X + y * Y + n * N + c) for row, x, y, n, c in self._pushed]
            u, v, r = [x * X + y * Y + n * N + most for x, y, n, most in self._far]
            self.way = u, v, r
            fit = [(a + h * w, b - h * w) for (a, b, h), w in zip(self._ends, self.way, strict=True)]
            self._fit = [x for pair in fit for x in pair]
        return self

    def touches(self, motion: Floats, x: Floats) -> bool:
        """Whether all that is known within x of this motion lies in it."""
        return motion[3] <= self.stream and all(
            a + b <= y <= c - b for y, b, (a, c, _) in zip(motion, x, self._ends, strict=False)
        )

    def holds(self, motion: Floats, x: Floats) -> bool:
        """Whether a step from this motion (u, v, r, current), known within x, surely stays in it."""
        u0, u1, v0, v1, r0, r1 = self._fit
        u, v, r, stream = motion
        a, b, c, _ = x
        return (
            u0 + a <= u <= u1 - a
            and v0 + b <= v <= v1 - b
            and r0 + c <= r <= r1 - c
            and stream <= self.stream
        )


class SetParts:
    """Of one certificate, each worked out when it is first needed."""

    def __init__(self, certificate: Certificate, cells: Cells) -> None:
        self._cells = cells
        self.operating = OperatingSet({**certificate.operating.ranges, **cells.ranges})
        self._plant = replace(inner(certificate.plant, certificate.inner), cells=None, moved=cells.moved)
        self._most = self.operating.ranges.get("stream", EVERYTHING)[1]
        self._found: dict[tuple[Span, int], SetPart] = {}
        whole = cells.span(*zip(*cells.ranges.values(), strict=True))
        self.everywhere = self._made(whole, self._most)

    def around(self, motion: Floats, x: Floats, force: Row, last: SetPart | None = None) -> SetPart | None:
        """The fewest cells that surely hold a step from this motion; None: it may leave the set. `last`:
        where it was."""
        everywhere = self.everywhere.under(force)
        if not everywhere.touches(motion, x):
            return None
        reach = (last or everywhere).way
        for _ in range(2):
            part = self._of(motion, x, reach, force)
            if part.holds(motion, x):
                return part
            reach = part.way
        part = self._of(motion, x, everywhere.way, force)
        return part if part.holds(motion, x) else None

    def _of(self, motion: Floats, x: Floats, reach: Row, force: Row) -> SetPart:
        u, v, r, stream = motion
        h, (a, b, c) = self._plant.h, reach
        a, b, c = x[0] + h * a, x[1] + h * b, x[2] + h * c
        level = min(ceil(STREAMS * stream / self._most - ROUNDING), STREAMS) if stream else 0
        key = self._cells.span((u - a, v - b, r - c), (u + a, v + b, r + c)), level
        if key not in self._found:
            if len(self._found) >= PARTS_KEPT:
                self._found.clear()
            self._found[key] = self._made(key[0], level * self._most / STREAMS)
        return self._found[key].under(force)

    def _made(self, span: Span, stream: float) -> SetPart:
        """A current adds r x nu_c, itself to the slope with r, and to that with the heading its turning."""
        steep, ends = self._cells.over(span), self._cells.ends(span)
        r, own = max(map(abs, ends[2])), (stream, stream, 0.0)
        size = [[*steep.size[3 * i : 3 * i + 3]] for i in AXES]
        heading = c3.row(steep.heading[i] + stream * (size[i][0] + size[i][1]) + r * own[i] for i in AXES)
        for i in AXES:
            size[i][2] += own[i]
        plant = replace(
            self._plant,
            lo=c3.matrix(lambda i, j: -size[i][j]),
            hi=c3.matrix(lambda i, j: steep.top[i] if i == j else size[i][j]),
            heading=heading,
            most=c3.row(steep.most[i] + r * own[i] for i in AXES),
            operating=OperatingSet({**self.operating.ranges, "r": ends[2]}),
        )
        return SetPart(plant.at_period(plant.h), ends, stream)
