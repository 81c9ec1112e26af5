"""The theorem of an observer that corrects at a sample's own time and runs on in inner steps
(twin/live/observer/rollback.py).

    one inner step of h/q:   x  <=  M x + d,     x = (|e_u|, |e_v|, |e_r|, |e_psi|)
    a sample of axis i:      x_i <= (1 - a) x_i + a n_i
    G = (1 - a) M^q,   b = (I - G)^-1 (sum_k<q M^k d + a M^q n)      all axes sampled together, each h

b bounds the published estimate, which is up to h after its samples.

    samples of each axis at times of its own, at most L apart and at most L old, k = q L/h:
    G' = (1 - a) I + k (M - I),   b' = (I - G')^-1 (a n + k d)

The proofs are in docs/stability.md.
"""

from collections.abc import Callable, Sequence
from math import log
from typing import Any, cast

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.comparison_systems import AXES, Matrix, Row
from twin.live.certificate.plant import Disturbance, Plant
from twin.live.certificate.recursion import Ages, pushed, recursion
from twin.live.certificate.theorem import NEVER, NOWHERE, Promise, ratio
from twin.num import num
from twin.physics.maths import total

Vector = tuple[float, ...]
Square = tuple[Vector, ...]
FOUR = range(4)


class InnerStep:
    """One inner step of the errors of (u, v, r, psi): M, what a force does, what the step itself costs."""

    def __init__(self, plant: Plant, clipped: bool = True) -> None:
        """plant: at the inner step's length; `clipped`: see Plant.growth."""
        h = plant.h
        V = recursion(plant, (1e-9 / h,) * 3, (0, 0, 0), clipped=clipped).V
        push, calm = pushed(plant, 0.0)
        turned = [h * plant.heading[i] + plant.bend[i][3] for i in AXES]
        half = 0.5 * h
        self.M: Square = (
            *((*V[i], turned[i]) for i in AXES),
            (half * V[2][0], half * V[2][1], half * (1.0 + V[2][2]), 1.0 + half * turned[2]),
        )
        self._push, self._calm, self._half = push, calm, half
        # how a turning that is taken for even misses the heading
        self._curve = 0.25 * h * h

    def pushes(self, force: Row, way_r: float) -> Vector:
        """d under this force, where the rate of turn changes by way_r at most [rad/s2]."""
        d = c3.add(c3.apply(self._push, force), self._calm)
        return (*d, self._half * d[2] + self._curve * way_r)


def inner(plant: Plant, q: int) -> Plant:
    """The plant over one of q inner steps."""
    return plant.at_period(plant.h / q)


def way(plant: Plant, force: Row) -> Row:
    """How fast it can change its motion under this force [m/s2, m/s2, rad/s2]."""
    return c3.add(plant.most, c3.apply(plant.inertia, force))


def assess_rolled(
    plant: Plant, K: Row, q: int, noise: Row, d: Disturbance, heading_noise: float, m: Ages
) -> Promise:
    """What holds where every sample takes away h K of the error of its own time, and q steps lead from there
    to the next."""
    step, a = InnerStep(inner(plant, q)), plant.h * K[0]
    runs, on = _sum_and_power(step.M, q)
    G = tuple(tuple((1.0 - a) * x for x in row) for row in on)
    worst = ratio(plant, K, None)
    end = settled(G)
    zero: Row = (0.0, 0.0, 0.0)
    usual = recursion(inner(plant, q), K, m)
    push, calm = pushed(inner(plant, q), 0.0)
    if end is None or not 0.0 < a <= 1.0:
        reason = (
            f"K = {num(K[0], 3)} 1/s does not hold with {q} inner steps of {num(plant.h / q, 2)} s: errors "
            f"grow by {num(radius(on), 3)} between two samples. Run the loop faster, or narrow the operating "
            "set."
        )
        none = c3.matrix(lambda i, j: NEVER)
        return Promise(False, reason, 1.0 - worst, -NEVER, NOWHERE, none, none, G, push, calm, usual)  # type: ignore[arg-type]

    def settles(force: Row, n: Vector, way_r: float) -> Vector:
        g = add4(apply4(runs, step.pushes(force, way_r)), apply4(on, tuple(a * x for x in n)))
        return apply4(end, g)

    still, rate = (0.0,) * 4, way(plant, d.calm)[2]
    alone = settles(zero, still, 0.0)
    by_force = _columns(lambda unit: settles(unit, still, plant_turns(plant, unit)), alone)
    by_noise = _columns(lambda unit: settles(zero, (*unit, 0.0), 0.0), alone)
    bound = settles(d.calm, (*noise, heading_noise), rate)
    reason = (
        f"K = {num(K[0], 3)} 1/s holds, {q} inner steps: a sample takes away {100 * a:.0f} % of an error."
    )
    decay = -log(radius(G)) / plant.h
    widths, matrix = cast(Row, bound[:3]), cast(Any, G)
    return Promise(True, reason, 1.0 - worst, decay, widths, by_force, by_noise, matrix, push, calm, usual)


