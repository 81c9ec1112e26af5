"""How often the ship meets the waves, where they show best: in what the rate of turn, or the heading, was
measured beside the smooth path.

The smooth path follows a wave in part only where the wave is swift for it, and what is left of it there is
slower than the waves. The readings have them whole, and with them their own noise, which has no period: so
the spectrum of the readings less the path (mean of pieces that overlap by half, Welch 1967) is flat but for
the waves. A peak that white noise makes as likely as waves do is none (Whittle 1953)."""

from dataclasses import dataclass

import numpy as np

from twin.study.track.track import READINGS, STATE, Track
from twin.study.track.waves import DAMPING, RESONANCE_OFFSET

YAW = {"r": 1, "psi": 2}  # derivatives that lead from each reading of yaw to its acceleration
AXES = ("u", "v")  # whose velocities over ground swing with it
SAMPLES_A_PERIOD = 4  # no fewer


def met(track: Track, slowest_s: float, piece_s: float, likelier: float) -> list[np.ndarray]:
    """Of each reading of yaw that has a peak in its spectrum, over pieces so long and swifter than
    `slowest_s` [s], by so much log likelihood above the noise: (N, 6) waves of one frequency as in
    `Track.swell`, that swing the ship in yaw alone, and as the readings show them in surge and sway, too."""
    out = []
    for name in YAW:
        spectrum = Spectrum.of(track, name, piece_s, slowest_s)
        if spectrum is None or (at := spectrum.peak(likelier)) is None:
            continue
        omega = 2.0 * np.pi * at
        yaw = omega ** YAW[name] * spectrum.swing(at)
        others = (Spectrum.of(track, axis, piece_s, slowest_s) for axis in AXES)
        surge, sway = (omega * x.swing(at) if x else 0.0 for x in others)
        sizes = [(0.0, 0.0, yaw), (surge, sway, yaw)][: 1 + (surge + sway > 0.0)]
        out += [np.tile([omega, omega, omega, *size], (len(track), 1)) for size in sizes]
    return out


def one_frequency(track: Track) -> bool:
    """Whether its waves are of one frequency, as the readings of yaw showed it."""
    return track.swell is not None and not np.ptp(track.swell[:, :3])


@dataclass(frozen=True)
class Spectrum:
    """Power density of a reading less the path, over frequencies [Hz] swifter than it manoeuvres, both (F,);
    of how many pieces, and of the noise beside the waves."""

    frequency: np.ndarray
    density: np.ndarray
    pieces: float
    noise: float

    @classmethod
    def of(cls, track: Track, name: str, piece_s: float, slowest_s: float) -> "Spectrum | None":
        """None where there are not two pieces of it, or too few samples for waves."""
        values = track.measured[:, READINGS.index(name)] - track.state[:, STATE.index(name)]
        there = np.flatnonzero(np.isfinite(values))
        steps = int(np.median(np.diff(there))) if there.size > 1 else 0
        piece = round(piece_s / (max(steps, 1) * track.h))
        if steps == 0 or there.size < 2 * piece or piece < 2 * SAMPLES_A_PERIOD:
            return None
        from scipy.signal import welch  # heavy, and only the study asks for it

        even = np.interp(np.arange(there[0], there[-1] + 1, steps), there, values[there])
        frequency, density = welch(even, 1.0 / (steps * track.h), nperseg=piece)
        swift = frequency > 1.0 / slowest_s
        waves = swift & (frequency <= 2.0 * frequency[-1] / SAMPLES_A_PERIOD)
        if np.count_nonzero(waves) < 3:
            return None
        return cls(frequency[waves], density[waves], even.size / piece, float(np.median(density[swift])))

    def peak(self, likelier: float) -> float | None:
        """Where it swings most [Hz]; None where it rises on beyond, where there is no noise to hold it
        against, or where white noise makes such a peak nearly as likely as waves do."""
        top = int(np.argmax(self.density))
        if top in (0, self.density.size - 1) or not self.noise > 0.0:
            return None
        above = self.density[self._near(self.frequency[top])] / self.noise
        gain = self.pieces * float(np.sum(above - 1.0 - np.log(above)))
        return float(self.frequency[top]) if gain >= likelier and above.mean() > 1.0 else None

    def swing(self, at: float) -> float:
        """Standard deviation of what it swings there, beyond the noise."""
        beyond = float(np.sum(self.density[self._near(at)] - self.noise))
        return float(np.sqrt(max(0.0, beyond) * (self.frequency[1] - self.frequency[0])))

    def _near(self, at: float) -> np.ndarray:
        return np.abs(self.frequency / at - 1.0) <= DAMPING + RESONANCE_OFFSET
