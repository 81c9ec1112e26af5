"""Which effects explain what the model cannot: the probability of every hypothesis, all judged jointly.

A hypothesis is a set of effects (up to three causes, beside any weather) and a noise scenario (how large
the model's error, how restless the water). Its evidence integrates out everything else: the core's
derivatives and the instruments' usual errors as the reference voyages left them, and a small amount of every
effect (a spike far narrower than its plausible size, or as wide as what any day brings of it), so that only
what is clearly more than nothing counts. The parameters of its own effects are integrated over their priors
(half-normal in a box with one side), so that a flexible effect pays for its freedom.

Source: MacKay (2003) Information theory, inference, and learning algorithms, ch. 28; George & McCulloch
    (1993), spike and slab.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from twin.study.estimation.box import stopped
from twin.study.estimation.columns import Unknown
from twin.study.estimation.innovations import Normal
from twin.study.reference.inside_box import log_shares_inside
from twin.study.reference.slabs import slabs_for

WIDENED = 20  # steps in which a slab finds its width
SPIKE = 0.01  # width of "not there", in widths of "there"


@dataclass(frozen=True)
class Hypothesis:
    """A set of effects in one noise scenario, and what the data says of it."""

    effects: tuple[str, ...]
    scenario: str
    log_evidence: float
    log_prior: float

    @property
    def log_weight(self) -> float:
        """Log of evidence times prior."""
        return self.log_evidence + self.log_prior


@dataclass(frozen=True)
class Nuisance:
    """What the reference voyages (or the ship file) say of core and instruments, in prior widths: information
    and its pull; and how much of an effect any day brings (`daily`: label -> standard deviation in the
    number's own unit), which is less than "there"."""

    unknowns: tuple[Unknown, ...]
    information: np.ndarray  # (C, C)
    pull: np.ndarray  # (C,)
    daily: Mapping[str, float] = field(default_factory=dict)

    def beside(self, others: Sequence[Unknown]) -> "Nuisance":
        """The same with others beside, of which nothing but their priors is known."""
        size = len(self.unknowns)
        information = np.eye(size + len(others))
        information[:size, :size] = self.information
        return replace(
            self,
            unknowns=(*self.unknowns, *others),
            information=information,
            pull=np.pad(self.pull, (0, len(others))),
        )

    @cached_property
    def log_norm(self) -> float:
        """By which the log of its density stays one of probability, in whatever unknowns it is written."""
        return 0.5 * float(np.linalg.slogdet(self.information)[1]) - 0.5 * float(
            self.pull @ np.linalg.solve(self.information, self.pull)
        )


@dataclass(frozen=True)
class Reduced:
    """Tempered normal equations in prior widths with the nuisance integrated out: what is left concerns the
    effects."""

    A: np.ndarray  # (Q, Q)
    b: np.ndarray  # (Q,)
    base: float  # log evidence without any effect, not even a spike
    unknowns: tuple[Unknown, ...]
    at: np.ndarray  # (Q,) where the equations were linearised, in prior widths from "not there"
    spike: np.ndarray | float = SPIKE  # (Q,) widths of "not there"

    def rows(self, effects: Sequence[str]) -> np.ndarray:
        """(K,) index of the parameters of these effects."""
        return np.array([i for i, u in enumerate(self.unknowns) if u.owner in effects], dtype=int)

    @cached_property
    def box(self) -> np.ndarray:
        """(2, Q) the boxes, in prior widths from "not there"."""
        return np.array(
            [[(u.lo - u.centre) / u.sd, (u.hi - u.centre) / u.sd] for u in self.unknowns]
        ).T.reshape(2, -1)


def reduce(
    normal: Normal,
    nuisance: Nuisance,
    all_unknowns: Sequence[Unknown],
    effects: Sequence[Unknown],
    temper: float,
    at: np.ndarray | None = None,
) -> Reduced:
    """Integrate the nuisance out of normal equations whose columns are `all_unknowns` (an instrument's
    usual error and its fault share a column). `at` (Q,): see `Reduced`."""
    A, b, ee = normal.total()
    place = {u.label: i for i, u in enumerate(all_unknowns)}
    order = (*nuisance.unknowns, *effects)
    pick, sd, C = [place[u.label] for u in order], np.array([u.sd for u in order]), len(nuisance.unknowns)
    A, b = A[np.ix_(pick, pick)] * np.outer(sd, sd) / temper, b[pick] * sd / temper
    L = np.linalg.cholesky(A[:C, :C] + nuisance.information)
    half = np.linalg.solve(L, np.column_stack([A[:C, C:], b[:C] + nuisance.pull]))
    cross, mean = half[:, :-1], half[:, -1]
    base = (
        -0.5 * (ee + float(normal.logdet.sum())) / temper
        + 0.5 * float(mean @ mean)
        - float(np.log(np.diag(L)).sum())
        + nuisance.log_norm
    )
    spike = np.array([np.clip(nuisance.daily.get(u.label, 0.0) / u.sd, SPIKE, 1.0) for u in effects])
    return Reduced(
        A[C:, C:] - cross.T @ cross,
        b[C:] - cross.T @ mean,
        base,
        tuple(effects),
        np.zeros(len(effects)) if at is None else at,
        spike,
    )


def given(reduced: Reduced, z: np.ndarray, known: np.ndarray) -> Reduced:
    """What is left to be asked once some of the parameters (`known`: which) have the values z. Both (Q,)."""
    rest = ~known
    b = reduced.b - reduced.A[:, known] @ (z - reduced.at)[known]
    unknowns = tuple(u for u, is_left in zip(reduced.unknowns, rest, strict=True) if is_left)
    spike = np.broadcast_to(reduced.spike, known.shape)[rest]
    return Reduced(reduced.A[np.ix_(rest, rest)], b[rest], reduced.base, unknowns, reduced.at[rest], spike)


@dataclass(frozen=True)
class Posterior:
    """Parameters of all effects in prior widths from "not there", under one hypothesis."""

    z: np.ndarray  # (Q,)
    covariance: np.ndarray  # (Q, Q)
    log_evidence: float  # without the boxes


def posterior(reduced: Reduced, effects: Sequence[str], slab: np.ndarray | float = 1.0) -> Posterior:
    """The effects' parameters when these effects are there and the others are not; `slab` (M,): how wide
    their own parameters may be, in units of their priors."""
    width = np.broadcast_to(reduced.spike, len(reduced.unknowns)).astype(float)
    width[reduced.rows(effects)] = slab
    K = reduced.A * np.outer(width, width)
    K[np.diag_indices_from(K)] += 1.0
    L = np.linalg.cholesky(K)
    pull = width * reduced.b - reduced.at / width
    half = np.linalg.solve(L, pull)
    gain = (
        0.5 * float(half @ half)
        - 0.5 * float(np.sum((reduced.at / width) ** 2))
        - float(np.log(np.diag(L)).sum())
    )
    inverse = np.linalg.inv(K)
    return Posterior(
        reduced.at + width * (inverse @ pull), inverse * np.outer(width, width), reduced.base + gain
    )


def sized(reduced: Reduced, effects: Sequence[str]) -> Posterior:
    """The same with slabs as wide as the numbers ask, and no narrower than their priors (type II maximum
    likelihood; MacKay 1992): a size far beyond what is usual is not drawn back to what is usual."""
    rows, out = reduced.rows(effects), posterior(reduced, effects)
    for _ in range(WIDENED):
        asked = out.z[rows] ** 2 + np.diag(out.covariance)[rows]
        out = posterior(reduced, effects, np.sqrt(np.maximum(asked, 1.0)))
    return out


def likeliest(
    normal: Normal,
    nuisance: Nuisance,
    all_unknowns: Sequence[Unknown],
    effects: Sequence[Unknown],
    temper: float,
    at: np.ndarray,
    chosen: Sequence[str],
) -> np.ndarray:
    """(P,) how far each of `all_unknowns` most probably is from where the equations were linearised [its own
    unit], when the `chosen` effects are
    there: what the effects leave to core and instruments, and the effects' own share."""
    A, b, _ = normal.total()
    place = {u.label: i for i, u in enumerate(all_unknowns)}
    usual, own = ([place[u.label] for u in some] for some in (nuisance.unknowns, effects))
    sd, moved = np.array([u.sd for u in nuisance.unknowns]), np.array([u.sd for u in effects])
    moved = moved * (posterior(reduce(normal, nuisance, all_unknowns, effects, temper, at), chosen).z - at)
    pull = sd * (b[usual] - A[np.ix_(usual, own)] @ moved) / temper + nuisance.pull
    theta = np.zeros(len(all_unknowns))
    theta[own] = moved  # an instrument's fault and its usual error share a column
    theta[usual] += sd * np.linalg.solve(
        A[np.ix_(usual, usual)] * np.outer(sd, sd) / temper + nuisance.information, pull
    )
    return theta


def boxed(reduced: Reduced, effects: Sequence[str], found: Posterior) -> Posterior:
    """The same with its most probable place inside the boxes of these effects."""
    rows, z = reduced.rows(effects), found.z.copy()
    z[rows], held = stopped(z[rows], found.covariance[np.ix_(rows, rows)], *reduced.box[:, rows])
    if held.size:
        edge, there = rows[held], z[rows[held]]
        z = found.z + found.covariance[:, edge] @ np.linalg.solve(
            found.covariance[np.ix_(edge, edge)], there - found.z[edge]
        )
        z[edge] = there  # to the last digit: what stands at nothing is nothing
    return replace(found, z=z)


def log_evidence(reduced: Reduced, effects: Sequence[str], found: Posterior) -> float:
    """Log evidence of a set of effects: what they explain, less what their freedom costs, inside their
    boxes."""
    rows = reduced.rows(effects)
    (inside,) = log_shares_inside(
        found.z[None, rows], found.covariance[np.ix_(rows, rows)][None], *reduced.box[:, None, rows]
    )
    return found.log_evidence + float(inside)


def weigh_sets(reduced: Reduced, sets: Sequence[tuple[str, ...]]) -> list[tuple[tuple[str, ...], float]]:
    """Log evidence of each of these sets: from the one in which every effect is a spike, low-rank steps
    away."""
    spikes = posterior(reduced, ())
    return [((), spikes.log_evidence), *_opened(reduced, spikes, (), [chosen for chosen in sets if chosen])]


def weigh_with(reduced: Reduced, held: Sequence[str], candidates: Sequence[str]) -> list[tuple[str, float]]:
    """Log evidence of the set `held` with each of the candidates beside it."""
    found = posterior(reduced, held)
    return [
        (chosen[0], e)
        for chosen, e in _opened(reduced, found, held, [(n,) for n in candidates if n not in held])
    ]


def _opened(
    reduced: Reduced, start: Posterior, held: Sequence[str], sets: Sequence[tuple[str, ...]]
) -> list[tuple[tuple[str, ...], float]]:
    """Log evidence when the spikes of each of `sets` become slabs beside those of `held` (`start`: the
    posterior under `held`)."""
    rows = {name: reduced.rows((name,)) for name in {n for chosen in sets for n in chosen}}
    own, lo, hi = reduced.rows(held), *reduced.box
    spike = np.broadcast_to(reduced.spike, len(reduced.unknowns))
    at = [np.concatenate([rows[name] for name in chosen]) for chosen in sets]
    out = np.zeros(len(sets))
    for size in {x.size for x in at}:
        alike = np.array([i for i, x in enumerate(at) if x.size == size])
        slabs = slabs_for(start.z, start.covariance, spike, np.stack([at[i] for i in alike]), own)
        inside = log_shares_inside(slabs.mean, slabs.covariance, lo[slabs.rows], hi[slabs.rows])
        out[alike] = start.log_evidence + slabs.change + inside
    return list(zip(sets, out.tolist(), strict=True))


def probabilities(weighed: Sequence[Hypothesis]) -> np.ndarray:
    """(H,) posterior probability of each hypothesis."""
    w = np.array([h.log_weight for h in weighed])
    w = np.exp(w - w.max())
    return w / w.sum()
