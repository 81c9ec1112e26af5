"""A case: voyages to be judged, linearised about the ship's model, and everything that is known
beforehand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import compress

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.study.estimation.columns import Unknown, with_values
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import Linear
from twin.study.reference.directions import directions
from twin.study.reference.evidence import Nuisance, Reduced, posterior, reduce
from twin.study.reference.reading import MOST_SEGMENTS
from twin.study.track.ripple import shaken
from twin.study.track.track import Track


@dataclass(frozen=True)
class Scenario:
    """One noise scenario: factors on the noise model's slow acceleration error (beside all that is usual; or
    `alone`, of the core alone) and on the water's own motion, and its odds."""

    share: float
    flow: float
    probability: float
    alone: bool = False
    unknown: bool = False  # so restless that something must be at work which nobody named

    @property
    def plain(self) -> bool:
        """Whether the model errs no more than it did on the reference voyages."""
        return self.share == 1.0


SCENARIOS: dict[str, Scenario] = {
    "usual": Scenario(1.0, 1.0, 0.75),
    "coarse": Scenario(1.0, 1.0, 0.1, alone=True),
    "rough": Scenario(2.0, 1.0, 0.08, alone=True),
    "streaming": Scenario(1.0, 4.0, 0.04),
    "flooding": Scenario(1.0, 16.0, 0.01),  # only a varying current explains it
    "strange": Scenario(4.0, 1.0, 0.015, alone=True, unknown=True),
    "stranger": Scenario(8.0, 4.0, 0.005, alone=True, unknown=True),
}
UNEVEN = 20.0  # log evidence that a scatter of its own at every moment must add
WAVES = 1.0  # fast part of the noise model, of a standard acceleration, in the worst of weather
ODDS = 0.03  # of an effect about which nothing is known
ODDS_UNNAMED = 0.01  # of what is no member of the catalogue
ODDS_WEAK = 0.002  # when it needs a cause that was measured to be too weak to show
ODDS_WEATHER = 1.0  # of each kind of water and weather on a voyage: as likely there as not
# log odds that an effect of plausible size would have to show, or the data could not have seen it
VISIBLE = 4.0


