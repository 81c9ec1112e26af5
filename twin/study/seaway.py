"""Waves taken out of a track before it is judged: what swings faster than the ship manoeuvres is the sea's doing, not hers.

The motion of first order in a seaway is large and swings about zero. A filter that takes it for noise that forgets itself from one
reading to the next believes far too much, or trusts nothing. So when the sea is seen to work (the acceleration that the model leaves
over is mostly faster than the ship), the path is averaged over one period of the waves, and the readings over stretches as long.
A boat that is quicker than the waves follows them: what they do to her cannot be averaged away and counts as doubt instead.
Separation of wave-frequency and low-frequency motion: Fossen (2021), sec. 13.2.
"""

from dataclasses import replace

import numpy as np

from twin.physics.core import GRAVITY
from twin.physics.model import Model

from .respond import respond
from .track import READINGS, Track

SLOW = 0.6  # of L/U_0: what swings with a longer period may be the ship's own doing
SEA = 0.003  # wave height in ship lengths from which a measured sea may move her
SWIFT = 3.0  # L/U_0: what swings about the mean over so long a time is no steady force
WORKING = 10.0  # energy of the swift part over that of the slow part from which the sea is seen to work
PATH = [READINGS.index(name) for name in ("x", "y", "psi", "u", "v", "r", "u", "v")]  # what of the path each reading follows


def calmed(track: Track, model: Model) -> Track:
    """The track without the waves' motion; the same track when no waves are seen. `model` must have its inputs on this track."""
    steps = wave_steps(track, model)
    if steps < 2:
        return track
    state = np.column_stack([_mean(column, steps) for column in track.state.T])
    off = track.measured - state[:, PATH]
    off[:, 2] = (off[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
    whole = len(track) // steps * steps
    blocks = off[:whole].reshape(-1, steps, off.shape[1])
    some = np.isfinite(blocks).any(1)
    mean = np.where(some, np.nansum(blocks, 1) / np.maximum(np.isfinite(blocks).sum(1), 1), np.nan)
    middle = np.arange(steps // 2, whole, steps)
    measured = np.full_like(track.measured, np.nan)
    measured[middle] = state[middle][:, PATH] + mean
    weather = {name: _mean(values, steps) if name == "phi" else values for name, values in track.weather.items()}
    delta, n = (np.where(track.whole, _mean(x, steps), x) for x in (track.delta, track.n))  # as slow as what they do
    return replace(track, state=state, measured=measured, sd=_scatter(mean, track.sd), weather=weather, delta=delta, n=n)


def tossed(track: Track, model: Model) -> np.ndarray:
    """(N, 3) acceleration that waves give a ship which meets some of them as slowly as she moves herself [m/s2, m/s2, rad/s2], where they
    were measured: what the model leaves over that is swifter than a steady force, but no more than H_s/4 omega^2 aside and ahead, and
    its change along the hull (or along the wave, k = omega^2/g, when that is longer). In a following sea she meets them at
    omega - omega^2 U/g."""
    if not at_sea(track, model) or "T_p" not in track.weather or not track.whole.any():
        return np.zeros((len(track), 3))
    time, U = float(model.ship.scale("time")), float(model.ship.U_0)
    omega = 2.0 * np.pi / np.maximum(track.weather["T_p"], 0.1)
    slow = np.abs(omega - omega**2 * U / GRAVITY) < 2.0 * np.pi / (SLOW * time)
    most = np.nan_to_num(np.where(slow, track.weather["H_s"] / 4.0 * omega**2, 0.0))
    most = np.column_stack([most, most, most * np.minimum(omega**2 / GRAVITY, 1.0 / float(model.ship.L_pp))])
    left = _left_over(track, model)
    steady = np.column_stack([_mean(column, max(1, round(SWIFT * time / track.h))) for column in left.T])
    return np.minimum(most, (left - steady)[track.whole].std(0))


def at_sea(track: Track, model: Model) -> bool:
    """Whether waves were measured that may move her."""
    return "H_s" in track.weather and bool(np.nanmedian(track.weather["H_s"]) > SEA * float(model.ship.L_pp))


def wave_steps(track: Track, model: Model) -> int:
    """The waves' mean period in grid steps, when most of the sway and yaw acceleration that the model leaves over is faster than the
    ship; else 0."""
    if not track.whole.any():
        return 0
    left = np.where(track.whole[:, None], _left_over(track, model)[:, 1:], 0.0)
    left -= left.mean(0)
    power = (np.abs(np.fft.rfft(left * np.hanning(len(track))[:, None], axis=0)) ** 2 / np.maximum(left.var(0), 1e-30)).sum(1)
    frequency = np.fft.rfftfreq(len(track), track.h)
    swift = frequency > 1.0 / (SLOW * float(model.ship.scale("time")))
    if not swift.any() or power[swift].sum() < WORKING * power[~swift].sum():
        return 0
    return round(power[swift].sum() / float(power[swift] @ frequency[swift]) / track.h)


def _left_over(track: Track, model: Model) -> np.ndarray:
    """(N, 3) acceleration along the path that the model does not explain [m/s2, m/s2, rad/s2]."""
    return np.gradient(track.state[:, 3:6], track.h, axis=0) - respond(track, model)[0]


def _mean(values: np.ndarray, steps: int) -> np.ndarray:
    """Mean over the `steps` about each point; fewer at the ends."""
    window = np.ones(steps)
    return np.convolve(values, window, "same") / np.convolve(np.ones(values.size), window, "same")


def _scatter(mean: np.ndarray, before: np.ndarray) -> np.ndarray:
    """(8,) scatter of the averaged readings from one to the next; where there are none, as it was."""
    out = before.copy()
    for j, column in enumerate(mean.T):
        seen = column[np.isfinite(column)]
        if seen.size > 8:
            out[j] = max(1.4826 * float(np.median(np.abs(np.diff(seen)))) / np.sqrt(2.0), 1e-9)
    return out
