"""What the league asks: one question a voyage, in rounds of one seed each, so that a part of a run is a fair
sample."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bench.reference import SeaCase
from bench.reference.hidden_catalogue import CATALOGUE, OUTSIDE

HULLS = ("kvlcc2", "usv", "container")
KINDS = ("effect", "none", "decoy", "pair", "outside", "straight")
STRENGTHS = (1.0, 0.5)
MANOEUVRES = ("mixed", "zigzag_20", "course_changes", "speed_changes")
DURATION_S = {"usv": 1200.0}  # 900 lengths of a 2 m boat; the others sail half an hour
HALF_HOUR = 1800.0
STRAIGHT = ("Wind", "HullFouling", "RudderOffset", "SpeedLogBias", "Current", "TowForce")
WEATHERS = {"Wind": "wind", "WaveDrift": "waves"}
QUICK = (
    "Wind",
    "Current",
    "HullFouling",
    "PropellerWear",
    "RudderWear",
    "SteeringLag",
    "SpeedLogBias",
    "SensorDelay",
)


@dataclass(frozen=True)
class Question:
    """One voyage to judge. `known`: effects that the ship's model already has, fitted on windy or wavy
    voyages."""

    hull: str
    kind: str  # effect, none, decoy, pair, outside, straight
    hidden: tuple[tuple[str, float], ...]
    manoeuvre: str
    seed: int
    decoys: tuple[str, ...] = ()
    known: tuple[str, ...] = ()
    duration_s: float = HALF_HOUR

    @property
    def key(self) -> str:
        """A name that no other question has."""
        what = [f"{n}:{s:g}" for n, s in self.hidden] + list(self.decoys) or ["nothing"]
        known = [f"knows-{n}" for n in self.known]
        return "_".join(
            [self.hull, self.kind, *what, *known, self.manoeuvre, f"{self.duration_s:g}s", str(self.seed)]
        )

    @property
    def missing(self) -> tuple[str, ...]:
        """The effects that a perfect answer names."""
        inside = tuple(n for n, _ in self.hidden if n in CATALOGUE and n not in self.known)
        return inside if self.kind != "outside" else ()

    @property
    def proves(self) -> bool:
        """Whether a fall of the held-out error can be asked for."""
        return bool(self.missing) and self.kind in ("effect", "pair")

    def voyages(self) -> list[SeaCase]:
        return [self.case(), self.held_out()] if self.proves else [self.case()]

    def case(self) -> SeaCase:
        return SeaCase(
            self.hull, self.manoeuvre, "calm", self.hidden, self.decoys, self.seed, self.duration_s
        )

    def held_out(self) -> SeaCase:
        """The same ship with the same hidden effect in another manoeuvre."""
        other = MANOEUVRES[(MANOEUVRES.index(self.manoeuvre) + 1) % len(MANOEUVRES)]
        return SeaCase(self.hull, other, "calm", self.hidden, self.decoys, self.seed, self.duration_s)


def lasts(hull: str, duration_s: float | None) -> float:
    """How long a voyage of this hull is [s]."""
    return duration_s or DURATION_S.get(hull, HALF_HOUR)


def questions(
    hulls: Sequence[str],
    seeds: int,
    strengths: Sequence[float],
    effects: Sequence[str] = (),
    quick: bool = False,
    duration_s: float | None = None,
    every: int = 1,
    first_seed: int = 1,
) -> list[list[Question]]:
    """A round of questions for each of `seeds` seeds; of all of them one in `every`, in turn over questions,
    hulls and seeds."""
    return [
        [
            Question(h, *rest, duration_s=lasts(h, duration_s))
            for i, rest in _shuffled(list(enumerate(_round(seed, strengths, effects, quick))), seed)
            for j, h in enumerate(hulls)
            if (i + j + seed) % every == 0
        ]
        for seed in range(first_seed, first_seed + seeds)
    ]


def _round(seed: int, strengths: Sequence[float], effects: Sequence[str], quick: bool) -> list[tuple]:
    """(kind, hidden, manoeuvre, seed, decoys, known) of one seed; the manoeuvres go round from effect to
    effect."""
    chosen = list(effects) or list(QUICK if quick else CATALOGUE)

    def sails(i: int) -> str:
        return MANOEUVRES[(i + seed) % len(MANOEUVRES)]

    out: list[tuple] = [
        ("effect", ((name, s),), sails(i + j), seed, (), ())
        for j, s in enumerate(strengths)
        for i, name in enumerate(chosen)
    ]
    none = [("none", (), m, seed + 50 * k, (), ()) for k, m in enumerate(MANOEUVRES[: 1 if quick else 4])]
    out += none if quick else [*none, ("none", (), sails(0), seed + 250, (), ())]
    decoys = ("wind_no_force", "waves_no_force")[: 1 if quick else 2]
    out += [("decoy", (), sails(i), seed, (name,), ()) for i, name in enumerate(decoys)]
    if not quick:
        out += [("decoy", ((n, 1.0),), sails(i + 2), seed, (), (n,)) for i, n in enumerate(WEATHERS)]
        out += [("straight", ((n, 1.0),), "straight", seed, (), ()) for n in STRAIGHT[seed % 3 :: 3]]
    outside = list(OUTSIDE)[: 1 if quick else None]
    out += [("outside", ((n, 1.0),), sails(i), seed, (), ()) for i, n in enumerate(outside)]
    return out + [("pair", p, sails(i), seed, (), ()) for i, p in enumerate(pairs(seed, 1 if quick else 5))]


def pairs(seed: int, count: int) -> list[tuple[tuple[str, float], ...]]:
    """A fixed random list of two effects at once, both strong."""
    rng, names = np.random.default_rng([seed, 77]), list(CATALOGUE)
    return [tuple((names[i], 1.0) for i in rng.choice(len(names), 2, replace=False)) for _ in range(count)]


def _shuffled(items: list[Any], seed: int) -> list[Any]:
    """In a fixed random order: whatever part of it is run is a sample of the whole."""
    return [items[i] for i in np.random.default_rng([seed, 78]).permutation(len(items))]
