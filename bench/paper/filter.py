"""The hybrid's own filter: where each ship is, how it moves through the water and where the water goes, from
the past alone.

State: x, y, psi, u, v, r (through the water), the current north and east, and the accelerations that neither
    physics nor network
explains. An extended Kalman filter of all voyages side by side; its Jacobian by differences through
Model.step. Predictions begin in its state and keep its current; the unexplained accelerations serve the
filter and are dropped. Tuned on validation runs: how fast current and unexplained accelerations may walk, and
how long the sea's noise hangs together."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import torch

from bench.paper.lab import LabCourse, judge
from export.batches import STRIDE
from export.training_loss import HeldOutLoss, free_run
from twin.physics.model import Model
from twin.physics.state import Force, Situation
from twin.study.track.track import READINGS

PSI, U, V, R, NORTH, EAST, PUSH = 2, 3, 4, 5, 6, 7, slice(8, 11)
SIZE = 11
NUDGED = (PSI, U, V, R)
NUDGE = (1e-3, 1e-2, 1e-2, 1e-5)
Push = Callable[[Situation], Force]


@dataclass(frozen=True)
class Tuning:
    """Walks in one second: of the unexplained accelerations in (U/T)^2, of the current in (m/s)^2; and the
    factor on each variance of a reading."""

    walk: float = 1e-6
    current: float = 1e-5
    noise: float = 4.0


TRIED = tuple(Tuning(*x) for x in product((1e-6, 1e-5, 1e-4), (1e-6, 1e-5), (1.0, 4.0)))


class Filter:
    """The filters of many voyages; `tick(k)` takes grid step k in, `x` (V, 11) and `P` (V, 11, 11) are where
    they stand."""

    def __init__(
        self, courses: Sequence[LabCourse], model: Model, push: Push | None, tunings: Sequence[Tuning]
    ):
        self.courses, self.model, self.push, self.h = courses, model, push, courses[0].water.h
        ship = model.ship
        speed, time = float(ship.U_0), float(ship.scale("time"))
        self.a = np.array([speed / time, speed / time, 1.0 / time**2])
        self.measured = np.stack([c.track.measured for c in courses], 1)
        self.sd = np.stack([c.track.sd for c in courses])
        self.noise = np.array([t.noise for t in tunings])[:, None] * self.sd**2
        steady = [*[1e-4 * self.h] * 2, 1e-10, *(3e-4 * self.h * self.a) ** 2]
        self.Q = np.stack(
            [np.diag([*steady, *[t.current * self.h] * 2, *(self.h * t.walk * self.a**2)]) for t in tunings]
        )
        names = set.intersection(*(set(c.water.inputs) for c in courses))
        self.inputs = {n: np.stack([c.water.inputs[n] for c in courses], 1) for n in names}
        self._begin()

    def _begin(self) -> None:
        first = np.stack([c.water.state[0] for c in self.courses])
        water = np.stack([c.water.water[0] for c in self.courses])
        self.x = np.concatenate([first, water, np.zeros((len(self.courses), 3))], 1)
        wide = self.sd[:, [READINGS.index(n) for n in ("x", "y", "psi", "u_r", "v_r", "r")]] ** 2
        rest = np.broadcast_to([0.04, 0.04, *(0.05 * self.a) ** 2], (len(self.courses), 5))
        self.P = np.stack([np.diag(p) for p in np.concatenate([10.0 * wide, rest], 1)])

    def run(self, steps: int) -> np.ndarray:
        """(steps + 1, V, 11) the states after each grid step."""
        kept = []
        for k in range(steps + 1):
            self.tick(k)
            kept.append(self.x.copy())
        return np.stack(kept)

    def tick(self, k: int) -> None:
        if k:
            self._predict(k)
        self._correct(self.measured[k])

    def _predict(self, k: int) -> None:
        now = {n: 0.5 * (x[k - 1] + x[k]) for n, x in self.inputs.items()}
        moved, F = self._ahead(now)
        self.x[:, :2] += moved[:, :2] + self.h * self.x[:, NORTH : EAST + 1]
        self.x[:, 2:6] = moved[:, 2:]
        self.x[:, 3:6] += self.h * self.x[:, PUSH]
        self.P = F @ self.P @ F.transpose(0, 2, 1) + self.Q

    def _ahead(self, now: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        """(V, 6) one grid step of the model from where the filters are, place relative; and its Jacobian (V,
        11, 11)."""
        many, count = len(self.x), 1 + 2 * len(NUDGED)
        shift = np.zeros((count, 6))
        for i, (column, by) in enumerate(zip(NUDGED, NUDGE, strict=True)):
            shift[1 + 2 * i, column], shift[2 + 2 * i, column] = by, -by
        start = self.x[None, :, :6] + shift[:, None]
        start[..., :2] = 0.0
        out = self._step(start.reshape(-1, 6), {n: np.tile(x, count) for n, x in now.items()}).reshape(
            count, many, 6
        )
        F = np.broadcast_to(np.eye(SIZE), (many, SIZE, SIZE)).copy()
        for i, (column, by) in enumerate(zip(NUDGED, NUDGE, strict=True)):
            F[:, :6, column] = (out[1 + 2 * i] - out[2 + 2 * i]) / (2.0 * by)
        F[:, [0, 1], [NORTH, EAST]] = self.h
        F[:, [U, V, R], [8, 9, 10]] = self.h
        return out[0], F

    def _step(self, start: np.ndarray, now: dict[str, np.ndarray]) -> np.ndarray:
        state, s, moving = tuple(start.T), Situation(**now), self.model
        if self.push is not None:
            s.x, s.y, s.psi, s.u, s.v, s.r = state
            self.model.forces(s, self.model.water(s))
            held = HeldOutLoss()
            with torch.no_grad():
                held.force = Force(*[f.double().numpy() for f in self.push(_tensors(s))])
            moving = Model(self.model.ship, self.model.effects, held)
        return np.stack(moving.step(state, s, self.h), -1)

    def _correct(self, measured: np.ndarray) -> None:
        """All readings at once; one that is missing says nothing."""
        H, expected = self._sight()
        there = np.isfinite(measured)
        gap = np.where(there, measured, expected) - expected
        gap[:, PSI] = (gap[:, PSI] + np.pi) % (2 * np.pi) - np.pi
        S = H @ self.P @ H.transpose(0, 2, 1)
        S[:, range(len(READINGS)), range(len(READINGS))] += np.where(there, self.noise, 1e12)
        K = np.linalg.solve(S, H @ self.P).transpose(0, 2, 1)
        self.x += (K @ gap[..., None])[..., 0]
        self.P -= K @ H @ self.P
        self.P = 0.5 * (self.P + self.P.transpose(0, 2, 1))

    def _sight(self) -> tuple[np.ndarray, np.ndarray]:
        """(V, 8, 11) and (V, 8): what the readings x, y, psi, u, v, r, u_r, v_r see of the state."""
        x = self.x
        c, s = np.cos(x[:, PSI]), np.sin(x[:, PSI])
        ahead, aside = x[:, NORTH] * c + x[:, EAST] * s, x[:, EAST] * c - x[:, NORTH] * s
        H = np.zeros((len(x), len(READINGS), SIZE))
        H[:, range(6), range(6)] = 1.0
        H[:, 3, NORTH], H[:, 3, EAST], H[:, 3, PSI] = c, s, aside
        H[:, 4, NORTH], H[:, 4, EAST], H[:, 4, PSI] = -s, c, -ahead
        H[:, 6, U] = H[:, 7, V] = 1.0
        expected = np.column_stack([x[:, :3], x[:, U] + ahead, x[:, V] + aside, x[:, R], x[:, U], x[:, V]])
        return H, expected


def _tensors(s: Situation) -> Situation:
    """The same as the network wants it."""
    return Situation(
        **{
            n: torch.tensor(v, dtype=torch.float32)
            for n in s.__slots__
            if isinstance(v := getattr(s, n), np.ndarray)
        }
    )


def predict(
    courses: Sequence[LabCourse], model: Model, push: Push | None, tuning: Tuning
) -> list[np.ndarray]:
    """(T, W, 3) for each course: filtered up to each start, then free."""
    return _predict(courses, model, push, [tuning] * len(courses))


def _predict(
    courses: Sequence[LabCourse], model: Model, push: Push | None, tunings: Sequence[Tuning]
) -> list[np.ndarray]:
    states = Filter(courses, model, push, tunings).run(int(max(c.starts[-1] for c in courses)))
    return from_states(courses, model, push, [states[c.starts, i] for i, c in enumerate(courses)])


def from_states(
    courses: Sequence[LabCourse], model: Model, push: Push | None, states: Sequence[np.ndarray]
) -> list[np.ndarray]:
    """(T, W, 3) north, east, psi over ground: free runs from filters' states (W, 11), their current kept."""
    local = torch.tensor(np.concatenate(states)[:, :6], dtype=torch.float32)
    local[:, :2] = 0.0
    names = set.intersection(*(set(c.water.inputs) for c in courses))
    fed = {
        n: torch.tensor(np.concatenate([c.water.inputs[n][c.at] for c in courses], 1), dtype=torch.float32)
        for n in names
    }
    h = STRIDE * courses[0].water.h
    with torch.no_grad():
        run = free_run(push, model, local, fed, torch.full((len(local),), h)).double().numpy()[..., :3]  # type: ignore[arg-type]
    parts = np.split(run, np.cumsum([len(s) for s in states])[:-1], axis=1)
    return [_over_ground(part, state, h) for part, state in zip(parts, states, strict=True)]


def _over_ground(run: np.ndarray, state: np.ndarray, h: float) -> np.ndarray:
    lead = h * np.arange(1, run.shape[0] + 1)[:, None, None]
    return np.concatenate([run[..., :2] + state[:, :2] + state[:, NORTH : EAST + 1] * lead, run[..., 2:]], -1)


def tuned(courses: Sequence[LabCourse], model: Model, push: Push | None) -> Tuning:
    """What predicts validation voyages best (heading and lateral errors, each over its least); all are tried
    side by side."""
    many = len(courses)
    runs = _predict(list(courses) * len(TRIED), model, push, [t for t in TRIED for _ in courses])
    found = {t: judge(runs[i * many : (i + 1) * many], courses) for i, t in enumerate(TRIED)}
    heading = {t: e.heading_deg.mean() for t, e in found.items()}
    lateral = {t: e.lateral_m.mean() for t, e in found.items()}
    return min(TRIED, key=lambda t: heading[t] / min(heading.values()) + lateral[t] / min(lateral.values()))
