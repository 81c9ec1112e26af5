"""What is learned from: voyages in the frame that drifts with the water, split in blocks of time.

Seen from the water a steady current is gone (Galilei), so that neither the network nor the core has to
explain it. The current is what GNSS and log disagree by, averaged over the last CURRENT_S seconds: nothing of
the future is used. Without a log the frame stays the earth's and the ship's own current effects hold."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.errors import DataError
from twin.num import num
from twin.physics.effects.current import Current
from twin.physics.effects.varying_current import VaryingCurrent
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.study.estimation.respond import lagged
from twin.study.estimation.start import true_motion
from twin.study.track.track import STATE, Track
from twin.study.update.adding import in_one

CURRENT_S, BLOCK_S = 120.0, 300.0
FEWEST_BLOCKS = 12  # of a voyage that is cut in time
PARTS = ("train", "validation", "test")
SHARES = (0.6, 0.2, 0.2)
AXES = ("surge", "sway", "yaw")
LOG = {"u_r": len(STATE), "v_r": len(STATE) + 1}  # columns of Track.measured


@dataclass(frozen=True)
class TrainingLeg:
    """A stretch of one voyage; arrays (N,) at `t` [s], every h seconds; `state` (N, 6) and `rate` (N, 3) seen
    from the water."""

    name: str
    t: np.ndarray
    h: float
    state: np.ndarray
    rate: np.ndarray
    inputs: Mapping[str, np.ndarray]  # delta, n and the weather, by their names in Situation
    water: np.ndarray  # (N, 2) where the frame goes, north and east [m/s]
    whole: np.ndarray  # (N,) bool

    def __len__(self) -> int:
        return self.t.size

    def part(self, first: int, last: int) -> "TrainingLeg":
        """Grid steps first <= k < last."""
        cut = slice(first, last)
        return replace(
            self,
            t=self.t[cut],
            state=self.state[cut],
            rate=self.rate[cut],
            water=self.water[cut],
            whole=self.whole[cut],
            inputs={name: x[cut] for name, x in self.inputs.items()},
        )

    def starts(self, steps: int, stride: int) -> np.ndarray:
        """(K,) grid steps from which `steps` more can be run through without a hole in the controls."""
        broken = np.concatenate([[0], np.cumsum(~self.whole)])
        k = np.arange(0, max(len(self) - steps, 0), stride)
        return k[broken[k + steps + 1] == broken[k]]


def model_of(ship: Ship, tracks: Sequence[Track]) -> Model:
    """The ship's model as all the voyages can feed it; its current effects are left to the frame when all
    have a log."""
    model = in_one(Model.of(ship), tracks)
    if all(_logged(t) for t in tracks):
        model = replace(
            model, effects=tuple(e for e in model.effects if not isinstance(e, (Current, VaryingCurrent)))
        )
    return model


def leg(track: Track, model: Model) -> TrainingLeg:
    """The whole track, seen from the water, with the instruments' known faults undone."""
    state, wind_to = true_motion(track, model)
    inputs = dict(track.weather) | {"delta": lagged(track, model), "n": track.n}
    if wind_to is not None:
        inputs["wind_to"] = wind_to
    water = current(track, state) if _logged(track) else np.zeros((len(track), 2))
    if "wind_speed" in inputs:
        north = inputs["wind_speed"] * np.cos(inputs["wind_to"]) - water[:, 0]
        east = inputs["wind_speed"] * np.sin(inputs["wind_to"]) - water[:, 1]
        inputs["wind_speed"], inputs["wind_to"] = np.hypot(north, east), np.arctan2(east, north)
    state = afloat(state, water, track.h)
    rate = np.gradient(state[:, 3:], track.h, axis=0)
    return TrainingLeg(track.name, track.t, track.h, state, rate, inputs, water, track.whole)


def afloat(state: np.ndarray, water: np.ndarray, h: float) -> np.ndarray:
    """(N, 6) the motion seen from water that moves with `water` (N, 2). All in SI, h in [s]."""
    x, y, psi, u, v, r = state.T
    c, s = np.cos(psi), np.sin(psi)
    north, east = water.T
    drift = np.cumsum(water, axis=0) * h
    return np.column_stack(
        [x - drift[:, 0], y - drift[:, 1], psi, u - north * c - east * s, v - east * c + north * s, r]
    )


def current(track: Track, state: np.ndarray) -> np.ndarray:
    """(N, 2) the water's speed north and east: motion over ground less the log, mean of the past. Both in
    [m/s]."""
    log = track.measured[:, [LOG["u_r"], LOG["v_r"]]]
    du, dv = state[:, 3] - log[:, 0], state[:, 4] - log[:, 1]
    c, s = np.cos(state[:, 2]), np.sin(state[:, 2])
    return np.column_stack([_past_mean(du * c - dv * s, track.h), _past_mean(du * s + dv * c, track.h)])


def _past_mean(values: np.ndarray, h: float) -> np.ndarray:
    """The mean of what is there in the last CURRENT_S; of what there is so far at the beginning."""
    width = max(1, round(CURRENT_S / h))
    ok = np.isfinite(values)
    total = np.concatenate([[0.0], np.cumsum(np.where(ok, values, 0.0))])
    count = np.concatenate([[0], np.cumsum(ok)])
    last = np.arange(1, values.size + 1)
    first = np.maximum(last - width, 0)
    return (total[last] - total[first]) / np.maximum(count[last] - count[first], 1)


def _logged(track: Track) -> bool:
    return bool(np.isfinite(track.measured[:, list(LOG.values())]).any(0).all())


def split(legs: Sequence[TrainingLeg], block_s: float = BLOCK_S) -> dict[str, list[TrainingLeg]]:
    """Train, validation and test, in this order of time.

    Whole voyages where there are five or more; else each voyage is cut at two borders of blocks and the block
    at each border goes to nobody: neighbouring blocks of one manoeuvre are never on both sides."""
    parts: dict[str, list[TrainingLeg]] = {name: [] for name in PARTS}
    if len(legs) >= 5:
        for name, chosen in zip(PARTS, np.split(np.arange(len(legs)), _borders(len(legs))), strict=True):
            parts[name] = [legs[i] for i in chosen]
        return parts
    for one in legs:
        block = max(1, round(min(block_s, len(one) * one.h / FEWEST_BLOCKS) / one.h))
        first, second = _borders(len(one) // block)
        for name, (a, b) in zip(PARTS, ((0, first), (first + 1, second), (second + 1, None)), strict=True):
            parts[name].append(one.part(a * block, len(one) if b is None else b * block))
    return parts


def check_stretches(part: str, stretches: int, horizon_s: float) -> None:
    """DataError: a part of the data has no stretch of a free run's length [s] without a hole."""
    if not stretches:
        raise DataError(
            f"{part}: no stretch of {num(horizon_s, 3)} s has its rudder and shaft recorded throughout, as a "
            "free run of the model needs. Give more or longer voyages."
        )


def _borders(count: int) -> tuple[int, int]:
    first = max(1, round(SHARES[0] * count))
    second = max(first + 1, round((SHARES[0] + SHARES[1]) * count))
    if second >= count:
        raise DataError(
            f"{count} stretches cannot be split into train, validation and test. Give more or longer voyages."
        )
    return first, second
