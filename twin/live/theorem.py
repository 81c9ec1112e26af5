"""The stabilizer's theorem in numbers: from the ship's slopes and a gain K to what is promised (docs/stability.md has the proof).

    nu_hat+ = nu_hat + [step of the physics from clip(nu_hat)] + h M^-1 f_learned + h K (y - nu_hat), the last m samples old
    |e+| <= now |e| + past max(|e|, |e-|, ...) + push d + rest,     G = now + past,     b = (I - G)^-1 (push d + rest)
"""

import json
from dataclasses import asdict, dataclass, replace
from math import exp, log, sqrt
from typing import Any

from . import comparison as c3
from .comparison import AXES, Matrix, Row
from .operating import NU, OperatingSet
from .plant import Disturbance, Plant

VERSION = 1
AXIS = ("surge", "sway", "yaw")
NEVER = float("inf")


@dataclass(frozen=True)
class Certificate:
    """What is promised of one ship with one K, one sample period and one delay; `ok` is False when nothing is, `reason` says why.

    margin: 1 - the fraction of K at which the promise ends; rate: guaranteed decay of an old error [1/s];
    gains_disturbance [m/s, m/s, rad/s per N, N, N m], gains_noise: b = gains_disturbance d + gains_noise n + rest;
    now, past, coast: an error's bound one sample on with a measurement (now, and the window of past ones) and without.
    """

    ok: bool
    reason: str
    K: Row
    delay_samples: int
    noise: Row
    disturbance: Disturbance
    margin: float
    rate: float
    bound: Row
    gains_disturbance: Matrix
    gains_noise: Matrix
    G: Matrix
    now: Matrix
    past: Matrix
    coast: Matrix
    push: Matrix
    push_coast: Matrix
    rest: Row
    rest_coast: Row
    plant: Plant
    ship: str = ""
    fingerprint: str = ""

    @property
    def h(self) -> float:
        return self.plant.h

    @property
    def operating(self) -> OperatingSet:
        return self.plant.operating

    def bound_in(self, H_s: float) -> Row:
        """The ultimate bound in a sea of that height [m/s, m/s, rad/s]."""
        more = tuple(H_s * x for x in self.disturbance.per_metre)
        return c3.add(self.bound, c3.apply(self.gains_disturbance, more))  # type: ignore[arg-type]

    def to_json(self) -> str:
        return json.dumps({"version": VERSION, **asdict(self)}, indent=1)

    @classmethod
    def from_json(cls, text: str) -> "Certificate":
        """The certificate that to_json wrote; ValueError, KeyError or TypeError when it is none of this version."""
        table = _tuples(json.loads(text))
        if table.pop("version") != VERSION:
            raise ValueError("certificate of another version")
        plant = table.pop("plant")
        ranges = plant.pop("operating")["ranges"]
        return cls(**table | {
            "plant": Plant(**plant, operating=OperatingSet(ranges)), "disturbance": Disturbance(**table["disturbance"])
        })  # fmt: skip


@dataclass(frozen=True)
class Flow:
    """What one sample of the physics does to a difference of two motions, from exponentials of the slopes; free of K.

    least, most: on the diagonal, of itself; across: |.| of the rest, off the diagonal; turned: by a heading error of one radian;
    stirred: what a push of one unit [m/s2, rad/s2] during the sample leaves at its end.
    """

    least: Row
    most: Row
    across: Matrix
    turned: Row
    stirred: Matrix

    def change(self) -> Matrix:
        """|V - I|: how far a difference can move in one sample."""
        return c3.matrix(lambda i, j: max(abs(self.least[i] - 1.0), abs(self.most[i] - 1.0)) if i == j else self.across[i][j])


def flow_of(plant: Plant, extra: Matrix | None = None) -> Flow:
    """|dPhi/dnu| <= exp(h A^M) with the heading as a fourth state; the diagonal from below by variation of constants."""
    h, more = plant.h, extra or c3.scaled(0.0, c3.IDENTITY)
    growth = c3.plus(plant.growth(), more)
    rows = [(*(h * growth[i][j] for j in AXES), h * plant.heading[i]) for i in AXES]
    w = c3.exponential((*rows, (0.0, 0.0, h, 0.0)))
    fall = [exp(h * (min(plant.lo[i][i], 0.0) - more[i][i])) for i in AXES]
    return Flow(
        least=tuple(f - (w[i][i] - exp(rows[i][i])) for i, f in enumerate(fall)), most=tuple(w[i][i] for i in AXES),  # type: ignore[arg-type]
        across=c3.matrix(lambda i, j: w[i][j] if i != j else 0.0), turned=tuple(w[i][3] for i in AXES),  # type: ignore[arg-type]
        stirred=c3.matrix(lambda i, j: h * w[i][j]),
    )  # fmt: skip


