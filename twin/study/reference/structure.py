"""The noise model of a ship: how much a calibrated model of this kind still leaves unexplained, found on
reference voyages.

Each number of the NoiseModel is the one under which every reference voyage is most probable given the others,
the core's own uncertainty integrated out (cross-validated likelihood; Rasmussen & Williams 2006, sec. 5.4.2),
found by coordinate ascent on a geometric grid."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from twin.physics.ship import Ship
from twin.physics.ship_notes import positive, read_from
from twin.study.estimation.columns import Unknown
from twin.study.estimation.filters import GROUND
from twin.study.estimation.fit import evidence
from twin.study.estimation.innovations import NoiseModel, Normal, innovate
from twin.study.estimation.linear import Linear
from twin.study.reference.path_error import of_ship

MOST_SEGMENTS = 40
FEWER = 20  # where many columns make each dear
BOUNDS = {
    "share": (0.01, 0.5),
    "calm": (0.1, 4.0),
    "white": (0.002, 1.0),
    "flow": (0.002, 0.05),
    "sensor": (0.7, 4.0),
    "wander": (5e-4, 0.5),
    "heading_wander": (2e-5, 0.05),
    "velocity_error": (5e-4, 0.2),
    "velocity_error_s": (0.5, 32.0),
}
# where the ascent begins
WANDER, HEADING_WANDER = 4e-3, 4e-4  # m/sqrt(s), rad/sqrt(s)
VELOCITY_ERROR, VELOCITY_ERROR_S = 0.0125, 4.0  # of U_0, s
RECEIVERS = 4.0  # times less fast acceleration of the ship, where the receiver is taken to err
WORTH = 3.0  # mean log probability of a voyage that a receiver's error must add
# how far the slow part may fall beside more unknowns, as a share of what a core alone is ever trusted with
BESIDE = 0.4


def noise_model_of(ship: Ship, name: str = "floor") -> NoiseModel | None:
    """The noise model that calibration left in the ship file, None when it was never calibrated: what the
    model alone leaves (`floor`), or what is left beside all that is usual on this ship (`beside`).
    SettingsError: its file does not hold it as it was written."""
    table = ship.notes.get("structural", {}).get(name)
    if not table:
        return None
    with read_from(ship, f"[structural] {name}"):
        rest: dict[str, Any] = {
            key: _by_axis(v) if key == "white" else float(v) for key, v in table.items() if key != "share"
        }
        found = NoiseModel(_by_axis(table["share"]), **rest)
        if not np.all(np.isfinite(np.hstack(list(asdict(found).values())))):
            raise ValueError("not finite")
        for level in (*found.share, *found.white, found.sensor):
            positive(level)
    return found


def once_off(ship: Ship, key: str, horizon_s: np.ndarray) -> np.ndarray:
    """How far off the calibrated ship was, so far ahead, on voyages that it was not fitted to
    (`position_m`, `heading_deg`); 0 where no calibration measured it: as the reference voyages have it,
    each left out in turn (reference/path_error.py), or, in an older file, the voyages that were held out.
    Powers of the time between the measured horizons, in proportion to it before the first. (K,), in the
    unit of `key`."""
    if (known := of_ship(ship)) is not None:
        return (
            np.degrees(known.expected("heading_rad", horizon_s))
            if key == "heading_deg"
            else known.expected(key, horizon_s)
        )
    told = [
        (e["horizon_s"], e[key]) for e in ship.notes.get("structural", {}).get("held_out", ()) if e.get(key)
    ]
    if not told:
        return np.zeros_like(horizon_s)
    ahead, error = np.array(told).T
    return np.exp(np.interp(np.log(horizon_s), np.log(ahead), np.log(error))) * np.minimum(
        1.0, horizon_s / ahead[0]
    )


def _by_axis(value: float | Sequence[float]) -> tuple[float, float, float]:
    """One number for surge, sway and yaw, or one for each."""
    surge, sway, yaw = (float(v) for v in (value if isinstance(value, Sequence) else (value,) * 3))
    return surge, sway, yaw


def structural_noise(
    lines: Sequence[Linear], unknowns: Sequence[Unknown], start: NoiseModel | None = None
) -> NoiseModel:
    """The most probable noise model of these reference voyages (linearised about the fitted model): what the
    core alone leaves. A receiver's error is asked for whatever `start` holds of it."""
    begun = replace(start or NoiseModel(), velocity_error=0.0)
    return _ascended(lines, unknowns, begun, 1.0, MOST_SEGMENTS, receiver=True)


def structural_noise_beside(
    lines: Sequence[Linear], unknowns: Sequence[Unknown], start: NoiseModel
) -> NoiseModel:
    """The same when the unknowns are all that a diagnosis keeps in mind: less is left beside them."""
    return _ascended(lines, unknowns, start, BESIDE, FEWER, receiver=False)


