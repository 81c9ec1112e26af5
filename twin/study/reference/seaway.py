"""Waves: what swings a ship faster than it manoeuvres is the sea's doing, not its own, and is not noise
either.

The motion of first order in a seaway is large and swings about zero. A filter that takes it for noise that
forgets itself from one reading to the next believes far too much, or trusts nothing. So the filter carries
the waves' accelerations in narrow bands of their own (`waves.py`), as fast and as strong as this voyage shows
them: what the model leaves over along the path that is swifter than a ship manoeuvres. Whether that is a sea
at all, the readings say; and whatever lies in the bands, no cause is read from. Separation of wave-frequency
and low-frequency motion: Fossen (2021), sec. 13.2."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.study.estimation.columns import Unknown
from twin.study.estimation.fit import evidence
from twin.study.estimation.in_order import likeliest_in_order
from twin.study.estimation.innovations import NoiseModel, innovate_each
from twin.study.estimation.linear import Linear, linearise
from twin.study.estimation.respond import respond
from twin.study.estimation.start import steadied, wave_period_s
from twin.study.reference.encounter import met, one_frequency
from twin.study.reference.nuisance import TEMPER, nuisance_unknowns
from twin.study.reference.steering_gear import about, geared
from twin.study.reference.structure import noise_model_of
from twin.study.track.segments import read_parts, segments
from twin.study.track.smooth_motion import running_mean
from twin.study.track.track import Track

SWIFT = 3.0  # L/U_0: what swings about the mean over so long a time may be waves
LATELY = 8.0  # L/U_0: on another course waves are met otherwise
WAVE_SHARE = (
    0.5  # share of what is swift in what is left over of sway or yaw, from which waves are looked for
)
SEA = 0.003  # wave height in ship lengths from which a measured sea may move it
MOST_SEGMENTS = 12  # by which a sea is judged
STRENGTHS = (1.0, 2.0, 4.0, 8.0)  # of the waves, in units of what the smooth path shows of them
WHITES = (1.0, 8.0, 32.0)  # and of the noise that might be there instead
WAVES_LOG_BAYES = 20.0  # log evidence, tempered, that waves must add where no sea was measured
IN_A_WAVE = 8  # parts of a wave: over one the roll is averaged before its rate is taken, which leaves 97 %
# times as strong as is likeliest: one wave swings all axes and the rudder follows it, so that nothing is
# believed in their band
BEYOND = 3.0


def swung(track: Track, model: Model, gear: bool = True) -> Track:
    """The track with what waves do to it, if that is likelier than any noise or a slow gear would be,
    whatever else may be wrong with it; else without. A sea that was measured need not be proved, but must be
    the likelier. `gear`: whether there may be another gear than the model has; not where it was looked for on
    this ship's voyages."""
    track = track if track.swell is None else replace(track, swell=None)
    usable, known = model.without_inputs(track.missing())[0], of_ship(model.ship)
    unknowns = nuisance_unknowns(usable, known)
    try:
        rough, sea, calm = likeliest_waves(track, usable, unknowns)
        enough = TEMPER * (0.0 if at_sea(track, model) else WAVES_LOG_BAYES)
        if rough.swell is None or (sea <= calm + enough and not at_sea(track, model)):
            return track
        part = read_parts([track], float(model.ship.scale("time")), MOST_SEGMENTS)
        # a gear that lags leaves swift accelerations, too, and is nothing to first order
        slow = geared(usable, part, unknowns, known, TEMPER) if gear else usable
        if slow is not usable:
            other, more, less = likeliest_waves(track, slow, about(unknowns, slow))
            rough, sea, calm = rough if sea > more else other, max(sea, more), max(calm, less)
        return rough if sea > calm + enough else track
    except np.linalg.LinAlgError:  # a model that no filter can follow says nothing of waves
        return track


def likeliest_waves(track: Track, model: Model, unknowns: Sequence[Unknown]) -> tuple[Track, float, float]:
    """The track in waves as fast and as strong as the readings ask for, if anything swings it; log evidence
    of that, and of no waves. One frequency of many must be proved even where a sea was measured: its height
    does not say how often it is met."""
    noise_model, rough = noise_model_of(model.ship) or NoiseModel(), _swinging(track, model)
    if not rough:
        return track, -np.inf, 0.0
    parts = [
        read_parts([t], float(model.ship.scale("time")), MOST_SEGMENTS)[0]
        for t in (track, *(levelled(t) for t in rough))
    ]
    (calm, *lines), sd = (
        [linearise(p, model, unknowns, of_ship(model.ship)) for p in parts],
        np.array([u.sd for u in unknowns]),
    )

    def likely(*lines: Linear) -> list[float]:
        each = innovate_each([[line] for line in lines], [noise_model.scaled(white=k) for k in WHITES])
        return [max(evidence(n, sd) for n in normals) for normals in each]

    def as_strong(line: Linear, k: float) -> float:
        return likely(replace(line, track=_times(line.track, k)))[0]

    none, *weakest = likely(calm, *lines)
    tried = [
        likeliest_in_order(partial(as_strong, line), (x, STRENGTHS[0]), STRENGTHS[1:] if x > none else ())
        for line, x in zip(lines, weakest, strict=True)
    ]
    proof = TEMPER * WAVES_LOG_BAYES if at_sea(track, model) else 0.0
    as_likely = [x - proof * one_frequency(t) for (x, _), t in zip(tried, rough, strict=True)]
    best = int(np.argmax(as_likely))
    return _times(rough[best], BEYOND * tried[best][1]), as_likely[best], none


