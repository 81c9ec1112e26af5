"""How the adversaries of one case look for the greatest error: at random, greedily, along the steepest way,
and from better places."""

import time
from dataclasses import dataclass

import numpy as np

from bench.stability.attack.bounds import along_the_way, bounds
from bench.stability.attack.cases import FULL_RUN, GROUPS, MIXED, AttackCase, Group, certified_for
from bench.stability.attack.orders import Orders, random_orders
from bench.stability.attack.run_batch import RunBatch, sail
from bench.stability.attack.steepest import worse
from bench.stability.attack.waters import Waters
from twin.live.certificate.certificate import Certificate
from twin.live.certificate.rolled import bound_at_any_ages
from twin.live.certificate.rolled_tube import RolledTube

RANDOM, GREEDY, STEEPEST, MOVED = "random", "greedy", "steepest", "moved"
PASSES = (RANDOM, GREEDY, STEEPEST, MOVED, STEEPEST)
LASTS = 2.2  # of the time in which the observer forgets
MOVE_SHARE = 0.1  # of the range, by which a place is moved
MOST_RUNS = 1200  # at once
ROUNDING = 1e-9
AXES = 3


@dataclass
class Attacked:
    """What became of the runs of one group; ratios by axis (u, v, r).

    of_tube, of_bound: the greatest error over the live bound, and over the ultimate one `bound` (None: there
    is none for such ticks and samples); by_pass: the greatest error over the ultimate bound (over the tube
    where there is none) of each way to attack; worst: which run broke a bound first."""

    group: Group
    runs: int
    left: int
    samples: int
    violations: int
    of_tube: np.ndarray
    of_bound: np.ndarray
    by_pass: dict[str, np.ndarray]
    first: str = ""
    bound: tuple[float, ...] | None = None

    @property
    def full(self) -> bool:
        """Whether the ultimate bound, which counts on full ticks and samples, is one for these runs."""
        return self.group.pattern == FULL_RUN

    def joined(self, other: "Attacked") -> "Attacked":
        """Both together."""
        passes = {**self.by_pass}
        for name, x in other.by_pass.items():
            passes[name] = np.maximum(passes.get(name, 0.0), x)
        return Attacked(
            self.group,
            self.runs + other.runs,
            self.left + other.left,
            self.samples + other.samples,
            self.violations + other.violations,
            np.maximum(self.of_tube, other.of_tube),
            np.maximum(self.of_bound, other.of_bound),
            passes,
            self.first or other.first,
            self.bound,
        )


@dataclass
class CaseAttacked:
    """All groups of one case; b, K, h, delay, inner: of its certificate."""

    case: AttackCase
    bound: tuple[float, ...]
    K: float
    h: float
    delay: int
    inner: int
    ticks: int
    groups: list[Attacked]
    seconds: float  # of processor time


