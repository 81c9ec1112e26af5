"""The search for what is missing: every effect and every pair in a linear pass, the best few again where they stand.

The linear pass costs milliseconds a hypothesis. The second pass linearises anew about each of the best hypotheses' own values, so
that what is not linear counts in full, and grants an effect that its form is only roughly right: a share DOUBT of its own force may
be something else.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model

from .columns import Unknown, with_values
from .evidence import Hypothesis, Nuisance, Posterior, Reduced, log_evidence, posterior, reduce, weigh_all
from .innovations import Floor, Linear, innovate, linearise
from .respond import respond
from .track import Track

DOUBT = 0.2
MOST_SEGMENTS = 20  # of 16 ship lengths each; a small boat's hour holds more, and an even choice of them says enough
SHORTLIST = 6
SINGLES = 4
FAR = 12.0  # log odds beyond which a hypothesis is not looked at again
VISIBLE = 4.0  # log odds that an effect of plausible size would have to show, or the data could not have seen it
EARNED = 1.5  # log evidence that an effect must add to be looked at again


@dataclass(frozen=True)
class World:
    """One state of the world: factors on the floor's slow acceleration error and on the water's own motion, and its odds."""

    share: float
    flow: float
    probability: float
    unknown: bool = False  # so restless that something must be at work which nobody named


WORLDS: dict[str, World] = {
    "usual": World(1.0, 1.0, 0.85),
    "rough": World(2.0, 1.0, 0.08),
    "streaming": World(1.0, 4.0, 0.04),
    "flooding": World(1.0, 16.0, 0.01),  # only a varying current explains it
    "strange": World(4.0, 1.0, 0.015, unknown=True),
    "stranger": World(8.0, 4.0, 0.005, unknown=True),
}
ODDS = 0.03  # of an effect about which nothing is known
ODDS_WEAK = 0.002  # when it needs a cause that was measured to be too weak to show
ODDS_MEASURED = 0.25  # when its cause was measured to be strong


@dataclass(frozen=True)
class Case:
    """Voyages to be judged, linearised about the ship's model, and everything that is known beforehand."""

    tracks: tuple[Track, ...]
    model: Model
    catalogue: dict[str, type[Effect]]
    candidates: tuple[str, ...]
    unknowns: tuple[Unknown, ...]  # core, then the parameters of the candidates and of all instruments
    effects: tuple[Unknown, ...]  # parameters of the candidates
    nuisance: Nuisance
    floor: Floor
    temper: float
    odds: Mapping[str, float]
    lines: tuple[Linear, ...]

    def reduced(self, lines: Sequence[Linear], floors: Sequence[Floor], at: np.ndarray | None = None) -> list[Reduced]:
        normals = innovate(lines, floors, MOST_SEGMENTS // (1 + len(floors) // 9))
        return [reduce(n, self.nuisance, self.unknowns, self.effects, self.temper, at) for n in normals]

    def worlds(self, names: Sequence[str]) -> list[Floor]:
        return [self.floor.scaled(WORLDS[n].share, flow=WORLDS[n].flow) for n in names]

    def log_prior(self, chosen: Sequence[str], world: str) -> float:
        if world == "flooding" and "VaryingCurrent" not in chosen:
            return -np.inf
        return float(np.log(WORLDS[world].probability) + sum(np.log(self.odds[name]) for name in chosen))


@dataclass(frozen=True)
class Found:
    """A hypothesis with the parameters it would need."""

    hypothesis: Hypothesis
    posterior: Posterior
    model: Model


def settle(case: Case) -> Case:
    """The same case with the fast part of the floor and the readings' scatter as these voyages show them (waves, a worn sensor).

    Judged with every effect allowed, so that no cause is mistaken for noise.
    """
    grid = [(white, sensor) for sensor in (1.0, 3.0) for white in (1.0, 2.0, 4.0, 8.0, 32.0)]
    floors = [replace(case.floor, white=w * case.floor.white, sensor=s * case.floor.sensor) for w, s in grid]
    scores = [posterior(r, case.candidates).log_evidence for r in case.reduced(case.lines, floors)]
    return replace(case, floor=floors[int(np.argmax(scores))])


Searched = tuple[list[Hypothesis], dict[tuple[str, ...], Found], dict[str, bool]]


def search(case: Case, progress: Callable[[str], None] = lambda text: None) -> Searched:
    """All hypotheses with their weights, the best few judged about their own values; what those few found; and whether each
    candidate, had it its plausible size, would have shown."""
    progress("every effect and every pair")
    worlds = dict(zip(WORLDS, case.reduced(case.lines, case.worlds(list(WORLDS))), strict=True))
    seen = {name: visible(worlds["usual"], name) for name in case.candidates}
    weak = [name for name, can in seen.items() if not can and case.catalogue[name].needs]
    case = replace(case, odds=dict(case.odds) | dict.fromkeys(weak, ODDS_WEAK))
    first = _first_pass(case, worlds)
    best = next(h for h in first if not h.effects)
    found: dict[tuple[str, ...], Found] = {(): Found(best, posterior(worlds[best.world], ()), case.model)}
    weighed = {(h.effects, h.world): h for h in first}
    for chosen in _shortlist(first):
        progress("judging " + " + ".join(chosen) + " about its own size")
        likely = next(h.world for h in first if h.effects == chosen)
        refined = _refine(case, chosen, posterior(worlds[likely], chosen))
        for name in WORLDS:
            weighed.pop((chosen, name), None)
        weighed |= {(h.effects, h.world): h for h, _, _ in refined}
        found[chosen] = Found(*max(refined, key=lambda item: item[0].log_weight))
    return sorted(_level(weighed, first, found), key=lambda h: -h.log_weight), found, seen


def visible(reduced: Reduced, name: str) -> bool:
    """Whether this effect, had it its plausible size, would have shown in these voyages."""
    rows = reduced.rows((name,))
    A = reduced.A[np.ix_(rows, rows)]
    return 0.5 * float(np.max(np.diag(A))) - 0.5 * float(np.linalg.slogdet(A + np.eye(rows.size))[1]) > VISIBLE


def _level(
    weighed: Mapping[tuple[tuple[str, ...], str], Hypothesis], first: Sequence[Hypothesis], found: Mapping[tuple[str, ...], Found]
) -> list[Hypothesis]:
    """A pair that was not judged again gains what its member gained when that was: what it adds stays what it was."""
    linear = {(h.effects, h.world): h.log_evidence for h in first}
    gained = {key: h.log_evidence - linear[key] for key, h in weighed.items() if key[0] in found and key in linear}
    out = []
    for (effects, world), h in weighed.items():
        parts = [gained[(name,), world] for name in effects if ((name,), world) in gained]
        if effects not in found and parts:
            h = replace(h, log_evidence=h.log_evidence + max(parts))
        out.append(h)
    return out


def _first_pass(case: Case, worlds: Mapping[str, Reduced]) -> list[Hypothesis]:
    out = []
    for name, reduced in worlds.items():
        for chosen, log_evidence_ in weigh_all(reduced, case.candidates):
            prior = case.log_prior(chosen, name)
            if np.isfinite(prior):
                out.append(Hypothesis(chosen, name, log_evidence_, prior))
    return sorted(out, key=lambda h: -h.log_weight)


def _shortlist(first: Sequence[Hypothesis]) -> list[tuple[str, ...]]:
    """The best few sets that explain something their parts do not, and each member of a pair among them on its own: granted
    doubt, one may do what took two."""
    evidence = {(h.effects, h.world): h.log_evidence for h in first}
    top = first[0].log_weight
    out: dict[tuple[str, ...], None] = {}
    for h in first:
        if top - h.log_weight > FAR or len(out) >= SHORTLIST:
            break
        parts = [tuple(e for e in h.effects if e != name) for name in h.effects]
        if h.effects and all(h.log_evidence > evidence.get((part, h.world), -np.inf) + EARNED for part in parts):
            out[h.effects] = None
    for chosen in list(out):
        out |= dict.fromkeys((name,) for name in chosen)
    if len(first[0].effects) != 1 or first[0].world != "usual":  # no plain answer yet: what is not linear deserves a second look
        singles = [h.effects for h in first if len(h.effects) == 1 and h.log_evidence > evidence.get(((), h.world), -np.inf) + EARNED]
        out |= dict.fromkeys(list(dict.fromkeys(singles))[:SINGLES])
    return list(out)


def _refine(case: Case, chosen: tuple[str, ...], start: Posterior) -> list[tuple[Hypothesis, Posterior, Model]]:
    """Newton steps on the effects' own parameters until they stand, then the evidence in every world."""
    mine = np.array([i for i, u in enumerate(case.effects) if u.owner in chosen])
    names = [n for n in WORLDS if np.isfinite(case.log_prior(chosen, n))]
    z = start.z
    for _ in range(3):
        at = np.zeros_like(z)
        at[mine] = _boxed(case, z)[mine]
        model, lines = _about(case, at, mine)
        reduced = case.reduced(lines, case.worlds(names), at)
        found = [posterior(r, chosen) for r in reduced]
        z = max(found, key=lambda p: p.log_evidence).z
        if np.max(np.abs(_boxed(case, z)[mine] - at[mine])) < 0.25:
            break
    return [
        (Hypothesis(chosen, name, log_evidence(r, chosen, p), case.log_prior(chosen, name)), p, model)
        for name, r, p in zip(names, reduced, found, strict=True)
    ]


def _boxed(case: Case, z: np.ndarray) -> np.ndarray:
    """Parameters kept inside their boxes, in prior widths."""
    lo = np.array([(u.lo - u.centre) / u.sd for u in case.effects])
    hi = np.array([(u.hi - u.centre) / u.sd for u in case.effects])
    return np.clip(z, lo, hi)


def _about(case: Case, z: np.ndarray, mine: np.ndarray) -> tuple[Model, list[Linear]]:
    """The model with these parameters in it, and the tracks linearised about it; other effects' columns stay as they were."""
    own = [case.effects[i] for i in mine]
    values = [u.centre + u.sd * z[i] for i, u in zip(mine, own, strict=True)]
    model = with_values(case.model, own, values, case.catalogue)
    place = {u.label: i for i, u in enumerate(case.unknowns)}
    at = {u.label: v for u, v in zip(own, values, strict=True)}
    lines = []
    for line in case.lines:
        here, _ = model.without_inputs(line.track.missing())
        there = [u for u in own if not line.track.missing().intersection(case.catalogue[u.owner].needs)]
        fresh = linearise(line.track, here, there, case.catalogue, at)
        A, R = line.A.copy(), line.R.copy()
        cols = [place[u.label] for u in there]
        A[:, :, cols], R[:, :, cols] = fresh.A, fresh.R
        doubt = DOUBT * np.abs(respond(line.track, here)[0] - respond(line.track, line.model)[0])
        lines.append(replace(fresh, A=A, R=R, doubt=doubt))
    return model, lines
