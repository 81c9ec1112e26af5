"""The stabilizer's theorem in numbers: from the ship's slopes and a gain K to what is promised.

    predict   nu- = one Runge-Kutta step from nu+, f_learned held                  its error one sample on: E
    correct   nu+ = nu- + h K (y - nu_hat), compared with the best of its own time   its error, published: p
    E <= V p + d,   p <= W p + again max(E) + drift max(p) + c,   max over the last 2m+1 samples
    G = W + again V + drift,   b = (I - G)^-1 g   when the greatest eigenvalue of G is under one

The proof is in docs/stability.md.
"""

from dataclasses import dataclass
from math import log

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.comparison_systems import Matrix, Row
from twin.live.certificate.gains import gains_that_do
from twin.live.certificate.plant import Disturbance, Plant
from twin.live.certificate.recursion import NEVER, Ages, Recursion, pushed, recursion
from twin.num import as_given, num

NOWHERE: Row = (NEVER, NEVER, NEVER)


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
    told, late = ", ".join(num(k, 3) for k in K), "/".join(map(str, m))
    if worst < 1.0:
        least = f"{100 * ratio:.0f} % of it is the least that pulls back faster than errors can grow"
        return f"K = ({told}) 1/s holds: {least}."
    if not worst < NEVER:
        cure = "Narrow the set (speed, depth, distance to the banks)."
        return f"the slopes of the physics have no bound over the operating set. {cure}"
    limits = gains_that_do(plant, m, extra)
    if limits is None:
        period = _period_that_does(plant, m, extra)
        cure = f"Run the loop every {num(period, 2)} s or faster, or narrow the operating set."
        return f"no K holds at a period of {as_given(plant.h)} s with measurements {late} samples old. {cure}"
    do = f"K from {num(limits[0], 3)} to {num(limits[1], 3)} 1/s would do (the same on every axis)."
    if max(K) < limits[0] or ratio >= 1.0:
        return f"K = ({told}) 1/s is too small: errors could grow faster than it pulls them back. {do}"
    allowed = f"what a period of {as_given(plant.h)} s and measurements {late} samples old allow"
    return f"K = ({told}) 1/s is outside {allowed}. {do}"


def _period_that_does(plant: Plant, m: Ages, extra: Matrix | None) -> float:
    """A shorter period at which some K holds [s]."""
    h = plant.h
    for _ in range(60):
        h *= 0.9
        if gains_that_do(plant.at_period(h), m, extra):
            break
    return h