def _times(track: Track, strength: float) -> Track:
    """The track in waves so many times as strong."""
    return track if track.swell is None else replace(track, swell=track.swell * np.repeat([1.0, strength], 3))


def _swinging(track: Track, model: Model) -> list[Track]:
    """The track with what waves may do to it: as the smooth path shows them from moment to moment, and at
    one frequency as the readings of yaw do (encounter.py). None where nothing swings it or there is too
    little of it."""
    time = float(model.ship.scale("time"))
    if not segments([track], time):
        return []
    shown = [*_along(track, model, time), *met(track, SWIFT * time, LATELY * time, WAVES_LOG_BAYES)]
    return [replace(track, swell=swell) for swell in shown]


def _along(track: Track, model: Model, time: float) -> list[np.ndarray]:
    """(N, 6) what swings it along the smooth path, if enough of what the model leaves over is swift; `time`
    L/U_0 [s]."""
    left = _left_over(track, model)
    left -= left.mean(0)
    swift = left - _lately(left, SWIFT * time / track.h)
    share = swift[:, 1:].var(0) / np.maximum(left[:, 1:].var(0), 1e-30)
    if not at_sea(track, model) and share.max() < WAVE_SHARE:
        return []
    size, change = (
        _lately(x**2, LATELY * time / track.h) for x in (swift, np.gradient(swift, track.h, axis=0))
    )
    omega = np.sqrt(change / np.maximum(size, 1e-30)).clip(
        2.0 * np.pi / (SWIFT * time), 0.5 * np.pi / track.h
    )
    return [np.column_stack([omega, np.sqrt(size)])]


def levelled(track: Track) -> Track:
    """The track with its roll averaged over one period of the waves: how it heels to a wave would be taken
    for its cause. An antenna swings with it all the same (`Track.rolled`)."""
    if track.swell is None:
        return track
    steps = max(1, round(wave_period_s(track) / track.h))
    phi = track.rolled.get("phi", track.weather.get("phi"))
    if phi is None:
        return track
    rate = np.gradient(running_mean(phi, max(1, round(steps / IN_A_WAVE))), track.h)
    rolled = {"phi": phi, "p": rate}
    heel = {name: running_mean(x, steps) for name, x in rolled.items()}
    return replace(track, weather={**track.weather, **heel}, rolled=rolled)


def excited(track: Track, model: Model) -> np.ndarray:
    """(N, 3) acceleration by which waves change the mean of what hull, rudder and propeller do, for drag is
    not in proportion to speed: halfway between both ends of the swing, less the middle [m/s2, m/s2,
    rad/s2]."""
    if track.swell is None:
        return np.zeros((len(track), 3))
    swing = track.state[:, 3:] - steadied(track).state[:, 3:]
    swing = np.sqrt(2.0 * _lately(swing**2, LATELY * float(model.ship.scale("time")) / track.h))
    there, back = (
        np.column_stack([track.state[:, :3], track.state[:, 3:] + sign * swing]) for sign in (1.0, -1.0)
    )
    at = [respond(replace(track, state=state), model)[0] for state in (there, back, track.state)]
    return 0.5 * (at[0] + at[1]) - at[2]


def at_sea(track: Track, model: Model) -> bool:
    """Whether waves were measured that may move it."""
    return "H_s" in track.weather and bool(np.nanmedian(track.weather["H_s"]) > SEA * float(model.ship.L_pp))


def _left_over(track: Track, model: Model) -> np.ndarray:
    """(N, 3) acceleration along the path that the model does not explain [m/s2, m/s2, rad/s2]."""
    left = np.gradient(track.state[:, 3:6], track.h, axis=0) - respond(track, model)[0]
    return np.where(track.whole[:, None], left, 0.0)


def _lately(values: np.ndarray, steps: float) -> np.ndarray:
    """Running mean of every column."""
    return np.column_stack([running_mean(column, max(1, round(steps))) for column in values.T])
