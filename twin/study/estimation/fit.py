"""Fit unknown numbers to tracks: Gauss-Newton on the filter's innovations, with priors, inside boxes.

Each unknown is z = (value - centre)/sd, so that its prior is N(0, 1) whatever its unit. Evidence is tempered
by `temper`: what a model leaves over is not white, and a likelihood taken at face value believes itself too
much."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.study.estimation.box import INSIDE, within
from twin.study.estimation.columns import LATE, Unknown, with_values
from twin.study.estimation.dissipation import (
    HalfSpaces,
    half_spaces,
    where_it_dissipates,
    where_resistance_grows,
)
from twin.study.estimation.innovations import NoiseModel, Normal, innovate
from twin.study.estimation.linear import Linear, linearise
from twin.study.track.track import Track

Catalogue = dict[str, type[Effect]]
STEPS = 12
NEAR = 1.0  # prior widths that no number may move by in the first step
# shares of the gain that a step promised: below it went too far, above the next may go further
POOR, GOOD = 0.1, 0.5
LEVEL = 0.5  # by which a step may seem worse: the filter is linearised anew
STANDS = 0.02  # prior widths that a step may still move
NOTHING = 0.1  # of the cost, that a step may still gain


@dataclass(frozen=True)
class Fit:
    """What a fit found: `model` holds the values; `value`, `sd` (P,) in the unknowns' units; `gained` (P,): 1
    - posterior/prior variance."""

    model: Model
    unknowns: tuple[Unknown, ...]
    value: np.ndarray
    covariance: np.ndarray
    lines: tuple[Linear, ...]
    normal: Normal
    cost: float  # -2 log probability, but for a constant

    @property
    def sd(self) -> np.ndarray:
        """(P,) standard deviation of each number, in its own unit."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def late(self) -> dict[str, float]:
        """How late each instrument was found [s]: no model holds it."""
        told = zip(self.unknowns, self.value.tolist(), strict=True)
        return {u.label: value for u, value in told if u.owner == LATE}

    @property
    def gained(self) -> np.ndarray:
        """(P,) share of each number's prior variance that the data took away."""
        prior = np.array([u.sd for u in self.unknowns])
        return 1.0 - (self.sd / prior) ** 2


def fit(
    tracks: Sequence[Track],
    model: Model,
    unknowns: Sequence[Unknown],
    catalogue: Catalogue,
    noise_model: NoiseModel,
    *,
    temper: float = 1.0,
    smooth: bool = False,
    begun: Fit | None = None,
) -> Fit:
    """The most probable values of the unknowns, given the tracks and their priors, after at most STEPS steps.

    Each goes to where the equations at the last place are most probable, inside the boxes, where the hull
    takes energy out of every motion (dissipation.py), and no further than they were found to hold: a step
    that kept its promise lets the next one go twice as far, one that did not is not taken but made shorter
    (trust region; Nocedal & Wright 2006, sec. 4.1), so that a fit of many numbers that is begun far off does
    not end in a corner of their boxes; the last one is not judged. Only a fit that ends where resistance
    falls with speed is begun again, at the nearest place where it grows: a wall on the way led it elsewhere.
    `smooth`: faults of instruments are judged along the smooth motion alone, as long as the core that the
    filter follows is not found yet, and errs by more than they do. `begun`: an earlier fit; what no model
    holds (how late an instrument is) begins as it has it."""
    problem = _Problem(tracks, model, tuple(unknowns), catalogue, noise_model, temper, smooth)
    here, z = replace(problem, grows=False).best(problem.start(begun))
    if not problem.resistance_grows(z):
        del here  # its columns are large
        here, z = problem.best(problem.nearest(z))
    covariance = here.covariance * np.outer(problem.sd, problem.sd)
    return Fit(
        problem.with_values(z),
        problem.unknowns,
        problem.values(z),
        covariance,
        here.lines,
        here.normal,
        here.cost,
    )


@dataclass(frozen=True)
class _Here:
    """The equations at one place, in prior widths."""

    z: np.ndarray
    lines: tuple[Linear, ...]
    normal: Normal
    H: np.ndarray
    pull: np.ndarray
    temper: float

    @cached_property
    def covariance(self) -> np.ndarray:
        return np.linalg.inv(self.H)

    @cached_property
    def cost(self) -> float:
        return _cost(self.z, self.normal, self.temper)

    def promised(self, z: np.ndarray) -> float:
        """By how much more probable that place should be, in cost."""
        step = z - self.z
        return float(2.0 * self.pull @ step - step @ self.H @ step)

    def as_good_as(self, z: np.ndarray) -> bool:
        """Whether nothing is left to be gained by going there."""
        return self.promised(z) < NOTHING or float(np.max(np.abs(z - self.z))) < STANDS


def _cost(z: np.ndarray, normal: Normal, temper: float) -> float:
    return float((normal.ee + normal.logdet).sum()) / temper + float(z @ z)


