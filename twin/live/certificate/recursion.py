"""How error bounds go on by one sample, for one gain (docs/stability.md)."""

from dataclasses import dataclass

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.comparison_systems import Matrix, Row
from twin.live.certificate.plant import Plant
from twin.physics.maths import total

Ages = tuple[int, int, int]
# of (h^2 times the slope's change) that one step misses: 1/4, and the rest for ticks up to a fifth longer
# than was stepped for
CURVE = 0.26
NEVER = float("inf")


@dataclass(frozen=True)
class Recursion:
    """How error bounds go on by one sample; rows are axes, nothing is negative.

    m: greatest age of a used measurement, in samples.
    """

    V: Matrix  # one step of the physics on a difference of two motions: |I + h A| and its bend
    now: Matrix  # W: such a step and the pull that answers it, at most one sample late: |I + h A - h K|
    keep: Row  # |1 - h K|
    again: Row  # (m - 1) (h K)^2: a pull seen again in late measurements
    drift: Matrix  # (m - 1) h K (h |A| + bend): the ship's way while a measurement was under way
    pull: Row  # h K
    m: Ages

    @property
    def G(self) -> Matrix:
        """What becomes of an error in one sample: W and what older errors do."""
        return c3.plus(self.now, self.past)

    @property
    def past(self) -> Matrix:
        """The part of it that comes from late measurements."""
        return c3.matrix(lambda i, j: self.again[i] * self.V[i][j] + self.drift[i][j])

    @property
    def before(self) -> Row:
        """Whole samples that the oldest measurement looks back beyond the last one."""
        return c3.row(float(max(m - 1, 0)) for m in self.m)

    @property
    def pushed(self) -> Row:
        """How much of the push of one sample reaches p with a measurement: by itself, by way of older
        samples, and by what its path between two samples leaves the line."""
        return c3.row(
            1.0 + (b + 0.5) * pull if m else keep
            for m, b, pull, keep in zip(self.m, self.before, self.pull, self.keep, strict=True)
        )

    @property
    def heard(self) -> Row:
        """How much of the noise reaches p."""
        return c3.row(pull * (1.0 + b * pull) for b, pull in zip(self.before, self.pull, strict=True))

    def left_by(self, d: Row, noise: Row) -> Row:
        """What a measurement leaves in p, for one push d in each sample and this noise."""
        return c3.row(a * x + b * n for a, x, b, n in zip(self.pushed, d, self.heard, noise, strict=True))

    def share(self) -> Matrix:
        """How much of a push d in each sample reaches p, seen-again pulls included."""
        return c3.diagonal(c3.add(self.pushed, self.again))


def recursion(plant: Plant, K: Row, m: Ages, extra: Matrix | None = None, clipped: bool = True) -> Recursion:
    """The matrices of one sample for one gain; `extra`: see self_regressor; `clipped`: see Plant.growth."""
    h, bend, more = plant.h, plant.bend, extra or c3.scaled(0.0, c3.IDENTITY)
    size, growth = c3.plus(plant.magnitude(), more), c3.plus(plant.growth(clipped), more)
    pull = c3.scaled_row(h, K)
    keep = c3.row(abs(1.0 - p) for p in pull)
    change = c3.matrix(lambda i, j: h * size[i][j] + bend[i][j])

    def ends(i: int, less: float) -> float:
        # clip() may switch damping off, so the diagonal reaches from 1 - h |lo| to 1 + h hi
        return max(1.0 + h * growth[i][i] - less, h * size[i][i] - 1.0 + less) + bend[i][i]

    V = c3.matrix(lambda i, j: change[i][j] if i != j else ends(i, 0.0))

    def answered(i: int, j: int) -> float:
        if m[i] == 0:
            return keep[i] * V[i][j]
        return V[i][j] if i != j else max(ends(i, pull[i]), keep[i] * V[i][i])

    late = c3.row(float(max(x - 1, 0)) for x in m)
    return Recursion(
        V=V,
        now=c3.matrix(answered),
        keep=keep,
        again=c3.row(n * p * p for n, p in zip(late, pull, strict=True)),
        drift=c3.matrix(lambda i, j: late[i] * pull[i] * change[i][j]),
        pull=pull,
        m=m,
    )


def pushed(plant: Plant, heading_noise: float, part: float = CURVE) -> tuple[Matrix, Row]:
    """d = push force + calm: a bounded force, an error of heading, what one step misses of its path (`part`,
    see CURVE), what adaptation moves."""
    h, swing = plant.h, plant.swing()
    along = c3.plus(c3.IDENTITY, c3.matrix(lambda i, j: (0.5 + part) * h * swing[i][j]))
    rates = (*plant.most, max(abs(x) for x in plant.operating.ranges["r"]))
    curve = [part * h * h * total(a * b for a, b in zip(row, rates, strict=True)) for row in swing]
    moved = c3.apply(along, plant.moved)
    calm = c3.row(
        (h * p + plant.bend[i][3]) * heading_noise + curve[i] + h * moved[i]
        for i, p in enumerate(plant.heading)
    )
    return c3.scaled(h, c3.product(along, plant.inertia)), calm