@dataclass(frozen=True)
class Case:
    """Voyages to be judged, linearised about the ship's model, and everything that is known beforehand."""

    tracks: tuple[Track, ...]
    model: Model  # of the ship file
    linearised: Model  # the same with the core about which the tracks are linearised (`one_step_core`)
    catalogue: dict[str, type[Effect]]
    candidates: tuple[str, ...]
    # the core and what it leaves out (form, sea, rough), the candidates' numbers, what else lasts on this
    # ship, and how late its instruments are (`nuisance.with_effects`)
    unknowns: tuple[Unknown, ...]
    effects: tuple[Unknown, ...]  # parameters of the candidates
    nuisance: Nuisance
    noise_model: NoiseModel  # what is left when all unknowns explain what they can
    path: NoiseModel  # what the model alone leaves, when it is run free
    temper: float
    odds: Mapping[str, float]
    lines: tuple[Linear, ...]  # of what is read of each track
    excited: bool  # whether one of the voyages holds a manoeuvre
    # fast part of the noise model on the reference voyages, before `settle`
    white: tuple[float, float, float]
    scatter: float = 1.0  # of the readings on the reference voyages, before `settle`
    # weather that the reference voyages felt as much, so that it is never the answer
    as_before: tuple[str, ...] = ()
    # what is known by its form alone: part of a hypothesis that is then something unknown
    unnamed: tuple[str, ...] = ()

    @cached_property
    def present(self) -> frozenset[str]:
        """The effects that the model has: of these a change is asked."""
        return frozenset(type(e).__name__ for e in self.model.effects)

    @cached_property
    def weather(self) -> tuple[str, ...]:
        """The candidates that are water or weather of these voyages: a nuisance of every hypothesis, which
        takes no cause's place."""
        return tuple(name for name in self.candidates if self.catalogue[name].is_weather())

    def causes(self, chosen: Sequence[str]) -> tuple[str, ...]:
        """Those of a set of effects that are no weather."""
        return tuple(name for name in chosen if name not in self.weather)

    def day(self, chosen: Sequence[str]) -> tuple[str, ...]:
        """And those that are."""
        return tuple(name for name in chosen if name in self.weather)

    def names(self, chosen: Sequence[str]) -> tuple[str, ...]:
        """The causes that may be the answer."""
        return tuple(name for name in self.causes(chosen) if name not in self.unnamed)

    def ordered(self, chosen: Sequence[str]) -> tuple[str, ...]:
        """A set of effects in the order in which all are kept."""
        return tuple(name for name in self.candidates if name in chosen)

    def reduced(
        self, lines: Sequence[Linear], noise_models: Sequence[NoiseModel], at: np.ndarray | None = None
    ) -> list[Reduced]:
        """For each noise model, what these lines say of the effects alone; `at` (Q,) in prior widths: where
        they were linearised. Of nine noise models and more (`settle`) half of the segments tell."""
        normals = innovate(lines, noise_models, MOST_SEGMENTS // (1 + len(noise_models) // 9))
        return [reduce(n, self.nuisance, self.unknowns, self.effects, self.temper, at) for n in normals]

    def scenarios(self, names: Sequence[str], doubt: float = 0.0) -> list[NoiseModel]:
        """The noise models of these scenarios, where the effects' forms are known this roughly."""
        noise_models = (
            (self.path if w.alone else self.noise_model).scaled(w.share, flow=w.flow)
            for w in map(SCENARIOS.__getitem__, names)
        )
        return [replace(noise_model, doubt=doubt) for noise_model in noise_models]

    def at(self, mine: Sequence[int] | np.ndarray, z: np.ndarray, track: Track) -> Model:
        """The model on this voyage with the effects' numbers `mine` (M,) at z (Q,), in prior widths."""
        own = [(u, u.centre + u.sd * z[i]) for i in mine if (u := self.effects[i]).acts_on(track)]
        return with_values(self.model, [u for u, _ in own], [value for _, value in own], self.catalogue)

    @cached_property
    def information(self) -> np.ndarray:
        """(P, P) what these voyages tell of all unknowns, where they were linearised. Per unit of each
        unknown: A, in their own units."""
        return innovate(self.lines, self.scenarios(["usual"]), MOST_SEGMENTS)[0].total()[0]

    def along(self, lines: Sequence[Linear], chosen: Sequence[str] = ()) -> tuple["Case", np.ndarray]:
        """The same with these lines and few columns: the directions in the place of the nuisance's own,
        and the numbers of all effects, or of those that are `chosen` or that any day brings (others have a
        hundredth of a prior width each, which steers nothing); and which of `effects` are left, a mask
        (Q,)."""
        kept = np.array(
            [not chosen or u.owner in chosen or u.label in self.nuisance.daily for u in self.effects]
        )
        effects, column = (
            tuple(compress(self.effects, kept)),
            {u.label: i for i, u in enumerate(self.unknowns)},
        )
        others = [column[u.label] for u in effects]
        along = directions(self.information, self.nuisance, self.unknowns, self.temper, chosen)
        few = tuple(along.line(x, others) for x in lines)
        return replace(
            self,
            unknowns=(*along.nuisance.unknowns, *effects),
            effects=effects,
            lines=few,
            nuisance=along.nuisance,
        ), kept

    def weakened(self, seen: Mapping[str, bool]) -> "Case":
        """The same with little odds for what needs a measured cause and would not have shown (`seen`) with
        its plausible size."""
        weak = [name for name, shows in seen.items() if not shows and self.catalogue[name].needs]
        return replace(self, odds=dict(self.odds) | dict.fromkeys(weak, ODDS_WEAK))

    def log_prior(self, chosen: Sequence[str], scenario: str) -> float:
        """Log prior probability of a set of effects in a noise scenario; minus infinity for one that
        cannot be."""
        changing = any(self.catalogue[name].is_weather() and self.catalogue[name].holds for name in chosen)
        if (scenario == "flooding" and not changing) or self._twice(chosen):
            return -np.inf
        return float(
            np.log(SCENARIOS[scenario].probability) + sum(np.log(self.odds[name]) for name in chosen)
        )

    def _twice(self, chosen: Sequence[str]) -> bool:
        """Whether one of these effects is a part of another: together they say no more than that one."""
        return any(part in chosen for name in chosen for part in self.catalogue[name].holds)


def visible(reduced: Reduced, name: str) -> bool:
    """Whether this effect, had it its plausible size, would have shown in these voyages."""
    rows = reduced.rows((name,))
    A = reduced.A[np.ix_(rows, rows)]
    return (
        0.5 * float(np.max(np.diag(A))) - 0.5 * float(np.linalg.slogdet(A + np.eye(rows.size))[1]) > VISIBLE
    )


# of the fast part at least, in surge, sway and yaw, of a standard acceleration
Levels = tuple[float, float, float]


def settle(case: Case) -> Case:
    """The same case with the fast part of the noise model and the readings' scatter as these voyages show
    them (waves, a worn sensor).

    Judged with every effect allowed, so that no cause is mistaken for noise.
    """
    white, time = case.noise_model.white, float(case.model.ship.scale("time"))
    steps = [float(x) for x in np.geomspace(min(white), max(WAVES, 4.0 * max(white)), 5)]
    grid: list[tuple[Levels, float]] = [((x, x, x), sensor) for sensor in (1.0, 3.0) for x in steps]
    unlike = tuple(uneven(x, time) for x in case.lines)

    def scores(lines: Sequence[Linear], tried: Sequence[tuple[Levels, float]] = grid) -> list[float]:
        noise_models = [_rougher(case.noise_model, *factors) for factors in tried]
        return [posterior(r, case.candidates).log_evidence for r in case.reduced(lines, noise_models)]

    lines, told = case.lines, scores(case.lines)
    if any(x.track.ripple is not None for x in unlike) and max(shaky := scores(unlike)) > max(told) + UNEVEN:
        lines, told = unlike, shaky
    levels, sensor = grid[int(np.argmax(told))]
    for axis in range(3):  # what pushes the ship in one of them need not do so in the others
        lower = [_with(levels, axis, x) for x in steps if x < levels[axis] > white[axis]]
        if lower:
            tried = [(t, sensor) for t in (levels, *lower)]
            levels = tried[int(np.argmax(scores(lines, tried)))][0]
    return replace(
        case,
        lines=lines,
        noise_model=_rougher(case.noise_model, levels, sensor),
        path=_rougher(case.path, levels, sensor),
    )


def _with(levels: Levels, axis: int, level: float) -> Levels:
    surge, sway, yaw = (level if i == axis else x for i, x in enumerate(levels))
    return surge, sway, yaw


def uneven(line: Linear, time: float) -> Linear:
    """The same voyage read with a scatter of its own at every moment. `time`: L/U_0 [s]."""
    shown = shaken(line.shown, time)
    return replace(line, shown=shown, track=replace(line.track, ripple=shown.ripple))


def _rougher(noise_model: NoiseModel, levels: Levels, sensor: float) -> NoiseModel:
    """The noise model with a fast part of at least these, and so many times the readings' scatter."""
    surge, sway, yaw = (max(level, w) for level, w in zip(levels, noise_model.white, strict=True))
    return replace(noise_model, white=(surge, sway, yaw), sensor=sensor * noise_model.sensor)
