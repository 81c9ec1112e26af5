"""One harness for all models: the same windows, the same controls and weather, the same truth.

A window is a free run of 120 s in a zigzag, begun at 290, 350, 410, 470 or 530 s (paper_sea.STARTS_S). Models
that keep no filter begin in the smooth motion under the readings (it sees a few seconds ahead; the filter and
the LSTM do not)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch

from bench.paper.paper_voyages import STARTS_S, PaperVoyage
from export.batches import STRIDE
from export.data import LOG, TrainingLeg, afloat, current, leg
from export.residual_network import ResidualNetwork
from export.training_loss import free_run
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.study.track.track import READINGS, Track, track

HORIZON_S = 120.0


@dataclass(frozen=True)
class LabCourse:
    """A voyage for judging: as tracked, seen from the water, seen from the earth, and the truth (N, 3) north,
    east, psi on the grid."""

    name: str
    scenario: str
    track: Track
    floating: Track
    water: TrainingLeg
    earth: TrainingLeg
    truth: np.ndarray
    starts_s: tuple[float, ...] = STARTS_S

    @property
    def steps(self) -> int:
        return round(HORIZON_S / (STRIDE * self.water.h))

    @property
    def starts(self) -> np.ndarray:
        return np.array([round(t / self.water.h) for t in self.starts_s])

    @property
    def at(self) -> np.ndarray:
        """(T + 1, W) grid steps of the windows."""
        return self.starts + STRIDE * np.arange(self.steps + 1)[:, None]


def course(sailed: PaperVoyage, ship: Ship, starts_s: tuple[float, ...] = STARTS_S) -> LabCourse:
    t = track(sailed.voyage, ship)
    model = Model(ship)
    blind = t.measured.copy()
    blind[:, list(LOG.values())] = np.nan
    time_s = sailed.voyage.time_s - sailed.voyage.time_s[0]
    truth = np.column_stack([np.interp(t.t, time_s, column) for column in sailed.truth.T])
    return LabCourse(
        t.name,
        t.name.split()[0],
        t,
        floating(t, ship),
        leg(t, model),
        leg(replace(t, measured=blind), model),
        truth,
        starts_s,
    )


def floating(t: Track, ship: Ship) -> Track:
    """The track as it would have been recorded by somebody who drifts with the water: no current is left in
    it."""
    water = current(t, t.state)
    drift = np.cumsum(water, axis=0) * t.h
    measured, (north, east) = t.measured.copy(), water.T
    c, s = np.cos(t.state[:, 2]), np.sin(t.state[:, 2])
    for name, shift in zip(
        ("x", "y", "u", "v"), (*drift.T, north * c + east * s, east * c - north * s), strict=True
    ):
        measured[:, READINGS.index(name)] -= shift
    still = leg(t, Model(ship))
    weather = {k: still.inputs[k] for k in t.weather}
    return replace(t, state=afloat(t.state, water, t.h), measured=measured, weather=weather)


def free(
    model: Model,
    network: ResidualNetwork | None,
    courses: Sequence[LabCourse],
    view: str = "water",
    states: Sequence[np.ndarray] | None = None,
) -> list[np.ndarray]:
    """(T, W, 3) north, east, psi over ground for each course: free runs from the view's state (or from
    `states`), the water as it was."""
    views: list[TrainingLeg] = [getattr(c, view) for c in courses]
    begin = (
        [v.state[c.starts] for v, c in zip(views, courses, strict=True)] if states is None else list(states)
    )
    local = torch.tensor(np.concatenate(begin), dtype=torch.float32)
    local[:, :2] = 0.0
    names = set.intersection(*(set(v.inputs) for v in views))
    inputs = {n: [v.inputs[n][c.at] for v, c in zip(views, courses, strict=True)] for n in names}
    inputs["t"] = [v.t[c.at] for v, c in zip(views, courses, strict=True)]
    h = torch.full((len(local),), STRIDE * views[0].h)
    with torch.no_grad():
        fed = {n: torch.tensor(np.concatenate(x, 1), dtype=torch.float32) for n, x in inputs.items()}
        run = free_run(network, model, local, fed, h).double().numpy()[..., :3]
    parts = np.split(run, np.cumsum([len(b) for b in begin])[:-1], axis=1)
    return [grounded(r, c, v) for r, c, v in zip(parts, courses, views, strict=True)]


def grounded(run: np.ndarray, c: LabCourse, view: TrainingLeg) -> np.ndarray:
    """(T, W, 3) seen from the water -> over ground, from where the ship was measured at the start."""
    lead = STRIDE * view.h * np.arange(1, run.shape[0] + 1)[:, None, None]
    place = c.earth.state[c.starts, :2] + view.water[c.starts] * lead
    return np.concatenate([run[..., :2] + place, run[..., 2:]], -1)


@dataclass(frozen=True)
class Errors:
    """Of one model on many windows: (W, T) heading [rad] and lateral [m] errors with their truths, and which
    voyage each is of."""

    heading: np.ndarray
    lateral: np.ndarray
    true_heading: np.ndarray
    true_lateral: np.ndarray
    voyage: np.ndarray
    scenario: np.ndarray

    @property
    def heading_deg(self) -> np.ndarray:
        """(W,) mean over the horizon."""
        return np.degrees(np.abs(self.heading).mean(1))

    @property
    def lateral_m(self) -> np.ndarray:
        return np.abs(self.lateral).mean(1)


def judge(runs: Sequence[np.ndarray], courses: Sequence[LabCourse]) -> Errors:
    """The errors of predictions (T, W, 3), one array for each course."""
    columns: list[list[np.ndarray]] = [[] for _ in range(6)]
    for i, (run, c) in enumerate(zip(runs, courses, strict=True)):
        true, psi = c.truth[c.at], c.truth[c.starts, 2]
        run = np.nan_to_num(run, nan=1e6, posinf=1e6, neginf=-1e6).clip(-1e6, 1e6)
        off = run - true[1:]
        heading = (off[..., 2] + np.pi) % (2 * np.pi) - np.pi
        moved = true[1:] - true[0]
        for column, x in zip(
            columns,
            (
                heading.T,
                _across(off, psi).T,
                moved[..., 2].T,
                _across(moved, psi).T,
                np.full(psi.size, i),
                np.full(psi.size, int(c.scenario[-1])),
            ),
            strict=True,
        ):
            column.append(x)
    return Errors(*(np.concatenate(x) for x in columns))


def _across(off: np.ndarray, psi: np.ndarray) -> np.ndarray:
    return off[..., 1] * np.cos(psi) - off[..., 0] * np.sin(psi)
