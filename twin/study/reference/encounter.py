"""How often the ship meets the waves, where they show best: in what the rate of turn, or the heading, was
measured beside the smooth path.

The smooth path follows a wave in part only where the wave is swift for it, and what is left of it there is
slower than the waves. The readings have them whole, and with them their own noise, which has no period: so
the spectrum of the readings less the path (mean of pieces that overlap by half, Welch 1967) is flat but for
the waves. A peak that white noise makes as likely as waves do is none (Whittle 1953)."""

import numpy as np

from twin.study.track.track import READINGS, STATE, Track
from twin.study.track.waves import DAMPING, RESONANCE_OFFSET

TO_ACCELERATION = {"r": 1, "psi": 2}  # derivatives that lead from each reading of yaw to it
SAMPLES_A_PERIOD = 4  # no fewer


def met(track: Track, slowest_s: float, piece_s: float, likelier: float) -> list[np.ndarray]:
    """Of each reading of yaw that has a peak in its spectrum, over pieces so long and swifter than
    `slowest_s` [s], by so much log likelihood above the noise: (N, 6) waves of one frequency that swing the
    ship in yaw, as in `Track.swell`."""
    seen = [_peak(track, name, slowest_s, piece_s, likelier) for name in TO_ACCELERATION]
    return [
        np.tile([omega, omega, omega, 0.0, 0.0, size], (len(track), 1))
        for omega, size in (x for x in seen if x is not None)
    ]


def one_frequency(track: Track) -> bool:
    """Whether its waves are of one frequency as the readings of yaw showed it, and swing the ship in yaw
    alone."""
    return track.swell is not None and not track.swell[:, 3:5].any()


def _peak(
    track: Track, name: str, slowest_s: float, piece_s: float, likelier: float
) -> tuple[float, float] | None:
    """Frequency [rad/s] at which a reading swings most about the path, and the acceleration in yaw with
    which it does so [rad/s2]; None where its spectrum has no peak that is so much likelier than noise."""
    frequency, density, pieces = _spectrum(track, name, piece_s)
    if frequency.size == 0:
        return None
    swift = np.flatnonzero(
        (frequency > 1.0 / slowest_s) & (frequency <= 2.0 * frequency[-1] / SAMPLES_A_PERIOD)
    )
    if swift.size < 3:
        return None
    top = swift[np.argmax(density[swift])]
    if top in (swift[0], swift[-1]):  # it rises on beyond: no peak
        return None
    at, width = frequency[top], DAMPING + RESONANCE_OFFSET
    near = swift[np.abs(frequency[swift] / at - 1.0) <= width]
    beside = np.median(density[frequency > 1.0 / slowest_s])
    variance = (density[near] - beside).sum() * frequency[1]
    omega, above = 2.0 * np.pi * at, density[near] / beside
    if pieces * float(np.sum(above - 1.0 - np.log(above))) < likelier:
        return None
    return (omega, omega ** TO_ACCELERATION[name] * np.sqrt(variance)) if variance > 0.0 else None


def _spectrum(track: Track, name: str, piece_s: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Frequencies [Hz] and the power density of a reading less the path, both (F,), and of how many pieces;
    none where there are not two of them."""
    values = track.measured[:, READINGS.index(name)] - track.state[:, STATE.index(name)]
    there = np.flatnonzero(np.isfinite(values))
    steps = int(np.median(np.diff(there))) if there.size > 1 else 0
    piece = round(piece_s / (max(steps, 1) * track.h))
    if steps == 0 or there.size < 2 * piece or piece < 2 * SAMPLES_A_PERIOD:
        return np.zeros(0), np.zeros(0), 0.0
    from scipy.signal import welch  # heavy, and only the study asks for it

    even = np.interp(np.arange(there[0], there[-1] + 1, steps), there, values[there])
    return *welch(even, 1.0 / (steps * track.h), nperseg=piece), even.size / piece
