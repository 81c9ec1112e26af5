"""Many windows of a track, each predicted from its start, beside what was measured at their ends."""

from dataclasses import dataclass, replace

import numpy as np

from twin.physics.ship import Ship
from twin.study.reference.structure import once_off
from twin.study.track.track import READINGS, Track

MODEL, SENSORS, STRUCTURE = range(3)  # the three runs of each window


@dataclass(frozen=True)
class Windows:
    """One track's predictions: W windows, looked at K steps ahead."""

    track: Track
    start: np.ndarray  # (W,) grid step at which each begins
    lead: np.ndarray  # (K,) grid steps ahead
    # (3, K, W, 8) readings; of the noise only the difference to the model's has a meaning
    promised: np.ndarray
    valid: np.ndarray  # (K, W) controls known all the way, and the position measured at both ends
    seen: np.ndarray  # (N, 8) what was measured, with short holes bridged (see start.py)

    @property
    def step(self) -> np.ndarray:
        """(K, W) grid step of each promise (kept inside the track: see `valid`)."""
        return np.minimum(self.start + self.lead[:, None], len(self.track) - 1)

    def at(self, horizon_s: float) -> int:
        """The row of a horizon."""
        return int(np.argmin(np.abs(self.lead * self.track.h - horizon_s)))

    def off(self, run: int = MODEL) -> np.ndarray:
        """(K, W, 8) in SI, promise minus measurement of the model; of noise, what it alone makes of
        it. NaN where not valid."""
        against = self.seen[self.step] if run == MODEL else self.promised[MODEL]
        off = self.promised[run] - against
        off[..., 2] = (off[..., 2] + np.pi) % (2.0 * np.pi) - np.pi
        return np.where(self.valid[..., None], off, np.nan)

    def errors(self, run: int = MODEL) -> dict[str, np.ndarray]:
        """(K, W) sizes: `position` [m], `lateral` (across the heading at the start) [m] and `heading`
        [rad]."""
        off, psi = self.off(run), self.track.state[self.start, 2]
        return {
            "position": np.hypot(off[..., 0], off[..., 1]),
            "lateral": np.abs(off[..., 1] * np.cos(psi) - off[..., 0] * np.sin(psi)),
            "heading": np.abs(off[..., 2]),
        }


def no_better(w: Windows, ship: Ship) -> Windows:
    """The same with a structural run that is no nearer than the calibrated ship was on voyages that it was
    not fitted to: what a core misses in the same way for minutes adds up to more than what wanders."""
    errors, ahead = w.errors(STRUCTURE), w.lead * w.track.h
    usual = {
        "position": once_off(ship, "position_m", ahead),
        "heading": np.radians(once_off(ship, "heading_deg", ahead)),
    }
    means = {
        n: np.nanmean(np.where(np.any(w.valid, axis=1, keepdims=True), errors[n], 1.0), 1) for n in usual
    }
    place, turn = (
        np.maximum(1.0, usual[n] / np.maximum(means[n], 1e-12))[:, None] for n in ("position", "heading")
    )
    promised = w.promised.copy()
    for i, name in enumerate(READINGS):
        promised[STRUCTURE, ..., i] += ((turn if name in ("psi", "r") else place) - 1.0) * (
            promised[STRUCTURE] - promised[MODEL]
        )[..., i]
    return replace(w, promised=promised)
