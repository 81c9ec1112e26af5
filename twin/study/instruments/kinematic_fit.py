"""The fit: Gauss-Newton over all voyages at once, and every scatter as large as what is left says (restricted
likelihood).

    sd^2 = sum r^2 / (n - what the block was bent to)
        [MacKay (1992) Neural Computation 4; Patterson & Thompson (1971)]
Numbers of the instruments are the ship's; the stream in the middle of a voyage is that voyage's own.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twin.study.instruments import arrow
from twin.study.instruments.blocks import blocks, misfit
from twin.study.instruments.problem import Problem
from twin.study.instruments.unknowns import INDEX, OWN, UNKNOWNS, day_to_day

PAIRS = ("place", "velocity", "wind")  # readings of two components
CORRELATED = 0.1  # an autocorrelation below this is taken for chance
ROUNDS, CLOSE = 12, 0.03  # Gauss-Newton rounds at most; steps in scatters of the numbers at which it is done
HALVINGS = 4  # of a step that fits worse
# readings that the usual size of a stream's changes, and of what drift does beside its formula, is worth
BELIEVED = 20.0
P = len(UNKNOWNS)
MINE = [INDEX[name] for name in OWN]
SHARED = [i for i in range(P) if i not in MINE]


@dataclass(frozen=True)
class KinematicFit:
    """Where the readings put the numbers. `theta` (V, P): of each voyage (the shared ones alike). `A`, `g`
    over the numbers of all voyages (SHARED, then each voyage's own): log likelihood = g d - d A d/2 for a
    step d from theta, the paths following."""

    theta: np.ndarray
    open: np.ndarray  # (Q,) bool: which were free
    A: np.ndarray
    g: np.ndarray
    width: np.ndarray  # (Q,) prior scatters
    blocks: tuple[tuple[arrow.Block, ...], ...]
    reduced: tuple[arrow.ArrowReduced, ...]
    log_likelihood: float

    @cached_property
    def at(self) -> np.ndarray:
        """(Q,) theta as one row: the shared numbers, then each voyage's own, in their own units."""
        return np.concatenate([self.theta[0, SHARED], self.theta[:, MINE].ravel()])

    def prior(self) -> np.ndarray:
        """(P,) prior scatter of each number of UNKNOWNS, in its own unit: of a shared one the widest of all
        voyages, of the stream that on the first."""
        return np.asarray(self.width[columns(0)])

    def sd(self) -> np.ndarray:
        """(Q,) scatter of each free number in its own unit, with the others free; 0 of one that was held."""
        return np.sqrt(np.diag(_step(self.A, self.g, self.width, self.open, self.at)[0]))


def columns(voyage: int) -> np.ndarray:
    """(P,) indices: where the numbers of this voyage stand among those of all."""
    out = np.empty(P, int)
    out[SHARED] = np.arange(len(SHARED))
    out[MINE] = len(SHARED) + len(MINE) * voyage + np.arange(len(MINE))
    return out


def opened(names: Sequence[str], voyages: int) -> np.ndarray:
    """(Q,) bool: these numbers free, on every voyage."""
    free = np.array([u.name in names for u in UNKNOWNS])
    return np.concatenate([free[SHARED], np.tile(free[MINE], voyages)])


def fit(
    problems: Sequence[Problem],
    names: Sequence[str],
    theta: np.ndarray | None = None,
    rounds: int = ROUNDS,
) -> KinematicFit:
    """All voyages with these numbers free and the others at nothing. `theta` (V, P): where the numbers start,
    in their own units (None: at nothing); `rounds`: Gauss-Newton rounds at most. The problems' states and
    scatters are left where they end."""
    V = len(problems)
    free = opened(names, V)
    at = np.zeros((V, P)) if theta is None else theta.copy()
    for v in range(V):
        at[v, ~free[columns(v)]] = 0.0
    width = _widths(problems)
    rng = np.random.default_rng(1)
    for done in range(1, rounds + 1):
        A, g, found, every = _normal(problems, at, free)
        covariance, step = _step(A, g, width, free, _row(at))
        if _stepped(problems, found, at, step, width):
            _scatters(problems, every, found, covariance, rng)
            for p in problems:
                p.remember()
        if done > 3 and np.all(np.abs(step[free]) < CLOSE * np.sqrt(np.diag(covariance)[free])):
            break
    A, g, found, every = _normal(problems, at)
    score = _score(problems, every, found, A, width, free, _row(at))
    return KinematicFit(at, free, A, g, width, tuple(map(tuple, every)), tuple(found), score)


def varying_with_the_day(found: KinematicFit, problems: Sequence[Problem]) -> KinematicFit:
    """The same fit of these problems, with what sound instruments show otherwise from day to day beside what
    the readings leave open."""
    reduced = tuple(from_day_to_day(red, p.widths) for red, p in zip(found.reduced, problems, strict=True))
    A, g = _together(problems, reduced)
    return replace(found, A=A, g=g, reduced=reduced)


def from_day_to_day(red: arrow.ArrowReduced, widths: np.ndarray) -> arrow.ArrowReduced:
    """What one voyage says of the ship's numbers theta (P,) where what it shows of them is theta + e,
    e ~ N(0, T) with T of `day_to_day`; e integrated out, in the rows with T > 0:

        A' = A - A (A + T^-1)^-1 A,   g' = g - A (A + T^-1)^-1 g

    `red`: its A (P, P) and g (P,); `widths` (P,): prior widths; each in the numbers' own units."""
    T = day_to_day()
    k = np.flatnonzero(np.diag(T) > 0.0)
    own = np.linalg.inv(T[np.ix_(k, k)] * np.outer(widths[k], widths[k]))
    taken = red.A[:, k] @ np.linalg.solve(red.A[np.ix_(k, k)] + own, np.column_stack([red.A[k], red.g[k]]))
    return replace(red, A=red.A - taken[:, :-1], g=red.g - taken[:, -1])


def _widths(problems: Sequence[Problem]) -> np.ndarray:
    each = [p.widths for p in problems]
    return np.concatenate([np.max(each, axis=0)[SHARED], *(w[MINE] for w in each)])


def _row(theta: np.ndarray) -> np.ndarray:
    return np.concatenate([theta[0, SHARED], theta[:, MINE].ravel()])


def _normal(
    problems: Sequence[Problem], theta: np.ndarray, free: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, list[arrow.ArrowReduced], list[list[arrow.Block]]]:
    """The normal equations of all voyages. `free` (Q,): only of these numbers, to step to; None: of all, with
    readings that err together told for what they are worth (the paths are fitted without: a bad fit errs
    together too, and would be believed)."""
    mine = [np.ones(P, bool) if free is None else free[columns(v)] for v in range(len(problems))]
    every = [blocks(p, at, own) for p, at, own in zip(problems, theta, mine, strict=True)]
    found = [
        arrow.reduce(bs, p.worth() if free is None else p.sd, p.fast)
        for bs, p in zip(every, problems, strict=True)
    ]
    return *_together(problems, found), found, every


def _together(
    problems: Sequence[Problem], found: Sequence[arrow.ArrowReduced]
) -> tuple[np.ndarray, np.ndarray]:
    """A and g over the numbers of all voyages."""
    Q = len(SHARED) + len(MINE) * len(problems)
    A, g = np.zeros((Q, Q)), np.zeros(Q)
    for v, red in enumerate(found):
        at = columns(v)
        A[np.ix_(at, at)] += red.A
        g[at] += red.g
    return _positive(A, _widths(problems)), g


def _positive(A: np.ndarray, width: np.ndarray) -> np.ndarray:
    """A without what rounding made negative, in prior widths."""
    size, axes = np.linalg.eigh(A * np.outer(width, width))
    return np.asarray((axes * np.maximum(size, 0.0)) @ axes.T / np.outer(width, width))


def _step(
    A: np.ndarray, g: np.ndarray, width: np.ndarray, free: np.ndarray, at: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Covariance of the free numbers (zero elsewhere), and the step to where readings and priors agree."""
    covariance, k = np.zeros_like(A), np.flatnonzero(free)
    covariance[np.ix_(k, k)] = np.linalg.inv(A[np.ix_(k, k)] + np.diag(width[k] ** -2.0))
    return covariance, covariance @ (g - at / width**2)


def _stepped(
    problems: Sequence[Problem],
    found: Sequence[arrow.ArrowReduced],
    theta: np.ndarray,
    step: np.ndarray,
    width: np.ndarray,
) -> bool:
    """A step of numbers and paths, halved while it would fit worse, HALVINGS times at most; whether it was a
    whole one, after which scatters may be judged."""
    before, x, at = _misfit(problems, theta, width), [p.x for p in problems], theta.copy()
    for halving in range(HALVINGS + 1):
        for p, was in zip(problems, x, strict=True):
            p.x = was
        theta[:] = at
        _move(problems, found, theta, step, 0.5**halving)
        if _misfit(problems, theta, width) <= before:
            break
    return halving == 0


def _misfit(problems: Sequence[Problem], theta: np.ndarray, width: np.ndarray) -> float:
    """What the numbers and paths as they are leave over, in scatters, squared."""
    left = sum(misfit(p, t) for p, t in zip(problems, theta, strict=True))
    return left + float(((_row(theta) / width) ** 2).sum())


def _move(
    problems: Sequence[Problem],
    found: Sequence[arrow.ArrowReduced],
    theta: np.ndarray,
    step: np.ndarray,
    share: float,
) -> None:
    for v, (p, red) in enumerate(zip(problems, found, strict=True)):
        mine = step[columns(v)]
        p.x = p.x + share * red.states(mine)
        theta[v] += share * mine


def _scatters(
    problems: Sequence[Problem],
    every: Sequence[Sequence[arrow.Block]],
    found: Sequence[arrow.ArrowReduced],
    covariance: np.ndarray,
    rng: np.random.Generator,
) -> None:
    """Each block's scatter, from what is left once the states have moved (to first order)."""
    for v, (p, bs, red) in enumerate(zip(problems, every, found, strict=True)):
        at = columns(v)
        bent = arrow.freedom(bs, p.sd, red, covariance[np.ix_(at, at)], rng)
        left = {b.name: b for b in bs}
        for name, b in left.items():
            if name == "tie":
                continue
            n = float(b.weight.sum())
            r = b.r - b.J @ red.mean - (b.G - b.J @ red.cross) @ covariance[np.ix_(at, at)] @ red.g
            more, usual = (BELIEVED, p.usual[name]) if name in p.usual else (0.0, 0.0)
            free = max(n - bent[name], 0.02 * n, 1.0)
            size = ((b.weight * r**2).sum() + more * usual**2) / (free + more)
            p.sd[name] = max(float(np.sqrt(size)), p.least[name])
            errs = name in p.by or name == "drift"
            p.lasts[name] = _lasting(r * b.weight, 1 + (name in PAIRS)) if errs else 1.0


def _lasting(r: np.ndarray, parts: int) -> float:
    """How many readings in a row err together: 1 + 2 sum of the autocorrelations, as far as they are clear
    (Geyer 1992). So much less do all of them tell than if each erred by itself."""
    found = []
    for x in np.split(r, parts):
        total, power = 1.0, max(float(x @ x), 1e-30)
        for k in range(1, x.size // 8):
            share = float(x[k:] @ x[:-k]) / power
            if share < CORRELATED:
                break
            total += 2.0 * share
        found.append(total)
    return float(np.mean(found))


def _score(
    problems: Sequence[Problem],
    every: Sequence[Sequence[arrow.Block]],
    found: Sequence[arrow.ArrowReduced],
    A: np.ndarray,
    width: np.ndarray,
    free: np.ndarray,
    at: np.ndarray,
) -> float:
    """Log evidence of these free numbers, up to a constant of the readings (Laplace)."""
    total = 0.0
    for p, bs, red in zip(problems, every, found, strict=True):
        total, sd = total - 0.5 * red.log_det, p.worth()
        for b in bs:
            n = float(b.weight.sum())
            total -= 0.5 * float((b.weight * (b.r / sd[b.name]) ** 2).sum()) + n * float(np.log(sd[b.name]))
    k = np.flatnonzero(free)
    precision = A[np.ix_(k, k)] * np.outer(width[k], width[k]) + np.eye(k.size)
    return total - 0.5 * float(np.linalg.slogdet(precision)[1]) - 0.5 * float(((at[k] / width[k]) ** 2).sum())
