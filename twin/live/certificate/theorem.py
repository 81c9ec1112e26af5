"""The stabilizer's theorem in numbers: from the ship's slopes and a gain K to what is promised.

    predict   nu- = one Runge-Kutta step from nu+, f_learned held                  its error one sample on: E
    correct   nu+ = nu- + h K (y - nu_hat), compared with the best of its own time   its error, published: p
    E <= V p + d,   p <= W p + again max(E) + drift max(p) + c,   max over the last 2m+1 samples
    G = W + again V + drift,   b = (I - G)^-1 g   when the greatest eigenvalue of G is under one

The proof is in docs/stability.md.
"""

from dataclasses import dataclass
from math import log, sqrt
from typing import Any

from twin.live.certificate import comparison as c3
from twin.live.certificate.comparison import AXES, Matrix, Row
from twin.live.certificate.plant import Disturbance, Plant
from twin.live.observer.operating import NU
from twin.physics.maths import total

Ages = tuple[int, int, int]
# of (h^2 times the slope's change) that one step misses: 1/4, and the rest for ticks up to a fifth longer
# than was stepped for
CURVE = 0.26
SURE = 3.0  # times the least K: what the loop's own is at least
NEVER = float("inf")
NOWHERE: Row = (NEVER, NEVER, NEVER)


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
        return c3.plus(self.now, self.past)

    @property
    def past(self) -> Matrix:
        return c3.matrix(lambda i, j: self.again[i] * self.V[i][j] + self.drift[i][j])

    @property
    def before(self) -> Row:
        """Whole samples that the oldest measurement looks back beyond the last one."""
        return tuple(float(max(m - 1, 0)) for m in self.m)  # type: ignore[return-value]

    @property
    def pushed(self) -> Row:
        """How much of the push of one sample reaches p with a measurement: by itself, by way of older
        samples, and by what its path between two samples leaves the line."""
        return tuple(
            1.0 + (b + 0.5) * pull if m else keep
            for m, b, pull, keep in zip(self.m, self.before, self.pull, self.keep, strict=True)
        )  # type: ignore[return-value]

    @property
    def heard(self) -> Row:
        """How much of the noise reaches p."""
        return tuple(pull * (1.0 + b * pull) for b, pull in zip(self.before, self.pull, strict=True))  # type: ignore[return-value]

    def told(self, d: Row, noise: Row) -> Row:
        """What a measurement leaves in p, for one push d in each sample and this noise."""
        return tuple(a * x + b * n for a, x, b, n in zip(self.pushed, d, self.heard, noise, strict=True))  # type: ignore[return-value]

    def share(self) -> Matrix:
        """How much of a push d in each sample reaches p, seen-again pulls included."""
        return c3.diagonal(tuple(a + b for a, b in zip(self.pushed, self.again, strict=True)))  # type: ignore[arg-type]


def recursion(plant: Plant, K: Row, m: Ages, extra: Matrix | None = None) -> Recursion:
    """The matrices of one sample for one gain; `extra`: see self_regressor."""
    h, bend, more = plant.h, plant.bend, extra or c3.scaled(0.0, c3.IDENTITY)
    size, growth = c3.plus(plant.magnitude(), more), c3.plus(plant.growth(), more)
    pull: Row = tuple(h * k for k in K)  # type: ignore[assignment]
    keep: Row = tuple(abs(1.0 - p) for p in pull)  # type: ignore[assignment]
    change = c3.matrix(lambda i, j: h * size[i][j] + bend[i][j])

    def ends(i: int, less: float) -> float:
        # clip() may switch damping off, so the diagonal reaches from 1 - h |lo| to 1 + h hi
        return max(1.0 + h * growth[i][i] - less, h * size[i][i] - 1.0 + less) + bend[i][i]

    V = c3.matrix(lambda i, j: change[i][j] if i != j else ends(i, 0.0))

    def answered(i: int, j: int) -> float:
        if m[i] == 0:
            return keep[i] * V[i][j]
        return V[i][j] if i != j else max(ends(i, pull[i]), keep[i] * V[i][i])

    late: Row = tuple(float(max(x - 1, 0)) for x in m)  # type: ignore[assignment]
    return Recursion(
        V=V,
        now=c3.matrix(answered),
        keep=keep,
        again=tuple(n * p * p for n, p in zip(late, pull, strict=True)),  # type: ignore[arg-type]
        drift=c3.matrix(lambda i, j: late[i] * pull[i] * change[i][j]),
        pull=pull,
        m=m,
    )