@dataclass(frozen=True)
class _Problem:
    """What is fitted to what."""

    tracks: Sequence[Track]
    model: Model
    unknowns: tuple[Unknown, ...]
    catalogue: Catalogue
    noise_model: NoiseModel
    temper: float
    smooth: bool
    grows: bool = True  # whether resistance must grow with speed

    @cached_property
    def centre(self) -> np.ndarray:
        return np.array([u.centre for u in self.unknowns])

    @cached_property
    def sd(self) -> np.ndarray:
        return np.array([u.sd for u in self.unknowns])

    @cached_property
    def box(self) -> np.ndarray:
        """(2, P)"""
        return (
            np.array([[u.lo for u in self.unknowns], [u.hi for u in self.unknowns]]) - self.centre
        ) / self.sd

    @cached_property
    def hull(self) -> HalfSpaces:
        """Where the damping takes energy out of every motion."""
        held = half_spaces if self.grows else where_it_dissipates
        return held(self.model.ship, self.unknowns)

    def start(self, begun: Fit | None) -> np.ndarray:
        late = begun.late if begun else {}
        now = [late.get(u.label, present(self.model, u)) for u in self.unknowns]
        return self.nearest((np.array(now) - self.centre) / self.sd)

    def nearest(self, z: np.ndarray) -> np.ndarray:
        """The nearest place inside, in widths of priors."""
        return within(z, np.eye(z.size), self.box, self.hull)

    def resistance_grows(self, z: np.ndarray) -> bool:
        """Whether it does with speed there."""
        rows, least = where_resistance_grows(self.model.ship, self.unknowns)
        return bool(np.all(rows @ z >= least - INSIDE))

    def best(self, z: np.ndarray) -> tuple[_Here, np.ndarray]:
        """The last place at which the equations were made, begun at z, and the most probable one by them."""
        here, far = self.at(z), NEAR
        for _ in range(STEPS):
            z, far = self.better(here, far)
            if here.as_good_as(z):
                break
            here = self.at(z)
        return here, z

    def values(self, z: np.ndarray) -> np.ndarray:
        return np.clip(
            self.centre + self.sd * z, [u.lo for u in self.unknowns], [u.hi for u in self.unknowns]
        )

    def at(self, z: np.ndarray) -> _Here:
        """Linearised there, with what every unknown does."""
        lines = self._linearised(z, self.unknowns, exact=True)
        normal = innovate(lines, [self.noise_model])[0]
        A, b, _ = normal.total()
        lines = tuple(replace(line, bends=None) for line in lines)  # large, and needed no more
        H = A / self.temper * np.outer(self.sd, self.sd) + np.eye(z.size)
        return _Here(z, lines, normal, H, b / self.temper * self.sd - z, self.temper)

    def better(self, here: _Here, far: float) -> tuple[np.ndarray, float]:
        """A more probable place (or one that is as good as here), and how far the step after it may go."""
        while True:
            z = within(
                here.z + here.covariance @ here.pull,
                here.covariance,
                np.clip(self.box, here.z - far, here.z + far),
                self.hull,
            )
            if here.as_good_as(z):
                return z, far
            promised, gain = here.promised(z), here.cost - self._cost(z)
            if gain >= POOR * promised - LEVEL:
                return z, 2.0 * far if gain >= GOOD * promised else far
            far *= 0.25

    def with_values(self, z: np.ndarray) -> Model:
        return with_values(self.model, self.unknowns, self.values(z).tolist(), self.catalogue)

    def _cost(self, z: np.ndarray) -> float:
        lines = self._linearised(z, [u for u in self.unknowns if u.owner == LATE])
        try:
            normal = innovate(lines, [self.noise_model])[0]
        except np.linalg.LinAlgError:  # a model that runs away between two readings: a step too far
            return np.inf
        return _cost(z, normal, self.temper)

    def _linearised(
        self, z: np.ndarray, unknowns: Sequence[Unknown], exact: bool = False
    ) -> tuple[Linear, ...]:
        model = self.with_values(z)
        value = dict(zip((u.label for u in self.unknowns), self.values(z).tolist(), strict=True))
        about = [replace(u, centre=value[u.label]) if u.owner == "core" else u for u in unknowns]
        return tuple(
            linearise(t, model, about, self.catalogue, value, smooth=self.smooth, exact=exact)
            for t in self.tracks
        )


def present(model: Model, unknown: Unknown) -> float:
    """The unknown's value in the model as it stands; its centre where the effect is not there."""
    if unknown.owner == "core":
        return float(model.ship.derivative(unknown.name))
    for effect in model.effects:
        if type(effect).__name__ == unknown.owner:
            return float(getattr(effect, unknown.name))
    return unknown.centre


def evidence(normal: Normal, sd: np.ndarray) -> float:
    """Log probability of the innovations with the unknowns integrated out over N(0, sd^2). `sd` (P,): in the
    unknowns' own units."""
    A, b, ee = normal.total()
    A, b = A * np.outer(sd, sd), b * sd
    L = np.linalg.cholesky(A + np.eye(sd.size))
    half = np.linalg.solve(L, b)
    return -0.5 * (ee - float(half @ half) + float(normal.logdet.sum())) - float(np.log(np.diag(L)).sum())
