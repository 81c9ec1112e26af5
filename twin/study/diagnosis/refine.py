"""A hypothesis relinearised at its estimate, so that what is not linear counts in full.

An effect is granted that its form is only roughly right: a share of its own force may be something else, the
one of DOUBTS under which the voyages are most probable (no share of what the ship meets because a stream
carries it: that is the hull's own force)."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from twin.physics.model import Model
from twin.study.diagnosis.bent import MULTI_START, bent_numbers, late_numbers
from twin.study.diagnosis.case import SCENARIOS, Case
from twin.study.diagnosis.relinearised import about, clipped
from twin.study.estimation.columns import Unknown
from twin.study.estimation.linear import Linear
from twin.study.reference.evidence import (
    Hypothesis,
    Posterior,
    Reduced,
    boxed,
    log_evidence,
    posterior,
    sized,
    weigh_with,
)

DOUBTS = (0.2, 0.1, 0.05)
IRREGULAR = (1.0, 0.5)  # and of one that comes and goes with what no input shows
Sets = tuple[str, ...]
NEWTON = 8  # steps, at most
BEHIND = 60.0  # log odds behind the likeliest scenario from which a restless one is out of the question
LEAST_STEP_SHARE = 0.2  # of a step that an iteration tries: of 345 iterations four got higher by less
STANDS = 0.05  # prior widths that a step may still move


@dataclass(frozen=True)
class Found:
    """A hypothesis with the parameters it would need."""

    hypothesis: Hypothesis
    posterior: Posterior
    model: Model  # on the first voyage
    doubt: float = 0.0  # share of its own force that may be something else
    open_loop_error_m: float = float("nan")  # held-out position error, when it was asked (open_loop_check.py)
    # and what it would be were this the truth, with the noise of the reference voyages
    expected_error_m: float = float("nan")
    # what the voyages say about that place, in its noise scenario
    reduced: Reduced | None = field(default=None, repr=False)
    steady: bool = False  # whether it holds a stream that may change, and did not (steady.py)
    models: tuple[Model, ...] = ()  # on each voyage, where they have numbers of their own

    def on(self, voyage: int) -> Model:
        """The model on one of the voyages."""
        return self.models[voyage] if self.models else self.model


def largest(parts: Iterable[Found]) -> Found | None:
    """Of what was found, what holds most effects, and of these the likeliest; None of none."""
    return max(parts, key=lambda f: (len(f.hypothesis.effects), f.hypothesis.log_weight), default=None)


def first_guess(about: Reduced, chosen: Sets) -> np.ndarray:
    """(Q,) the numbers of a set as the voyages have them to first order, inside their boxes, in prior
    widths."""
    return boxed(about, chosen, posterior(about, chosen)).z


def refine(
    case: Case,
    chosen: Sets,
    scenario: str,
    z: np.ndarray,
    wider: Sequence[str],
    hoped: float = -np.inf,
    part: Found | None = None,
) -> tuple[Found, list[Hypothesis]]:
    """Newton steps on the effects' own parameters, begun at z (Q,) and taken in `scenario`, until they stand;
    begun again farther out when that explains nothing plainly, or when a number whose effect is bent ended at
    nothing, or the whole below the log weight that was `hoped` for to first order (not those of effects that
    were found already, in a `part` of the set: they were looked for far out when they were); and from where
    that part stands, when the whole ended below it. What was found; and, about it, the hypothesis in every
    noise scenario, every one that has one of `wider` beside it, and every one without what any day brings."""
    mine = np.array([i for i, u in enumerate(case.effects) if u.owner in chosen])
    narrow, kept = case.along(case.lines, chosen)
    at = np.zeros_like(z)
    top = best_place(narrow, chosen, scenario, z[kept], hoped, part, kept)
    at[kept] = top.at
    models, lines = about(case, at, mine, case.unknowns)
    whole, _ = case.along(lines)
    doubt = form_share(narrow, chosen, top)
    reduced = _in_each(whole, whole.lines, at, doubt, top.near)
    judged = _refined(case, chosen, reduced)
    best = max(judged, key=lambda h: h.log_weight)
    far = [h for scenario, h in top.judged.items() if scenario not in reduced]
    others = [*_beside(case, chosen, reduced, wider), *_any_day(case, chosen, reduced)]
    here = reduced[best.scenario]
    told = boxed(here, chosen, sized(here, chosen))
    found = Found(best, told, models[0], doubt, reduced=here, models=tuple(models))
    return found, [*judged, *far, *others]


def best_place(
    case: Case,
    chosen: Sets,
    scenario: str,
    z: np.ndarray,
    hoped: float,
    part: Found | None = None,
    kept: np.ndarray | slice = slice(None),
) -> "BestPlace":
    """The best of the iterations of `refine`, from z (E,) (`kept` (Q,): mask of all effects' numbers)."""
    known = part.hypothesis.effects if part else ()
    mine = np.array([i for i, u in enumerate(case.effects) if u.owner in chosen])
    new = np.array([i for i in mine if case.effects[i].owner not in known], dtype=int)
    top = BestPlace.of(case, chosen, *newton(case, chosen, mine, scenario, z)[1:])
    if part and top.best.log_weight < min(hoped, _without_gain(case, part, chosen)):
        at = np.where([u.owner in known for u in case.effects], part.posterior.z[kept], 0.0)
        top = top.or_from(case, chosen, mine, at)
    first = clipped(case, z)
    first[first == 0.0] = 1.0  # what its box had pressed to nothing begins at a plausible size
    for k, factor in enumerate(MULTI_START):
        plain, fallen = SCENARIOS[top.best.scenario].plain, top.best.log_weight < hoped
        bent = [] if plain and not fallen and top.at[new].all() else bent_numbers(case, new, top.at)
        lost = [i for i in bent if fallen or top.at[i] == 0.0]
        # numbers that work in proportion have one best place, which the first iteration from afar found
        if not lost and (plain or (k and not bent)):
            break
        first[[i for i in lost if top.at[i] == 0.0]] = 1.0
        far = z.copy()
        far[new] = factor * first[new]
        top = top.or_from(case, chosen, mine, far)
    # about none, a slow gear is seen by its delay alone
    if all(case.catalogue[name].kind == "Lag" for name in chosen):
        for i in mine:
            top = top.or_from(case, chosen, mine, MULTI_START[-1] * np.eye(z.size)[i])
    return _a_step_on(case, chosen, mine, top)


def _a_step_on(case: Case, chosen: Sets, mine: np.ndarray, top: "BestPlace") -> "BestPlace":
    """The same, or a better place where what is shown late is so by a grid step more, or less: what it shows
    is read at the nearest step (`when_true`), and seems less likely on the way from one to the next."""
    if not (late := late_numbers(case, mine)):
        return top
    step = max(t.h for t in case.tracks) / np.array([case.effects[i].sd for i in late])
    before = None
    while before is not top:
        before = top
        for side in (1.0, -1.0):
            far = before.at.copy()
            far[late] += side * step
            top = top.or_from(case, chosen, mine, far)
    return top


def _without_gain(case: Case, part: Found, chosen: Sets) -> float:
    """Log weight of a set whose new effects say nothing beside a part of it."""
    h = part.hypothesis
    return h.log_evidence + case.log_prior(chosen, h.scenario)


@dataclass(frozen=True)
class BestPlace:
    """The best place that was found so far, the tracks about it, and the hypothesis there in each scenario
    (by columns of its own alone)."""

    at: np.ndarray
    lines: Sequence[Linear] = field(repr=False)
    judged: Mapping[str, Hypothesis]

    @classmethod
    def of(cls, case: Case, chosen: Sets, at: np.ndarray, lines: Sequence[Linear]) -> "BestPlace":
        """This place, `at` (E,), judged in every scenario that can be."""
        names = [n for n in SCENARIOS if np.isfinite(case.log_prior(chosen, n))]
        return cls(
            at,
            lines,
            {h.scenario: h for h in _refined(case, chosen, _in_each(case, lines, at, DOUBTS[0], names))},
        )

    @property
    def near(self) -> list[str]:
        """The scenarios that may still be the likeliest once others are beside it: the plain ones, and those
        that are not far behind."""
        return [
            n
            for n, h in self.judged.items()
            if SCENARIOS[n].plain or h.log_weight > self.best.log_weight - BEHIND
        ]

    @property
    def best(self) -> Hypothesis:
        """The likeliest there."""
        return max(self.judged.values(), key=lambda h: h.log_weight)

    def or_from(self, case: Case, chosen: Sets, mine: np.ndarray, z: np.ndarray) -> "BestPlace":
        """This place, or a better one to which an iteration in the usual scenario leads from `z` (E,);
        others are asked only if that one is better."""
        here, at, lines = newton(case, chosen, mine, "usual", z)
        if here.log_weight <= self.judged["usual"].log_weight:
            return self
        return max(self, BestPlace.of(case, chosen, at, lines), key=lambda top: top.best.log_weight)


def newton(
    case: Case, chosen: Sets, mine: np.ndarray, scenario: str, z: np.ndarray
) -> tuple[Hypothesis, np.ndarray, Sequence[Linear]]:
    """Where the effects' parameters `mine` (M,) come to stand: the hypothesis there (in that scenario, by
    columns of its own alone), the place (E,), and the tracks about it. A step after which the voyages are
    less probable is taken back by half, and by half again: what is bent may lead a whole step astray."""
    lines: Sequence[Linear] = case.lines
    merit, best, aim, share, here = (
        -np.inf,
        np.zeros_like(z),
        z,
        1.0,
        Hypothesis(chosen, scenario, -np.inf, 0.0),
    )
    for _ in range(NEWTON):
        at = np.zeros_like(z)
        at[mine] = clipped(case, best + share * (aim - best))[mine]
        tried = about(case, at, mine, [case.effects[i] for i in mine])[1]
        reduced = reduced_at(case, tried, scenario, at)
        if reduced and (now := reduced.base - 0.5 * float(at @ at)) > merit:
            own = posterior(reduced, chosen)
            here = Hypothesis(
                chosen, scenario, log_evidence(reduced, chosen, own), case.log_prior(chosen, scenario)
            )
            merit, best, lines, share, aim = now, at, tried, 1.0, boxed(reduced, chosen, own).z
        else:
            share *= 0.5
        if share < LEAST_STEP_SHARE or share * np.max(np.abs(aim - best)[mine]) < STANDS:
            break
    return here, best, lines


def reduced_at(case: Case, lines: Sequence[Linear], scenario: str, at: np.ndarray) -> Reduced | None:
    """What the voyages say at (Q,); nothing where no filter can follow such a ship (without its mass, it
    answers within a step)."""
    try:
        return case.reduced(lines, case.scenarios([scenario], DOUBTS[0]), at)[0]
    except np.linalg.LinAlgError:
        return None


def _in_each(
    case: Case, lines: Sequence[Linear], at: np.ndarray, doubt: float, names: Sequence[str]
) -> dict[str, Reduced]:
    """What these lines say of the effects in each of these noise scenarios."""
    return dict(zip(names, case.reduced(lines, case.scenarios(names, doubt), at), strict=True))


def _refined(case: Case, chosen: Sets, reduced: dict[str, Reduced]) -> list[Hypothesis]:
    return [
        Hypothesis(chosen, n, log_evidence(r, chosen, posterior(r, chosen)), case.log_prior(chosen, n))
        for n, r in reduced.items()
    ]


def form_share(case: Case, chosen: Sets, top: BestPlace) -> float:
    """The share of DOUBTS (or of IRREGULAR, for what comes and goes) under which the voyages are most
    probable."""
    shares = (*IRREGULAR, *DOUBTS) if any(case.catalogue[name].irregular for name in chosen) else DOUBTS
    reduced = case.reduced(
        top.lines, [case.scenarios([top.best.scenario], share)[0] for share in shares], top.at
    )
    return shares[int(np.argmax([posterior(r, chosen).log_evidence for r in reduced]))]


def _beside(case: Case, chosen: Sets, reduced: dict[str, Reduced], wider: Sequence[str]) -> list[Hypothesis]:
    out = []
    for scenario, r in reduced.items():
        for name, evidence in weigh_with(r, chosen, wider):
            both = tuple(n for n in case.candidates if n in (*chosen, name))
            out.append(Hypothesis(both, scenario, evidence, case.log_prior(both, scenario)))
    return out


def _any_day(case: Case, chosen: Sets, reduced: dict[str, Reduced]) -> list[Hypothesis]:
    """The hypotheses that leave one of these effects to what any day brings of it, about the size that it has
    today."""
    daily = {u.owner for u in case.effects if u.label in case.nuisance.daily}
    left = [tuple(n for n in chosen if n != name) for name in chosen if name in daily]
    return [h for rest in left for h in _refined(case, rest, reduced)]


def standing(case: Case, found: Found, fresh: Sequence[Unknown] = ()) -> tuple[list[Linear], np.ndarray]:
    """The tracks linearised where a hypothesis was found to stand (columns of its own numbers, or of all
    that are to be `fresh`), and that place (Q,), in prior widths."""
    mine = np.array([i for i, u in enumerate(case.effects) if u.owner in found.hypothesis.effects], dtype=int)
    at = np.zeros(len(case.effects))
    at[mine] = found.posterior.z[mine]
    return about(case, at, mine, fresh or [case.effects[i] for i in mine])[1], at