@dataclass(frozen=True)
class Promise:
    """What holds for one gain; `ok` is False when nothing does, and `reason` says why.

    margin: 1 - the share of K at which K - A^M ceases to be an M-matrix; rate: guaranteed decay of an old
    error [1/s]; bound = gains_disturbance d + gains_noise n + what the sampling itself costs [m/s, m/s,
    rad/s]. push: what a force [N, N, N m] does in one sample; calm: what heading error and sampling do.
    """

    ok: bool
    reason: str
    margin: float
    rate: float
    bound: Row
    gains_disturbance: Matrix
    gains_noise: Matrix
    G: Matrix
    push: Matrix
    calm: Row
    step: Recursion


def assess(
    plant: Plant,
    K: Row,
    m: Ages,
    noise: Row,
    d: Disturbance,
    heading_noise: float = 0.0,
    extra: Matrix | None = None,
) -> Promise:
    """Theorems 1 and 2 of docs/stability.md for one gain, once the slopes are known."""
    step = recursion(plant, K, m, extra)
    push, calm = pushed(plant, heading_noise)
    end, worst, share = c3.settled(step.G), c3.radius(step.G), ratio(plant, K, extra)
    reason = _reason(plant, K, m, share, worst, extra)
    if end is None:
        none = c3.matrix(lambda i, j: NEVER)
        return Promise(False, reason, 1.0 - share, -NEVER, NOWHERE, none, none, step.G, push, calm, step)
    by_force, by_noise = (
        c3.product(c3.product(end, step.share()), push),
        c3.product(end, c3.diagonal(step.heard)),
    )
    sampling = c3.apply(c3.product(end, step.share()), calm)
    bound = c3.add(c3.apply(by_force, d.calm), c3.apply(by_noise, noise), sampling)
    return Promise(
        True, reason, 1.0 - share, _rate(step, plant.h), bound, by_force, by_noise, step.G, push, calm, step
    )


def pushed(plant: Plant, heading_noise: float, part: float = CURVE) -> tuple[Matrix, Row]:
    """d = push force + calm: a bounded force, an error of heading, what one step misses of its path (`part`,
    see CURVE), what adaptation moves."""
    h, swing = plant.h, plant.swing()
    along = c3.plus(c3.IDENTITY, c3.matrix(lambda i, j: (0.5 + part) * h * swing[i][j]))
    rates = (*plant.most, max(abs(x) for x in plant.operating.ranges["r"]))
    curve = [part * h * h * total(a * b for a, b in zip(row, rates, strict=True)) for row in swing]
    moved = c3.apply(along, plant.moved)
    calm = tuple(
        (h * p + plant.bend[i][3]) * heading_noise + curve[i] + h * moved[i]
        for i, p in enumerate(plant.heading)
    )
    return c3.scaled(h, c3.product(along, plant.inertia)), calm  # type: ignore[return-value]


def gains_that_do(plant: Plant, m: Ages, extra: Matrix | None = None) -> tuple[float, float] | None:
    """The least and the greatest uniform K that the period and the delay allow [1/s]; None: there is none."""

    def holds(k: float) -> bool:
        return c3.contracts(recursion(plant, (k, k, k), m, extra).G)

    grid = [10.0 ** (-6.0 + 0.05 * i) / plant.h for i in range(124)]
    good = [k for k in grid if holds(k)]
    if not good:
        return None
    return _edge(holds, good[0], good[0] / 1.2), _edge(holds, good[-1], good[-1] * 1.2)


def usual_gain(plant: Plant, m: Ages, extra: Matrix | None = None) -> Row | None:
    """A K to begin with: four times the least, or the middle of what is allowed if that is less."""
    limits = gains_that_do(plant, m, extra)
    if limits is None:
        return None
    k = min(4.0 * limits[0], sqrt(limits[0] * limits[1]))
    return k, k, k


def suited_gain(plant: Plant, m: Ages, usual: float, fastest: float) -> Row:
    """The loop's K: the usual one, or three times the least if that is more, so that a third of it would do;
    not above the middle of what is allowed, nor above what the loop lets act. The usual one where none
    holds."""
    limits = gains_that_do(plant, m)
    k = usual
    if limits is not None and limits[0] < fastest:
        k = min(max(usual, SURE * limits[0]), sqrt(limits[0] * limits[1]), fastest)
    return k, k, k


