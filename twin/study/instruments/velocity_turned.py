"""What turned velocity over ground into the ship's axes: the compass, whose errors it then has, or an
attitude of the receiver's own.

An error e of the heading that turned it shows as  (du, dv) = e (v, -u)  in the ship's axes, and as nothing
where the receiver turned it itself. The share of the heading's noise in the velocity's is 1 or 0, by least
squares over the frequencies at which a recording holds noise alone: there the spectrum of third differences
has the shape that they give to white noise, and waves and the ship's own motion stand out of it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from twin.study.instruments.findings import FAULT_BAYES_FACTOR
from twin.study.instruments.instrument_samples import Readings

DIFFERENCES = 3  # between samples: what a ship does itself is slow
PIECE = 64  # samples of which a spectrum is made
LEAST_PIECES = 6  # without which nothing is said of a voyage
FLAT = 2.0  # a spectrum is flat up to so many times its lower quartile
LEAST_FLAT = 0.5  # share of the frequencies that must be so
JUMP = 6.0  # scatters, from which a difference is no noise
ROUGHLY = 0.2  # by how much (sd) the share may be off: headings are shown in steps, and between samples
FAR = 2.0  # standard deviations, from which a share is neither none nor all


@dataclass(frozen=True)
class TurnedShare:
    """The share of the heading's noise that the velocity has, its standard deviation (infinite: nothing is
    known), and how many voyages told it."""

    share: float
    sd: float
    voyages: int = 1

    @property
    def log_bayes_factor(self) -> float:
        """How much more probable (log) the share is if the compass turned the velocity than if the receiver
        did."""
        return (2.0 * self.share - 1.0) / (2.0 * (self.sd**2 + ROUGHLY**2))

    @property
    def tells(self) -> bool:
        """Whether none and all of it are two standard deviations apart."""
        return self.sd < 0.5

    @property
    def by(self) -> str:
        """What surely turned it, "compass" or "receiver"; "": that cannot be told, it is neither's, or one
        voyage alone says so, whose waves may be what it saw."""
        which = float(self.log_bayes_factor > 0.0)
        far = abs(self.share - which) > FAR * np.hypot(self.sd, ROUGHLY)
        if self.voyages < 2 or abs(self.log_bayes_factor) < FAULT_BAYES_FACTOR or far:
            return ""
        return "compass" if which else "receiver"


UNKNOWN = TurnedShare(0.5, np.inf, 0)


def turned_share(readings: Sequence[Readings]) -> TurnedShare:
    """Of all these voyages together: one receiver, wired once. Those without velocity, or whose noise is
    hidden by waves, say nothing."""
    told = [t for r in readings if "velocity" in r.by and np.isfinite((t := _of_one(r)).sd)]
    return _together(np.array([t.share for t in told]), np.array([t.sd for t in told])) if told else UNKNOWN


def _together(share: np.ndarray, sd: np.ndarray) -> TurnedShare:
    """The mean of the voyages' shares (V,), by how well each is known and how far they are apart (DerSimonian
    and Laird 1986): what waves make of it is another on each."""
    weight = sd**-2.0
    apart = float(weight @ (share - weight @ share / weight.sum()) ** 2) - (share.size - 1)
    between = max(apart, 0.0) / max(float(weight.sum() - (weight**2).sum() / weight.sum()), 1e-12)
    weight = 1.0 / (sd**2 + (between if share.size > 1 else 0.0))
    return TurnedShare(float(weight @ share / weight.sum()), float(weight.sum() ** -0.5), share.size)


def _of_one(r: Readings) -> TurnedShare:
    t, (u, v) = r.by["velocity"].t, r.by["velocity"].y.T
    if t.size < LEAST_PIECES * PIECE // 2:
        return UNKNOWN
    e = np.diff(np.unwrap(r.by["heading at velocity"].y[:, 0]), DIFFERENCES)
    du, dv = np.diff(u, DIFFERENCES), np.diff(v, DIFFERENCES)
    good = _without_gaps(t) & _without_jumps(e) & _without_jumps(du) & _without_jumps(dv)
    x, y = _spectra([_middle(v) * e, -_middle(u) * e], good), _spectra([du, dv], good)
    flat = _flat(x) & _flat(y)
    if len(x) < LEAST_PIECES or flat.mean() < LEAST_FLAT:
        return UNKNOWN
    x, y = x[:, :, flat], y[:, :, flat]
    power = float((np.abs(x) ** 2).sum())
    if power == 0.0:  # a heading without noise turns it as a receiver would
        return UNKNOWN
    share = float((x.conj() * y).real.sum()) / power
    pulls = (x.conj() * (y - share * x)).real.sum(axis=(1, 2))
    return TurnedShare(share, float(np.sqrt((pulls**2).sum())) / power)


def _middle(x: np.ndarray) -> np.ndarray:
    """(n,) about each difference."""
    return np.convolve(x, np.full(DIFFERENCES + 1, 1.0 / (DIFFERENCES + 1)), "valid")


def _spectra(parts: Sequence[np.ndarray], good: np.ndarray) -> np.ndarray:
    """(pieces, parts, frequencies) of these differences, in pieces that overlap by half, those that are good
    throughout; white noise is flat in it."""
    window, starts = np.hanning(PIECE), range(0, good.size - PIECE + 1, PIECE // 2)
    whole = [[p[i : i + PIECE] for p in parts] for i in starts if good[i : i + PIECE].all()]
    shape = (2.0 * np.sin(np.pi * np.arange(1, PIECE // 2 + 1) / PIECE)) ** DIFFERENCES
    return np.fft.rfft(np.reshape(whole, (-1, len(parts), PIECE)) * window)[:, :, 1:] / shape


def _flat(spectra: np.ndarray) -> np.ndarray:
    """(frequencies,) whether there is no more than noise."""
    power = (np.abs(spectra) ** 2).sum(axis=(0, 1))
    flat: np.ndarray = power <= FLAT * np.quantile(power, 0.25)
    return flat


def _without_gaps(t: np.ndarray) -> np.ndarray:
    """(n,) whether the samples of each difference follow one another."""
    step = np.diff(t)
    whole = step < 1.5 * float(np.median(step))
    return np.asarray(np.lib.stride_tricks.sliding_window_view(whole, DIFFERENCES).all(axis=1))


def _without_jumps(x: np.ndarray) -> np.ndarray:
    size = 1.4826 * float(np.median(np.abs(x)))
    return np.asarray(np.abs(x) <= (JUMP * size if size > 0.0 else np.inf), bool)
