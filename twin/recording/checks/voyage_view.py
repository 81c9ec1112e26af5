"""A voyage as the checks look at it: on an even grid, in SI, with windows that motion is summed over."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from twin.live.signals.channels import BY_NAME, of_actuators
from twin.physics.ship import Ship
from twin.recording.voyage import Voyage

MOST_ROWS = 20_000
LEAST_WAY_MPS = 0.1  # less is a mooring's swing


@dataclass(frozen=True)
class RunningSum:
    """The integral of a rate (trapezes) from the first row to each, as if what is missing were none of it;
    how many steps were missing until there, None where none is. Both (N,)."""

    total: np.ndarray
    missing: np.ndarray | None

    @classmethod
    def of(cls, rate: np.ndarray, step_s: float) -> "RunningSum":
        """`rate` (N,), with samples `step_s` apart; in the unit of the rate times s."""
        steps = (rate[1:] + rate[:-1]) / 2.0 * step_s
        there = np.isfinite(steps)
        if there.all():
            return cls(_from_none(steps), None)
        return cls(_from_none(np.where(there, steps, 0.0)), _from_none(~there))

    def over(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """(W,) the integral over each window, in its unit; NaN where a sample is missing. `first`, `last`
        (W,) index."""
        out = self.total[last] - self.total[first]
        if self.missing is not None:
            out[self.missing[last] != self.missing[first]] = np.nan
        return out


@dataclass(frozen=True)
class VoyageView:
    """A voyage and, if known, its ship."""

    voyage: Voyage
    ship: Ship | None = None

    @cached_property
    def even(self) -> Voyage:
        """The voyage on an even grid of its own step, or a coarser one when it is long, or when heading or
        place come more seldom than a line is drawn between two of them."""
        v = self.voyage
        waits = (_usual_wait_s(v, name) for name in ("heading_true_north_deg", "north_m"))
        return v.on_grid(max(v.sailed_s / max(len(v) - 1, 1), v.sailed_s / MOST_ROWS, 1e-6, *waits))

    @cached_property
    def step_s(self) -> float:
        """Step of the even grid [s]."""
        return float(self.even.time_s[1] - self.even.time_s[0]) if len(self.even) > 1 else 1.0

    def si(self, name: str) -> np.ndarray:
        """(N,) on the even grid, in SI."""
        return self.even.si(name)

    def not_recorded(self, what: str) -> str:
        """The sentence of a check of the one rudder or shaft, where there is none."""
        if of_actuators(self.voyage.columns):
            return "the vessel has actuators instead, and the check `actuators` asks how they push it."
        return f"no {what} was recorded."

    def derived(self, *names: str) -> bool:
        """True when a column was made from others, so that comparing it with them proves nothing."""
        return any(name in self.voyage.meta.get("derived", {}) for name in names)

    @cached_property
    def place(self) -> np.ndarray:
        """(N,) position as north + i east [m]."""
        return self.si("north_m") + 1j * self.si("east_m")

    @cached_property
    def velocity(self) -> np.ndarray:
        """(N,) velocity in the ship's axes, ahead + i to starboard [m/s]."""
        return self.si("surge_velocity_mps") + 1j * self.si("sway_velocity_mps")

    @cached_property
    def psi(self) -> np.ndarray:
        """(N,) true heading [rad] on the even grid, unwrapped."""
        return self.si("heading_true_north_deg")

    @cached_property
    def turned_between(self) -> float:
        """By how much the ship turns from one sample to the next [rad], by its heading and by another
        instrument alike (its rate of turn, or its course as positions have it): a tenth of the steps turn
        more. 0 where there is no other."""
        if not self.derived("yaw_rate_degps"):
            other = self.si("yaw_rate_degps") * self.step_s
        elif not self.derived("north_m"):
            other = np.diff(np.angle(np.diff(self.place)))
        else:
            return 0.0
        return min(map(_usual_turn, (np.diff(self.psi), other)))

    @cached_property
    def speed(self) -> float:
        """Usual speed [m/s]: the 75 % quantile, so that a voyage that starts at rest still has one."""
        speed = np.abs(self.velocity)
        return float(np.nanquantile(speed, 0.75)) if np.isfinite(speed).any() else 0.0

    @cached_property
    def way_on(self) -> bool:
        """Whether the ship makes way: in a minute farther than its position and its speed are uncertain."""
        w = self.velocity * np.exp(1j * self.psi)
        first, last = self.windows(min(60.0, self.voyage.duration_s / 4.0))
        made = np.abs(self.summed(w, first, last)) / max(float(np.median(last - first)) * self.step_s, 1e-9)
        made = made[np.isfinite(made)]
        scatter = rms(np.diff(w)) / np.sqrt(2.0)
        way = float(np.quantile(made, 0.75)) if made.size else 0.0
        if not self.derived("north_m", "surge_velocity_mps"):
            placed = np.abs(self.place[last] - self.place[first]) / (np.median(last - first) * self.step_s)
            placed = placed[np.isfinite(placed)]
            way = min(way, 3.0 * float(np.quantile(placed, 0.75))) if placed.size else way
        return way > max(LEAST_WAY_MPS, 0.3 * scatter)

    def windows(self, seconds: float) -> tuple[np.ndarray, np.ndarray]:
        """(first, last) rows of windows this long, each starting half a window after the one before. Both
        (W,) index."""
        length = int(np.clip(round(seconds / self.step_s), 2, max(len(self.even) - 1, 2)))
        first = np.arange(0, len(self.even) - length, max(length // 2, 1))
        return first, first + length

    def summed(self, rate: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """(W,) integral of a rate over each window (trapezes); NaN where a sample is missing. `rate` (N,);
        `first`, `last` (W,); in the unit of the rate times s."""
        return RunningSum.of(rate, self.step_s).over(first, last)


def _usual_turn(turns: np.ndarray) -> float:
    """What a tenth of these turns (N,) [rad] is beyond [rad], the shorter way round."""
    turns = turns[np.isfinite(turns)]
    return float(np.quantile(np.abs(np.angle(np.exp(1j * turns))), 0.9)) if turns.size else 0.0


def _usual_wait_s(v: Voyage, name: str) -> float:
    """The usual time between two samples of a channel [s], if that is longer than one may be old; else 0."""
    at = np.flatnonzero(np.isfinite(v[name])) if v.has(name) else np.empty(0, int)
    wait = float(np.median(np.diff(v.time_s[at]))) if at.size > 2 else 0.0
    return wait if wait > BY_NAME[name].stale_s else 0.0


def _from_none(steps: np.ndarray) -> np.ndarray:
    """(N + 1,) how much they are together before each of them and after the last."""
    total = np.cumsum(steps)
    return np.concatenate([np.zeros(1, total.dtype), total])


def fit(columns: list[np.ndarray], target: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Least squares: (coefficients, their standard errors, share of the target's energy left over).

    Real coefficients; complex columns count as two equations. Rows with a missing number are left out.
    Columns (N,), as many as C, and target (N,), in one unit times the coefficients'; returns (C,), (C,)
    and a share."""
    a = np.stack(columns, axis=1)
    keep = np.isfinite(a).all(axis=1) & np.isfinite(target)
    a, b = both_parts(a[keep]), both_parts(target[keep])
    if b.shape[0] <= a.shape[1] + 1 or not np.any(b):
        return np.full(a.shape[1], np.nan), np.full(a.shape[1], np.inf), 1.0
    x = np.linalg.lstsq(a, b, rcond=None)[0]
    rest = float(np.sum((b - a @ x) ** 2))
    covariance = np.linalg.pinv(a.T @ a) * rest / (b.shape[0] - a.shape[1])
    return x, np.sqrt(np.maximum(np.diag(covariance), 0.0)), rest / float(np.sum(b * b))


def both_parts(x: np.ndarray) -> np.ndarray:
    """Real and imaginary parts (2 N, ...) of complex rows (N, ...), one after the other; real rows as they
    are."""
    return np.concatenate([x.real, x.imag]) if np.iscomplexobj(x) else x


def rms(x: np.ndarray) -> float:
    """Root of the mean square of the samples that are there; 0 when none is. x (N,), real or complex; in
    its unit."""
    x = x[np.isfinite(x)]
    return float(np.sqrt(np.mean(np.abs(x) ** 2))) if x.size else 0.0
