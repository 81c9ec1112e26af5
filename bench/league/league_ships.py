"""The ships of the league: a bundled file, calibrated in memory on calm voyages; and the same with wind or
waves in its model."""

import pickle
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench.league.league_voyages import kept
from bench.league.plan import WEATHERS, lasts
from bench.reference import SeaCase
from twin.physics.effects import find
from twin.physics.ship import Ship, load
from twin.study.calibration.core_fit import calibrate
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track
from twin.study.update.adding import fitted

MANOEUVRES = ("zigzag_20", "speed_changes", "turning_circle", "course_changes", "zigzag_10", "mixed")
HELD_BACK = "mixed"  # a seventh, to measure the calibrated ship
CALM_SEED, ROUGH_SEED = 100, 200


@dataclass(frozen=True)
class LeagueFleet:
    """One hull's ships: by how many calm voyages they are calibrated, and whether some know wind or waves."""

    hull: str
    duration_s: float | None = None
    references: int = len(MANOEUVRES)
    weather: bool = True

    def calm(self) -> list[SeaCase]:
        """Reference voyages with nothing hidden; the last is the one held back."""
        sailed = (*MANOEUVRES[: self.references], HELD_BACK)
        return [self._case(m, CALM_SEED + i) for i, m in enumerate(sailed)]

    def rough(self, effect: str) -> list[SeaCase]:
        """Voyages on which the ship that knows this effect has learned it."""
        return [self._case(m, ROUGH_SEED + i, ((effect, 1.0),)) for i, m in enumerate(("mixed", "zigzag_20"))]

    def cases(self) -> list[SeaCase]:
        return self.calm() + [c for n in self.known() for c in self.rough(n)]

    def known(self) -> tuple[str, ...]:
        return tuple(WEATHERS) if self.weather else ()

    def _case(self, manoeuvre: str, seed: int, hidden: tuple[tuple[str, float], ...] = ()) -> SeaCase:
        return SeaCase(
            self.hull, manoeuvre, hidden=hidden, seed=seed, duration_s=lasts(self.hull, self.duration_s)
        )


def make(fleet: LeagueFleet, folder: Path) -> None:
    """Calibrate a hull's ships and keep them beside the voyages."""
    path = folder / f"{fleet.hull}.ship"
    if not path.exists():
        path.write_bytes(pickle.dumps(calibrated(fleet, folder)))


def calibrated(fleet: LeagueFleet, folder: Path) -> dict[str, Any]:
    """{"": the calibrated ship, "Wind": the same with that effect fitted ..., "calibration": how well}."""
    start = load(fleet.hull)
    *sailed, last = [_sailed(c, folder, start) for c in fleet.calm()]
    done = calibrate(sailed, [(last.track, 0)], start)
    out: dict[str, Any] = {"": done.ship, "calibration": done.result}
    for effect in fleet.known():
        tracks = [_sailed(c, folder, done.ship).track for c in fleet.rough(effect)]
        out[effect] = done.ship.with_effects(*fitted(done.ship, [find(effect)], tracks).model.effects)
    return out


def _sailed(case: SeaCase, folder: Path, ship: Ship) -> Sailed:
    voyage = kept(case, folder)[0]
    return Sailed(voyage, track(voyage, ship), voyage.name)


def ships_of(hull: str, folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = pickle.loads((folder / f"{hull}.ship").read_bytes())
    return found