def bound_at_any_ages(
    plant: Plant, K: Row, q: int, noise: Row, d: Row, heading_noise: float, spans: float = 1.0
) -> Vector | None:
    """b' of (u, v, r, psi) under the force d [N, N, N m], where no sample of an axis is older than `spans`
    periods, nor taken longer after the one before; None: the step of the proof gives none."""
    step, a, k = InnerStep(inner(plant, q)), plant.h * K[0], q * spans
    G = tuple(tuple((1.0 - a - k) * (i == j) + k * step.M[i][j] for j in FOUR) for i in FOUR)
    end, pushes = settled(G), step.pushes(d, way(plant, d)[2])
    if end is None:
        return None
    n = (*noise, heading_noise)
    return apply4(end, tuple(a * x + k * y for x, y in zip(n, pushes, strict=True)))


def plant_turns(plant: Plant, force: Row) -> float:
    """Bound of the yaw acceleration that a force [N, N, N m] makes [rad/s2]."""
    return c3.apply(plant.inertia, force)[2]


def _columns(of: Callable[[Row], Vector], alone: Vector) -> Matrix:
    """The derivative of a bound with each of three numbers."""
    columns = [[b - c for b, c in zip(of(unit), alone, strict=True)] for unit in c3.IDENTITY]
    return c3.matrix(lambda i, j: columns[j][i])


def product4(a: Square, b: Square) -> Square:
    """The matrix product A B of 4 x 4."""
    return tuple(tuple(total(row[k] * b[k][j] for k in FOUR) for j in FOUR) for row in a)


def apply4(a: Square, x: Sequence[float]) -> Vector:
    """The matrix times a column, A x."""
    return tuple(total(y * z for y, z in zip(row, x, strict=True)) for row in a)


def add4(*rows: Sequence[float]) -> Vector:
    """Sum of columns."""
    return tuple(map(total, zip(*rows, strict=True)))


def _sum_and_power(M: Square, q: int) -> tuple[Square, Square]:
    """I + M + ... + M^(q-1), and M^q."""
    on: Square = tuple(tuple(float(i == j) for j in FOUR) for i in FOUR)
    runs: Square = tuple((0.0,) * 4 for _ in FOUR)
    for _ in range(q):
        runs = tuple(add4(*pair) for pair in zip(runs, on, strict=True))
        on = product4(M, on)
    return runs, on


def settled(G: Square) -> Square | None:
    """(I - G)^-1 of a matrix with no negative entry, where that is a contraction, else None: by elimination,
    whose pivots are then positive."""
    rows = [[float(i == j) - G[i][j] for j in FOUR] + [float(i == j) for j in FOUR] for i in FOUR]
    for k in FOUR:
        pivot = rows[k][k]
        if not 1e-12 < pivot < NEVER:
            return None
        rows[k] = [x / pivot for x in rows[k]]
        for i in FOUR:
            if i != k:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k], strict=True)]
    return tuple(tuple(row[4:]) for row in rows)


def radius(G: Square) -> float:
    """The greatest eigenvalue of a matrix with no negative entry, from above."""
    low, high = 0.0, max(max(map(total, G)), 1e-300)
    for _ in range(50):
        middle = 0.5 * (low + high)
        scaled = tuple(tuple(x / middle for x in row) for row in G)
        low, high = (low, middle) if settled(scaled) else (middle, high)
    return high
