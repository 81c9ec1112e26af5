"""How far a healthy ship's open-loop predictions usually end from what was measured: a probability density of
the error.

The error of a window (promise minus reading at its end) is e = (along, across, heading, u, v, r, u_r, v_r):
the place in axes along and across the heading at the start [m], the rest as it is read. On a healthy voyage,
a time tau ahead,

    e ~ t_nu(0, w^2 S(tau) (nu - 2)/nu),    S(tau) = (PRIOR S_noise + n C) / (PRIOR + n)

a multivariate t density of this scale, so that w^2 S(tau) is its covariance, with C the mean of e e' over the
reference voyages, each predicted with numbers fitted to the others (left_out.py), n its effective number of
windows, S_noise what sensors and the structural error alone would make of it, w >= 1 a widening where rudder,
speed, turning or wind leave what was sailed then, and nu the degrees of freedom by which voyages scatter
among themselves: log(size of a voyage) has variance s^2 = 1/(2 nu). Windows of one voyage are alike, for what
the core misses lasts: n of them, correlated by rho, count as n / (1 + (n - 1) rho).

The log density is a proper scoring rule: no model gains by promising more or less than it knows.

Source: Lange, Little & Taylor (1989) Robust statistical modeling using the t distribution, J. Amer. Statist.
    Assoc. 84, 881-896; effective number: Kish (1965) Survey sampling, sec. 5.4; scoring: Gneiting & Raftery
    (2007), J. Amer. Statist. Assoc. 102, 359-378.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.special import gammaln, stdtrit

from twin.physics.ship import Ship
from twin.physics.ship_notes import read_from
from twin.recording.jsonable import short
from twin.study.track.track import READINGS

CHANNELS = ("along", "across", *READINGS[2:])
# what goes on growing beyond the longest horizon
GROWS = np.array([True, True, True, False, False, False, False, False])
PRIOR = 4.0  # windows that the simulated noise counts for
SCATTER = 0.4  # of the log of a healthy voyage's error about the usual one, and
VOYAGES = 3.0  # by how many voyages this is believed before any was sailed
TAILS = (3.0, 30.0)  # degrees of freedom
ROUNDED = 1e-5  # of a variance: what a ship file's six digits leave open, so that a covariance stays one
MEANS = ("position_m", "lateral_m", "heading_rad")


@dataclass(frozen=True)
class PathError:
    """The density, by horizon; `covariance` is NaN in the rows of instruments that the reference voyages
    lacked."""

    horizons_s: np.ndarray  # (H,)
    covariance: np.ndarray  # (H, 8, 8), in SI units
    alike: np.ndarray  # (H,) correlation of windows of one voyage
    tail: float  # degrees of freedom
    # (H, 3) mean size of position [m], lateral [m] and heading [rad] error, as `twin compare` predicts
    mean: np.ndarray
    voyages: int = 0  # that were left out in turn; none: a prior
    # from where to where (envelope.py)
    sailed: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    # (H,) by how much voyages end farther off than noise and structure alone would have them, as far as the
    # windows tell (`level_of`); None: nobody asked
    level: np.ndarray | None = None

    def at(self, horizon_s: float) -> np.ndarray:
        """(8, 8) covariance so far ahead: sizes as powers of the time between horizons; beyond the last,
        place and heading grow on."""
        k, share = self._between(horizon_s)
        (sd, R), (sd_next, R_next) = (_parts(self.covariance[i]) for i in (k, k + 1 if share else k))
        sd = np.exp((1.0 - share) * np.log(sd) + share * np.log(sd_next))
        beyond = max(1.0, horizon_s / self.horizons_s[-1])
        sd = np.where(GROWS, beyond * sd, sd)
        return np.asarray(((1.0 - share) * R + share * R_next) * np.outer(sd, sd))

    def expected(self, name: str, horizon_s: Sequence[float] | np.ndarray) -> np.ndarray:
        """Mean size of the error (one of MEANS) so far ahead on a healthy voyage; in proportion to the
        time before the first horizon. (K,) for K horizons, in the unit in its name."""
        ahead = np.asarray(horizon_s, float)
        known = np.log(np.maximum(self.mean[:, MEANS.index(name)], 1e-12))
        inside = np.exp(np.interp(np.log(ahead), np.log(self.horizons_s), known))
        return (
            inside
            * np.minimum(1.0, ahead / self.horizons_s[0])
            * np.maximum(1.0, ahead / self.horizons_s[-1])
        )

    def level_at(self, horizon_s: float) -> float | None:
        """`level` so far ahead; None where nobody asked. [1]"""
        if self.level is None:
            return None
        return float(np.exp(np.interp(np.log(horizon_s), np.log(self.horizons_s), np.log(self.level))))

    @property
    def limit95(self) -> float:
        """Times the expected error that 95 % of healthy voyages stay below."""
        return float(np.exp(np.sqrt(0.5 / self.tail) * stdtrit(VOYAGES + max(self.voyages - 1, 0), 0.95)))

    def effective(self, windows: float, horizon_s: float) -> float:
        """How many independent ones so many windows of one voyage count as, that do not overlap."""
        k, share = self._between(horizon_s)
        rho = (1.0 - share) * self.alike[k] + share * self.alike[min(k + 1, len(self.alike) - 1)]
        return float(windows / (1.0 + max(windows - 1.0, 0.0) * rho))

    def log_density(self, error: np.ndarray, horizon_s: float, width: np.ndarray | float = 1.0) -> np.ndarray:
        """(W,) of windows' errors (W, 8), of what was read of each; `width` (W,): how much wider than usual.
        NaN where nothing was read."""
        width, covariance = np.broadcast_to(width, len(error)), self.at(horizon_s)
        known = np.isfinite(np.diag(covariance))
        out = np.full(len(error), np.nan)
        read = np.isfinite(error) & known
        for pattern in np.unique(read[read.any(1)], axis=0):
            rows = np.flatnonzero((read == pattern).all(1))
            S = covariance[np.ix_(pattern, pattern)] * (self.tail - 2.0) / self.tail
            out[rows] = _log_t(error[np.ix_(rows, np.flatnonzero(pattern))] / width[rows, None], S, self.tail)
            out[rows] -= pattern.sum() * np.log(width[rows])
        return out

    def filled(self, other: "PathError") -> "PathError":
        """The same, with another's numbers for the instruments that were not read when this one was
        learned."""
        made = []
        for horizon, own in zip(self.horizons_s, self.covariance, strict=True):
            theirs, lacks = other.at(float(horizon)), ~np.isfinite(np.diag(own))
            made.append(np.where(lacks[:, None] & lacks, theirs, np.where(lacks[:, None] | lacks, 0.0, own)))
        return replace(self, covariance=np.array(made))

    def _between(self, horizon_s: float) -> tuple[int, float]:
        """The horizon before, and how far on the way to the next (in the logarithm)."""
        logs, at = np.log(self.horizons_s), float(np.log(horizon_s))
        if at <= logs[0] or len(logs) == 1:
            return 0, 0.0
        k = int(np.searchsorted(logs, at)) - 1
        return (
            (len(logs) - 1, 0.0)
            if k >= len(logs) - 1
            else (k, float((at - logs[k]) / (logs[k + 1] - logs[k])))
        )

    def entry(self) -> dict[str, Any]:
        """What the ship file keeps."""
        read = np.flatnonzero(np.isfinite(np.diag(self.covariance[0])))
        return {
            "horizons_s": self.horizons_s.tolist(),
            "channels": [CHANNELS[i] for i in read],
            "alike": self.alike.tolist(),
            "tail": self.tail,
            "covariance": [short(S[np.ix_(read, read)].tolist()) for S in self.covariance],
            "mean": {name: self.mean[:, i].tolist() for i, name in enumerate(MEANS)},
            "voyages": self.voyages,
            "sailed": {name: list(ends) for name, ends in self.sailed.items()},
        } | ({} if self.level is None else {"level": self.level.tolist()})


def of_ship(ship: Ship) -> PathError | None:
    """What the ship's calibration measured; None where it measured nothing of the kind. SettingsError: its
    file does not hold it as it was written."""
    table = ship.notes.get("structural", {}).get("path_error")
    if not table:
        return None
    with read_from(ship, "[structural] path_error"):
        read, told = (
            [CHANNELS.index(name) for name in table["channels"]],
            np.array(table["covariance"], float),
        )
        covariance = np.full((len(told), 8, 8), np.nan)
        covariance[np.ix_(range(len(told)), read, read)] = told
        found = PathError(
            np.array(table["horizons_s"], float),
            covariance,
            np.array(table["alike"], float),
            float(table["tail"]),
            np.column_stack([np.array(table["mean"][name], float) for name in MEANS]),
            int(table["voyages"]),
            {name: (float(low), float(high)) for name, (low, high) in table["sailed"].items()},
            np.array(table["level"], float) if "level" in table else None,
        )
        level = [] if found.level is None else [found.level]
        shapes = {len(of) for of in (covariance, found.alike, found.mean, *level)}
        if shapes != {found.horizons_s.size} or not found.horizons_s.size:
            raise ValueError("its tables differ in length")
    return found


def level_of(measured_m: float, simulated_m: float, windows: float) -> float:
    """By how much voyages end farther off than simulated, as so many independent windows tell it beside the
    simulation, which counts for PRIOR of them. [1]"""
    share = windows / (windows + PRIOR)
    return float((max(measured_m, 1e-9) / max(simulated_m, 1e-9)) ** share)


def tail(sizes: Sequence[float]) -> float:
    """Degrees of freedom, from the size of each voyage's error over the usual size: s^2 = 1/(2 nu), the
    prior's SCATTER among them."""
    logs = np.log(np.asarray(sizes, float))
    square = float(((logs - logs.mean()) ** 2).sum()) if logs.size > 1 else 0.0
    s2 = (VOYAGES * SCATTER**2 + square) / (VOYAGES + max(logs.size - 1, 0))
    return float(np.clip(0.5 / s2, *TAILS))


def _parts(covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Standard deviations (8,) and correlations (8, 8); NaN where there are none."""
    sd = np.sqrt(np.diag(covariance))
    return sd, covariance / np.outer(sd, sd)


def _log_t(error: np.ndarray, S: np.ndarray, nu: float) -> np.ndarray:
    """(W,) of the multivariate t density with scale S."""
    d, sd = len(S), np.sqrt(np.diag(S))
    L = sd[:, None] * np.linalg.cholesky(S / np.outer(sd, sd) + ROUNDED * np.eye(d))
    square = np.square(np.linalg.solve(L, error.T)).sum(0)
    norm = (
        gammaln(0.5 * (nu + d)) - gammaln(0.5 * nu) - 0.5 * d * np.log(nu * np.pi) - np.log(np.diag(L)).sum()
    )
    return np.asarray(norm - 0.5 * (nu + d) * np.log1p(square / nu))