def best_gain(
    plant: Plant, m: Ages, noise: Row, d: Disturbance, H_s: float = 0.0, extra: Matrix | None = None
) -> Row | None:
    """The K with the smallest bound against hostile noise and disturbance, each axis in units of its range;
    None when none is certified.
    """
    limits = gains_that_do(plant, m, extra)
    if limits is None:
        return None
    width = [hi - lo for lo, hi in (plant.operating.ranges[n] for n in NU)]
    push, calm = pushed(plant, 0.0)
    during = c3.add(c3.apply(push, d.at(H_s)), calm)

    def size(K: Row) -> float:
        step = recursion(plant, K, m, extra)
        end = c3.settled(step.G)
        if end is None:
            return NEVER
        g = c3.add(c3.apply(step.share(), during), c3.apply(c3.diagonal(step.heard), noise))
        return total(b / w for b, w in zip(c3.apply(end, g), width, strict=True))

    uniform: list[Row] = [(k, k, k) for k in _between(*limits)]
    K = min(uniform, key=size)
    for factor in (1.5, 1.2, 1.07):
        for _ in range(6):
            trials: list[Row] = [K] + [_one_changed(K, i, f) for i in AXES for f in (factor, 1.0 / factor)]
            better = min(trials, key=size)
            if better == K:
                break
            K = better
    return K


def ratio(plant: Plant, K: Row, extra: Matrix | None) -> float:
    """The share of K at which K - A^M ceases to be an M-matrix (Theorem 1)."""
    growth = plant.growth() if extra is None else c3.plus(plant.growth(), extra)
    return c3.radius(c3.matrix(lambda i, j: growth[i][j] / K[i]))


def _rate(step: Recursion, h: float) -> float:
    """The decay of a bound that looks back over 2m+1 samples: the x with x = greatest eigenvalue of (now +
    x^-2m past).
    """
    low, high = 0.0, 1.0
    for _ in range(60):
        x = 0.5 * (low + high)
        under = x > 0.0 and c3.contracts(c3.plus(step.now, c3.scaled(x ** (-2 * max(step.m)), step.past)), x)
        low, high = (low, x) if under else (x, high)
    return -log(high) / h


def _reason(plant: Plant, K: Row, m: Ages, ratio: float, worst: float, extra: Matrix | None) -> str:
    told, late = ", ".join(f"{k:.3g}" for k in K), "/".join(map(str, m))
    if worst < 1.0:
        least = f"{100 * ratio:.0f} % of it is the least that pulls back faster than errors can grow"
        return f"K = ({told}) 1/s holds: {least}."
    if not worst < NEVER:
        cure = "Narrow the set (speed, depth, distance to the banks)."
        return f"the slopes of the physics have no bound over the operating set. {cure}"
    limits = gains_that_do(plant, m, extra)
    if limits is None:
        period = _period_that_does(plant, m, extra)
        cure = f"Run the loop every {period:.2g} s or faster, or narrow the operating set."
        return f"no K holds at a period of {plant.h:g} s with measurements {late} samples old. {cure}"
    do = f"K from {limits[0]:.3g} to {limits[1]:.3g} 1/s would do (the same on every axis)."
    if max(K) < limits[0] or ratio >= 1.0:
        return f"K = ({told}) 1/s is too small: errors could grow faster than it pulls them back. {do}"
    allowed = f"what a period of {plant.h:g} s and measurements {late} samples old allow"
    return f"K = ({told}) 1/s is outside {allowed}. {do}"


def _period_that_does(plant: Plant, m: Ages, extra: Matrix | None) -> float:
    """A shorter period at which some K holds [s]."""
    h = plant.h
    for _ in range(60):
        h *= 0.9
        if gains_that_do(plant.at_period(h), m, extra):
            break
    return h


def _one_changed(K: Row, axis: int, factor: float) -> Row:
    u, v, r = (k * factor if i == axis else k for i, k in enumerate(K))
    return u, v, r


def _edge(holds: Any, good: float, bad: float) -> float:
    for _ in range(30):
        middle = sqrt(good * bad)
        good, bad = (middle, bad) if holds(middle) else (good, middle)
    return good


def _between(low: float, high: float, count: int = 25) -> list[float]:
    return [low * (high / low) ** (i / (count + 1.0)) for i in range(1, count + 1)]