@dataclass(frozen=True)
class Recursion:
    """How an error bound goes on by one sample, before noise and disturbance are known (Theorem 2)."""

    now: Matrix
    past: Matrix
    coast: Matrix
    pull: Matrix  # h K
    echo: Matrix  # I + m h K: a push seen again in late measurements

    @property
    def G(self) -> Matrix:
        return c3.plus(self.now, self.past)


def recursion(flow: Flow, h: float, K: Row, m: int) -> Recursion:
    """The matrices of |e+| <= now |e| + past max(|e|, |e-|, ...), all without a negative entry."""
    pull = c3.diagonal(tuple(h * k for k in K))  # type: ignore[arg-type]

    def held(i: int, k: float) -> float:
        return max(abs(flow.least[i] - h * k), abs(flow.most[i] - h * k))

    return Recursion(
        now=c3.plus(flow.across, c3.diagonal(tuple(held(i, K[i]) for i in AXES))),  # type: ignore[arg-type]
        past=c3.scaled(m, c3.product(pull, c3.plus(flow.change(), pull))),
        coast=c3.plus(flow.across, c3.diagonal(tuple(held(i, 0.0) for i in AXES))),  # type: ignore[arg-type]
        pull=pull, echo=c3.plus(c3.IDENTITY, c3.scaled(m, pull)),
    )  # fmt: skip


def assess(
    plant: Plant,
    K: Row,
    m: int,
    noise: Row,
    d: Disturbance,
    heading_noise: float = 0.0,
    aligned: bool = True,
    extra: Matrix | None = None,
    flow: Flow | None = None,
) -> Certificate:
    """Theorems 1 and 2 of docs/stability.md for one gain, once the slopes are known."""
    h, flow = plant.h, flow or flow_of(plant, extra)
    if not aligned:  # an old measurement against the present estimate: the ship's way in between counts as noise
        way = c3.add(plant.most, c3.apply(plant.inertia, d.calm))
        noise, m = tuple(n + m * h * w for n, w in zip(noise, way, strict=True)), 0  # type: ignore[assignment]
    step = recursion(flow, h, K, m)
    calm: Row = tuple(t * heading_noise + h * e for t, e in zip(flow.turned, plant.step_error, strict=True))  # type: ignore[assignment]
    push = c3.product(flow.stirred, plant.inertia)
    inner = c3.product(step.echo, push)
    rest = c3.apply(step.echo, c3.add(calm, c3.apply(step.pull, noise)))
    end, worst, ratio = c3.settled(step.G), c3.radius(step.G), _ratio(plant, K, extra)
    blank = c3.matrix(lambda i, j: NEVER)
    return Certificate(
        ok=end is not None, reason=_reason(plant, flow, K, m, ratio, worst), K=K, delay_samples=m, noise=noise, disturbance=d,
        margin=1.0 - ratio, rate=-log(worst) / h if worst < NEVER else -NEVER, G=step.G, now=step.now, past=step.past, coast=step.coast,
        bound=c3.apply(end, c3.add(c3.apply(inner, d.calm), rest)) if end else (NEVER, NEVER, NEVER),
        gains_disturbance=c3.product(end, inner) if end else blank,
        gains_noise=c3.product(end, c3.product(step.echo, step.pull)) if end else blank,
        push=inner, push_coast=push, rest=rest, rest_coast=calm, plant=plant,
    )  # fmt: skip


def _ratio(plant: Plant, K: Row, extra: Matrix | None) -> float:
    """The share of K at which K - A^M ceases to be an M-matrix (Theorem 1)."""
    growth = plant.growth() if extra is None else c3.plus(plant.growth(), extra)
    return c3.radius(c3.matrix(lambda i, j: growth[i][j] / K[i]))


def gains_that_do(flow: Flow, h: float, m: int) -> tuple[float, float] | None:
    """The least and the greatest uniform K that the sample period and the delay allow [1/s]; None when there is none."""

    def holds(k: float) -> bool:
        return c3.contracts(recursion(flow, h, (k, k, k), m).G)

    grid = [10.0 ** (-4.0 + 0.05 * i) / h for i in range(84)]
    good = [k for k in grid if holds(k)]
    if not good:
        return None
    return _edge(holds, good[0], good[0] / 1.2), _edge(holds, good[-1], good[-1] * 1.2)