def _ascended(
    lines: Sequence[Linear],
    unknowns: Sequence[Unknown],
    start: NoiseModel,
    least: float,
    most: int,
    receiver: bool,
) -> NoiseModel:
    sd = np.array([u.sd for u in unknowns])

    def scores(noise_models: Sequence[NoiseModel]) -> list[float]:
        return [predictive(n, sd) for n in innovate(lines, noise_models, most)] if noise_models else []

    start = replace(
        start, wander=start.wander or WANDER, heading_wander=start.heading_wander or HEADING_WANDER
    )
    best, noise_model = _searched(scores, start, least)
    if receiver and _restless(noise_model) and any(np.isfinite(x.e[:, GROUND]).any() for x in lines):
        erring, noise = _searched(scores, _of_the_receiver(noise_model), least)
        noise_model = noise if erring > best + WORTH else noise_model
    # the fewer voyages, the less they say of the next: a predictive, not a fitted scatter
    few = 1.0 + 4.0 / max(len(lines), 1)
    return noise_model.scaled(few**0.5)


def _restless(noise_model: NoiseModel) -> bool:
    """Whether much more seems to push the ship in surge or sway than where the search begins."""
    return max(noise_model.white[:2]) > RECEIVERS * NoiseModel().white[0]


def _of_the_receiver(noise_model: NoiseModel) -> NoiseModel:
    """Where the search begins if the receiver errs, and not the ship is pushed."""
    surge, sway, yaw = noise_model.white
    low = BOUNDS["white"][0]
    return replace(
        noise_model,
        white=(max(surge / RECEIVERS, low), max(sway / RECEIVERS, low), yaw),
        velocity_error=VELOCITY_ERROR,
        velocity_error_s=VELOCITY_ERROR_S,
    )


def _searched(
    scores: Callable[[Sequence[NoiseModel]], list[float]], noise_model: NoiseModel, least: float
) -> tuple[float, NoiseModel]:
    """The most probable noise model that is reached by coordinate ascent, and its score."""
    best, step = scores([noise_model])[0], 2.0
    changes = [c for i, c in enumerate(CHANGES) if i < ERRING or noise_model.velocity_error > 0.0]
    while step > 1.2:
        trials = [
            (i, t)
            for i, change in enumerate(changes)
            for k in (step, 1.0 / step)
            if _inside(t := change(noise_model, k), least)
        ]
        found = scores([t for _, t in trials])
        better: dict[int, tuple[float, NoiseModel]] = {}
        for (i, trial), score in zip(trials, found, strict=True):
            if score > max(best, better.get(i, (best, noise_model))[0]):
                better[i] = (score, trial)
        moves = sorted(better.values(), key=lambda m: -m[0])
        together = [_together(noise_model, [m for _, m in moves[:n]]) for n in range(1, len(moves) + 1)]
        found = [moves[0][0], *scores(together[1:])] if moves else []
        if moves and max(found) > best + 0.2:
            best, noise_model = max(found), together[int(np.argmax(found))]
        else:
            step = step**0.5
    return best, noise_model


def _together(noise_model: NoiseModel, moves: Sequence[NoiseModel]) -> NoiseModel:
    """The noise model with all these single changes made together."""
    start, out = _logs(noise_model), _logs(noise_model)
    for move in moves:
        out = out + (_logs(move) - start)
    return _noise_model(out)


def _logs(noise_model: NoiseModel) -> np.ndarray:
    return np.log(
        [*noise_model.share, *noise_model.white, *(getattr(noise_model, n) or TINY for n in SINGLE)]
    )


def _noise_model(logs: np.ndarray) -> NoiseModel:
    a, b, c, d, e, f, *rest = np.exp(logs).tolist()
    single = {n: v if v > 2.0 * TINY else 0.0 for n, v in zip(SINGLE, rest, strict=True)}
    return NoiseModel((a, b, c), white=(d, e, f), **single)


def predictive(normal: Normal, sd: np.ndarray) -> float:
    """Mean over the voyages of the log probability of each, given all the others (of one voyage: of each
    half, given the other).

    A noise model that only has to explain what the core was fitted to comes out too low, and the next
    manoeuvre then looks strange. `sd` (P,): the priors' widths."""
    of = normal.voyages()
    whole, groups = evidence(normal, sd), np.unique(of)
    if groups.size < 2:
        return whole
    return float(np.mean([whole - evidence(normal.only(of != g), sd) for g in groups]))


def _change(i: int) -> Callable[[NoiseModel, float], NoiseModel]:
    def change(noise_model: NoiseModel, factor: float) -> NoiseModel:
        logs = _logs(noise_model)
        logs[i] += np.log(factor) * (0.5 if i == SENSOR else 1.0)
        return _noise_model(logs)

    return change


RECEIVER = ("velocity_error", "velocity_error_s")
SINGLE = ("calm", "flow", "sensor", "wander", "heading_wander", *RECEIVER)
TINY = 1e-12  # stands for none
# places in `_logs` of the readings' scatter, and from where on a receiver's velocity
SENSOR, ERRING = 8, 11
CHANGES = tuple(_change(i) for i in range(13))


def _inside(noise_model: NoiseModel, least: float) -> bool:
    low = {"share": least, "calm": least}
    asked = {n: b for n, b in BOUNDS.items() if noise_model.velocity_error > 0.0 or n not in RECEIVER}
    values = {name: np.atleast_1d(getattr(noise_model, name)) for name in asked}
    return all(low.get(name, 1.0) * lo <= v <= hi for name, (lo, hi) in asked.items() for v in values[name])
