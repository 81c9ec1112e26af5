"""Open-loop prediction: the model alone, from the measured state, over many windows of a voyage side by side.

Each window begins in the smooth motion under the readings (kinematics only), with the faults of the
instruments undone, and runs on recorded controls and weather; what it promises goes through the instruments
before it is compared with what they said.

Beside every prediction runs its noise: the same window begun in a state that is off as the readings'
scatter leaves it, read with that scatter (`SENSORS`); and once more with the slow disturbances a calibrated
model of this ship is known to miss (`STRUCTURE`). What these two are off by is what a perfect model, and a
model as good as its calibration, would still show."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.physics.state import Force, Situation
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.respond import readings, steered
from twin.study.estimation.start import noisy, seen, steadied, true_motion
from twin.study.prediction.disturbances import SlowDisturbances, disturbances
from twin.study.prediction.windows import MODEL, SENSORS, STRUCTURE, Windows, no_better
from twin.study.track.track import READINGS, STATE, Track

HORIZONS_S = (10.0, 60.0, 120.0)
STRIDE_S = 10.0  # a window begins this often
MOST_WINDOWS = 400  # of one track; longer voyages are sampled more sparsely
RUNAWAY = 1e6  # m, or whatever the unit is
COARSE = 8
LEADS = 24  # moments within a window at which the prediction is kept


def predict(
    track: Track,
    model: Model,
    horizons_s: Sequence[float] = HORIZONS_S,
    *,
    noise_model: NoiseModel | None = None,
    stride_s: float = STRIDE_S,
    leads: int = LEADS,
    seed: int = 0,
    simulated_alone: bool = False,
) -> Windows:
    """Run the model over the track's windows. `noise_model`: what calibration left unexplained, if the ship
    knows it; its run is no nearer than the ship was on its reference voyages, unless `simulated_alone`.

    Effects whose inputs the track lacks must have been left out (Model.without_inputs).
    """
    return predict_each(
        track,
        model,
        [] if noise_model is None else [noise_model],
        horizons_s,
        stride_s=stride_s,
        leads=leads,
        seed=seed,
        simulated_alone=simulated_alone,
    )[0]


def predict_each(
    track: Track,
    model: Model,
    noise_models: Sequence[NoiseModel],
    horizons_s: Sequence[float] = HORIZONS_S,
    *,
    stride_s: float = STRIDE_S,
    leads: int = LEADS,
    seed: int = 0,
    simulated_alone: bool = False,
) -> list[Windows]:
    """The same for each of these noise models, side by side; one without any where none is given."""
    lead = _leads(track, horizons_s, leads)
    measured = seen(track)
    start = _starts(track, np.isfinite(measured[:, :3]).all(1), round(min(horizons_s) / track.h), stride_s)
    rng = np.random.default_rng(seed)
    state, wind_to = true_motion(steadied(track), model)
    noisily = state[start] + noisy(track, model, rng)[start]
    begin = np.concatenate([state[start], noisily, *[noisily] * max(1, len(noise_models))])
    run = _Run(track, model, start, wind_to, disturbances(track, model, noise_models, start, rng))
    kept = run.through(tuple(begin.T), lead).reshape(len(lead), -1, start.size, len(READINGS))
    promised = kept.transpose(1, 0, 2, 3)
    promised[1:] += track.sd * rng.standard_normal(promised[1].shape)
    valid = _valid(track, measured, start, lead)
    each = [
        Windows(track, start, lead, promised[[MODEL, SENSORS, k]], valid, measured)
        for k in range(STRUCTURE, len(promised))
    ]
    return each if simulated_alone or not noise_models else [no_better(w, model.ship) for w in each]


def coarse(
    track: Track,
    model: Model,
    horizon_s: float,
    leads: int,
    stride_s: float = STRIDE_S,
    begins: np.ndarray | None = None,
) -> Windows:
    """Run the model alone: `predict` without its noise, and in steps of L/U_0 over COARSE, as a fit
    asks for thousands. `begins` (N,): mask of the steps at which windows may begin, if not at all."""
    return coarse_each(track, model, 1, horizon_s, leads, stride_s, begins)[0]


def coarse_each(
    track: Track,
    model: Model,
    count: int,
    horizon_s: float,
    leads: int,
    stride_s: float = STRIDE_S,
    begins: np.ndarray | None = None,
) -> list[Windows]:
    """The same of so many models (M,) side by side, whose numbers of the core differ: `model` holds each that
    does as a column of shape (M, 1). `begins` (N,): the grid steps
    at which windows may begin."""
    steps = coarse_steps(track, model)
    lead = steps * np.unique(
        np.linspace(0.0, horizon_s / track.h / steps, leads + 1)[1:].round().clip(1).astype(int)
    )
    measured = seen(track)
    start = _starts(track, np.isfinite(measured[:, :3]).all(1), int(lead[-1]), stride_s)
    start = start if begins is None else start[begins[start]]
    state, wind_to = true_motion(steadied(track), model)
    kept = _Run(track, model, start, wind_to, None).through(tuple(state[start].T), lead, steps)
    each = np.broadcast_to(
        kept if kept.ndim == 4 else kept[:, None], (len(lead), count, start.size, len(READINGS))
    )
    valid = _valid(track, measured, start, lead)
    return [Windows(track, start, lead, each[None, :, i], valid, measured) for i in range(count)]


def coarse_steps(track: Track, model: Model) -> int:
    """Grid steps that `coarse` takes at once [count]."""
    return max(1, int(float(model.ship.scale("time")) / COARSE / track.h))


def valid_windows(track: Track, lead: int) -> int:
    """How many windows of so many grid steps can be judged [count]."""
    measured = seen(track)
    start = _starts(track, np.isfinite(measured[:, :3]).all(1), lead, STRIDE_S)
    return int(_valid(track, measured, start, np.array([lead])).sum())


def ends(track: Track, model: Model, horizons_s: Sequence[float]) -> list[Windows]:
    """Run the model alone to each of these horizons: of each the windows that `predict` begins for it, looked
    at there only, without noise. All windows are run once, to the longest that lies within the track;
    what would end beyond it is valid nowhere."""
    measured = seen(track)
    placed = np.isfinite(measured[:, :3]).all(1)
    state, wind_to = true_motion(steadied(track), model)
    lead = [np.unique(_leads(track, [h], 1)) for h in horizons_s]
    starts = [_starts(track, placed, round(h / track.h), STRIDE_S) for h in horizons_s]
    begun, every = np.unique(np.concatenate(starts)), np.unique(np.concatenate(lead))
    run = np.zeros((every.size, begun.size, len(READINGS)))
    there = every[every < len(track) - begun.min()]
    if there.size:
        alone = _Run(track, model, begun, wind_to, None)
        run[: there.size] = alone.through(tuple(state[begun].T), there)
    return [
        Windows(
            track,
            start,
            ahead,
            run[np.ix_(np.searchsorted(every, ahead), np.searchsorted(begun, start))][None],
            _valid(track, measured, start, ahead),
            measured,
        )
        for start, ahead in zip(starts, lead, strict=True)
    ]


def again(windows: Windows, model: Model) -> np.ndarray:
    """(K, W, 8) in SI, what another model promises over the same windows, without any noise."""
    track = windows.track
    state, wind_to = true_motion(steadied(track), model)
    run = _Run(track, model, windows.start, wind_to, None)
    return run.through(tuple(state[windows.start].T), windows.lead)


def _leads(track: Track, horizons_s: Sequence[float], count: int) -> np.ndarray:
    """Grid steps ahead: every horizon, and an even spread of `count` up to the longest."""
    steps = [max(1, round(h / track.h)) for h in horizons_s]
    return np.unique([*steps, *np.linspace(1, max(steps), min(count, max(steps))).round().astype(int)])


def _starts(track: Track, placed: np.ndarray, shortest: int, stride_s: float) -> np.ndarray:
    """Evenly along the track; where it was logged more slowly than it is stepped, from the next step at which
    it was placed."""
    last = max(len(track) - max(shortest, 1), 1)
    stride = max(1, round(stride_s / track.h), int(np.ceil(last / MOST_WINDOWS)))
    start = np.arange(0, last, stride)
    there = np.flatnonzero(placed[:last])
    if there.size:
        near = there[np.searchsorted(there, start).clip(0, there.size - 1)]
        start = np.unique(np.where(np.abs(near - start) < stride, near, start))
    return start


def _valid(track: Track, measured: np.ndarray, start: np.ndarray, lead: np.ndarray) -> np.ndarray:
    end = start + lead[:, None]
    inside = end < len(track)
    end = np.minimum(end, len(track) - 1)
    broken = np.concatenate([[0], np.cumsum(~track.whole)])
    placed = np.isfinite(measured[:, :3]).all(1)
    return inside & (broken[end + 1] == broken[start]) & placed[end] & placed[start]


class _Run:
    """All windows of a track, once or three times each, stepped together."""

    def __init__(
        self,
        track: Track,
        model: Model,
        start: np.ndarray,
        wind_to: np.ndarray | None,
        slow: SlowDisturbances | None,
    ):
        self.track, self.start, self.slow = track, start, slow
        self.runs = 1  # of every window, side by side
        self.known = replace(model, residual=None)
        self.learned = model.residual
        controls = steered(track, model)
        self.orders = dict(controls.pop("orders", {}))
        self.inputs = dict(track.weather) | controls | {"n": track.n}
        if wind_to is not None:
            self.inputs["wind_to"] = wind_to
        if slow is not None:
            stream = of_role("stream").absent(model.ship).but(north=slow.water[0], east=slow.water[1])
            self.known = replace(self.known, effects=(*model.effects, stream))

    def through(self, state: tuple, lead: np.ndarray, steps: int = 1) -> np.ndarray:
        """(K, runs W, 8) readings at each lead, a multiple of `steps`: grid steps that are taken at once. A
        bad model may run away: it is then as wrong as can be written down."""
        self.runs, kept = state[0].size // max(1, self.start.size), []
        with np.errstate(all="ignore"):
            for k in range(0, int(lead[-1]) + 1, steps):
                if k:
                    middle = self._situation(k - steps + steps // 2, 0.5 * (steps % 2))
                    state = self._model(k - steps, state).step(state, middle, steps * self.track.h)
                if k in lead:
                    kept.append(self._read(k, state))
        return np.nan_to_num(np.stack(kept), nan=RUNAWAY, posinf=RUNAWAY, neginf=-RUNAWAY).clip(
            -RUNAWAY, RUNAWAY
        )

    def _situation(self, k: int, ahead: float = 0.0) -> Situation:
        """Inputs of every window k steps on; controls `ahead` of a step later."""
        step = np.minimum(self.start + k, len(self.track) - 1)
        after = np.minimum(step + 1, len(self.track) - 1)
        values = {name: self._of_each(w[step]) for name, w in self.inputs.items()}
        for name in ("delta", "n"):
            then = self._of_each(self.inputs[name][after])
            values[name] = values[name] + ahead * (then - values[name])
        orders = {name: self._between(x, step, after, ahead) for name, x in self.orders.items()} or None
        return Situation(**values, orders=orders, t=self._of_each(self.track.t[step]) + ahead * self.track.h)

    def _of_each(self, x: np.ndarray) -> np.ndarray:
        """What is the same on all runs of a window."""
        return x if self.runs == 1 else np.tile(x, self.runs)

    def _between(self, x: np.ndarray, step: np.ndarray, after: np.ndarray, ahead: float) -> np.ndarray:
        """A control of every window, `ahead` of a step after `step`."""
        return self._of_each(x[step] + ahead * (x[after] - x[step]))

    def _model(self, k: int, state: tuple) -> Model:
        """The model with what is learned and what is slow held for one step."""
        more = []
        if self.learned is not None:
            more.append(self._held(k, state))
        if self.slow is not None:
            more.append(self.slow.force(self.known, np.minimum(self.start + k, len(self.track) - 1)))
        if not more:
            return self.known
        force = sum(more, Force())
        return replace(self.known, residual=lambda _: force)

    def _held(self, k: int, state: tuple) -> Force:
        """The learned force at the model's own runs; the noise is given the same."""
        s = self._situation(k)
        s.x, s.y, s.psi, s.u, s.v, s.r = state
        self.known.forces(s, self.known.water(s))
        W = self.start.size
        own = {name: getattr(s, name)[:W] for name in (*STATE, "u_r", "v_r", "t", *self.inputs)}
        if s.orders is not None:
            own["orders"] = {name: x[:W] for name, x in s.orders.items()}
        return Force(*(np.tile(f, self.runs) for f in self.learned(Situation(**own))))  # type: ignore[misc]

    def _read(self, k: int, state: tuple) -> np.ndarray:
        s = self._situation(k)
        s.x, s.y, s.psi, s.u, s.v, s.r = state
        rates = self.known.nu_dot(s)
        s.u_dot, s.v_dot, s.r_dot = rates
        return readings(s, self.known)