def usual_gain(plant: Plant, m: int, extra: Matrix | None = None) -> Row | None:
    """A K to begin with: four times the least, or the middle of what the period and the delay allow if that is less."""
    limits = gains_that_do(flow_of(plant, extra), plant.h, m)
    if limits is None:
        return None
    k = min(4.0 * limits[0], sqrt(limits[0] * limits[1]))
    return k, k, k


def best_gain(plant: Plant, m: int, noise: Row, d: Disturbance, H_s: float = 0.0, extra: Matrix | None = None) -> Row | None:
    """The K with the smallest bound against hostile noise and disturbance, each axis in units of its range; None when none is certified."""
    flow = flow_of(plant, extra)
    limits = gains_that_do(flow, plant.h, m)
    if limits is None:
        return None
    width = [hi - lo for lo, hi in (plant.operating.ranges[n] for n in NU)]

    def size(K: Row) -> float:
        step = recursion(flow, plant.h, K, m)
        end = c3.settled(step.G)
        if end is None:
            return NEVER
        g = c3.add(c3.apply(flow.stirred, c3.apply(plant.inertia, d.at(H_s))), c3.apply(step.pull, noise))
        return sum(b / w for b, w in zip(c3.apply(end, c3.apply(step.echo, g)), width, strict=True))

    K: Row = min(((k, k, k) for k in _between(*limits)), key=size)
    for factor in (1.5, 1.2, 1.07):
        for _ in range(6):
            trials = [K] + [tuple(k * f if i == j else k for j, k in enumerate(K)) for i in AXES for f in (factor, 1.0 / factor)]
            better = min(trials, key=size)
            if better == K:
                break
            K = better
    return K


def self_regressor(plant: Plant, weights: Matrix, slope: float, per_state: Row) -> Matrix:
    """What a network fed with its own estimate (coasting) adds to the growth of errors: |M^-1| |W| Lip(phi) |d zeta/d nu|.

    weights: diagonal of the greatest row norms of W [N, N, N m]; slope: `lipschitz(...)` of the trunk; per_state: |d zeta/d nu_j|.
    """
    return c3.product(plant.inertia, c3.matrix(lambda i, j: weights[i][i] * slope * per_state[j]))


def lipschitz(spectral_norms: "list[float]", steepest: float = 1.0998) -> float:
    """Lipschitz bound of a trunk from its layers' spectral norms and the steepest slope of its activation (swish: 1.0998)."""
    total = 1.0
    for norm in spectral_norms:
        total *= norm * steepest
    return total


def output_bound(row_norm: float, features: float, saturation: float) -> float:
    """|w phi + a q| <= min(||w|| ||phi||, saturation): what one row of the learned force can reach [N or N m]."""
    return min(row_norm * features, saturation)


def _reason(plant: Plant, flow: Flow, K: Row, m: int, ratio: float, worst: float) -> str:
    h = plant.h
    told = ", ".join(f"{k:.3g}" for k in K)
    if worst < 1.0:
        return f"K = ({told}) 1/s holds: old errors fade by {-log(worst) / h:.3g} 1/s; {100 * ratio:.0f} % of this K is the least."
    if not worst < NEVER:
        return "the slopes of the physics have no bound over the operating set. Narrow the set (speed, depth, distance to the banks)."
    limits = gains_that_do(flow, h, m)
    if limits is None:
        return (
            f"no K holds at a period of {h:g} s with measurements {m} samples old. "
            f"Run the loop every {_period_that_does(plant, m):.2g} s or faster, or narrow the operating set."
        )
    do = f"K from {limits[0]:.3g} to {limits[1]:.3g} 1/s would do (the same on every axis)."
    if max(K) < limits[0] or ratio >= 1.0:
        return f"K = ({told}) 1/s is too small: errors could grow faster than it pulls them back. {do}"
    return f"K = ({told}) 1/s is outside what a period of {h:g} s and measurements {m} samples old allow. {do}"


def _period_that_does(plant: Plant, m: int) -> float:
    """A shorter period at which some K holds [s]."""
    h = plant.h
    for _ in range(40):
        h *= 0.85
        if gains_that_do(flow_of(replace(plant, h=h)), h, m):
            break
    return h


def _edge(holds: Any, good: float, bad: float) -> float:
    for _ in range(30):
        middle = sqrt(good * bad)
        good, bad = (middle, bad) if holds(middle) else (good, middle)
    return good


def _between(low: float, high: float, count: int = 25) -> list[float]:
    return [low * (high / low) ** (i / (count + 1.0)) for i in range(1, count + 1)]


def _tuples(x: Any) -> Any:
    """JSON lists as the tuples they were."""
    return tuple(map(_tuples, x)) if isinstance(x, list) else {k: _tuples(v) for k, v in x.items()} if isinstance(x, dict) else x
