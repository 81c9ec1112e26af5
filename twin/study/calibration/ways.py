"""The ways in which a ship is fitted to its voyages, and which of them predicts what was not used best."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from twin.physics.effects import of_role, of_ship
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.progress import Progress
from twin.study.calibration.held_out import HeldOut, HeldOutErrors, errors, size
from twin.study.calibration.rollout import rolled_out
from twin.study.estimation.columns import Unknown
from twin.study.reference.derivatives import with_core_of
from twin.study.track.track import Track

# one step ahead through a filter, or several lengths ahead without (rollout.py)
FITTED_BY = ("steps", "paths")
SPARED = 0.05  # share by which a less simple way must be better: a diagnosis judges by steps
COMPASS = of_role("compass")


class FittedShip(NamedTuple):
    """The ship as one way fitted it, and as steps did, from where that way began; and how far off its
    predictions of what was not used are."""

    way: str
    ship: Ship
    by_steps: Ship
    off: HeldOutErrors

    @property
    def measure(self) -> float:
        """What the best has least of: log error, and what a less simple way or ship must be better by."""
        return size(self.off.by_horizon) + SPARED * ((self.way != "steps") + deviates(self.ship))


def deviates(ship: Ship) -> bool:
    """Whether its compass has a deviation curve in its file."""
    return any(isinstance(e, COMPASS) for e in ship.effects)


def best_way(
    steps: Ship,
    tracks: Sequence[Track],
    excited: Sequence[Unknown],
    held_out: HeldOut,
    *,
    by: str | None,
    found_curve: bool,
    progress: Progress,
    like: FittedShip | None = None,
) -> FittedShip:
    """The best of the ships to choose from: fitted by steps, or from there along the path; and, where the
    compass's deviation was found beside the core, without it, for the next voyage may not have it. `like`:
    the one that was chosen before all that was held out was fitted too, whose way and curve stay."""
    begun = [steps, *([_without_curve(steps)] if found_curve else [])]
    if like:
        by, begun = like.way, [s for s in begun if deviates(s) == deviates(like.ship)]
    ships = [("steps", s, s) for s in begun] if by != "paths" or not excited else []
    if by != "steps" and excited:
        progress("fitting along the path")
        known = of_ship(steps)
        ships += [
            ("paths", with_core_of(s, rolled_out(tracks, Model.of(s), excited, known).ship), s) for s in begun
        ]
    every = [FittedShip(way, s, first, errors(Model.of(s), held_out)) for way, s, first in ships]
    return min(every, key=lambda one: one.measure)


def _without_curve(ship: Ship) -> Ship:
    """The ship whose file neither has the curve nor says that it was found."""
    name, structural = COMPASS.__name__, ship.notes["structural"]
    effects = {k: v for k, v in ship.notes.get("effects", {}).items() if k != name}
    beside = [k for k in structural["beside_effects"] if k != name]
    notes = {**ship.notes, "effects": effects, "structural": structural | {"beside_effects": beside}}
    return replace(ship.without_effects(name), notes=notes)