def attack(
    case: AttackCase,
    runs: int,
    seed: int,
    groups: tuple[Group, ...] = GROUPS,
    passes: tuple[str, ...] = PASSES,
) -> CaseAttacked:
    """At least so many runs, shared among the groups and the passes."""
    begin = time.process_time()
    model, c = certified_for(case)
    ticks = horizon(c)
    each = max(round(runs / (len(groups) * len(passes))), 2 * AXES)
    found: list[Attacked] = []
    most = max(MOST_RUNS // len(groups), 2 * AXES)
    for batch in range(0, each, most):
        w = Waters(model, c, groups, min(most, each - batch), ticks, seed + batch)
        some = _batch(w, np.random.default_rng([seed, batch]), passes, f"{case.ship} {case.rate_hz:g} Hz")
        found = [a.joined(b) for a, b in zip(found, some, strict=True)] if found else some
    return CaseAttacked(
        case,
        c.bound,
        c.K[0],
        c.h,
        max(c.delays),
        c.inner,
        ticks,
        found,
        time.process_time() - begin,
    )


def horizon(c: Certificate) -> int:
    """Ticks in which the observer forgets where it began."""
    return max(int(np.ceil(LASTS / (c.K[0] * max(c.margin, 0.5) * c.h))), 12)


def _batch(w: Waters, rng: np.random.Generator, passes: tuple[str, ...], name: str) -> list[Attacked]:
    rolled = w.c.inner > 1
    parts = RolledTube(w.c).parts if rolled else None
    tube = np.empty(0) if rolled else bounds(w)
    orders = random_orders(w.c, w.groups, w.runs, w.ticks, rng)
    found: list[Attacked] = []
    was: RunBatch | None = None
    for k, way in enumerate(passes):
        if way == RANDOM:
            orders = random_orders(w.c, w.groups, w.runs, w.ticks, rng) if k else orders
        elif way == STEEPEST and was is not None:
            orders = worse(w, was)
        elif way == MOVED and was is not None:
            orders = _moved(w, was, tube, rng)
        was = sail(w, orders, greedy=way == GREEDY)
        in_set = was.inside
        if parts is not None:
            in_set = in_set & w.kept_inside(was.motions)
            tube, surely = along_the_way(w, was, parts)
            was = was._replace(inside=surely)
        judged = [_verified(w, was, in_set, tube, i, way, f"{name} pass {k}") for i in range(len(w.groups))]
        found = [a.joined(b) for a, b in zip(found, judged, strict=True)] if found else judged
    return found


def _moved(w: Waters, was: RunBatch, tube: np.ndarray, rng: np.random.Generator) -> Orders:
    """The better half of the runs of each group and aim, and beside them the same from places near theirs."""
    late = w.ticks // 2
    over = np.where(was.inside[late:, None], np.abs(was.error[late:]) / tube[late:], 0.0).max(axis=0)
    score = over[was.orders.axis, np.arange(over.shape[1])]
    chosen, children = np.arange(score.size), np.zeros(score.size, bool)
    group = np.arange(score.size) // w.runs
    for g in range(len(w.groups)):
        for axis in range(AXES):
            runs = np.flatnonzero((group == g) & (was.orders.axis == axis))
            best = runs[np.argsort(-score[runs])]
            half = best.size // 2
            chosen[best[best.size - half :]] = best[:half]
            children[best[best.size - half :]] = True
    return was.orders.of(chosen).moved(rng, MOVE_SHARE, children)


def _verified(
    w: Waters, was: RunBatch, in_set: np.ndarray, tube: np.ndarray, i: int, way: str, name: str
) -> Attacked:
    """`was.inside`: where the live bound is promised; `in_set`: where the ultimate one holds."""
    of = slice(i * w.runs, (i + 1) * w.runs)
    group, inside = w.groups[i], was.inside[1:, of]
    error = np.abs(was.error[1:, :, of])
    over = np.where(inside[:, None], error / tube[1:, :, of], 0.0)
    # of the heading nothing is promised, but inside the assumptions its bound must hold where it is a state
    rows = slice(None) if group.inside and w.c.estimated_heading else slice(AXES)
    broken = np.any(over[:, rows] > 1.0 + ROUNDING, axis=1)
    bound, of_bound = ultimate(w.c, group), np.zeros(AXES)
    if bound:
        ratio = error[:, :AXES] / np.array(bound)[:, None]
        of_bound = np.where(in_set[1:, None, of], ratio, 0.0).max(axis=(0, 2))
    first = ""
    if broken.any():
        k, run = np.argwhere(broken)[0]
        first = f"{name}, {way}, group {i}, run {run}, tick {k + 1}, over {over[k, :, run].round(3).tolist()}"
    late = over[w.ticks // 2 :, :AXES].max(axis=(0, 2))
    return Attacked(
        group,
        w.runs,
        int((~inside[-1]).sum()),
        int(inside.sum()),
        int(broken.sum()),
        over[:, :AXES].max(axis=(0, 2)),
        of_bound,
        {way: of_bound if group.pattern == FULL_RUN else late},
        first,
        bound,
    )


def ultimate(c: Certificate, group: Group) -> tuple[float, ...] | None:
    """The ultimate bound (u, v, r) of a group whose every tick is full and every sample comes; None: of
    another one, or there is none."""
    if group.pattern == FULL_RUN:
        return c.bound
    if group.pattern not in MIXED:
        return None
    found = bound_at_any_ages(c.plant, c.K, c.inner, c.noise, c.disturbance.at(0.0), c.heading_noise)
    return found[:AXES] if found else None
