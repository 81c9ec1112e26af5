"""A track: a voyage on an even grid in SI units, with the smooth motion underneath its measurements.

The smooth motion is kinematics alone (no ship model): the path of least jerk, in units of the ship's own time
L/U_0, that agrees with the measured positions, headings and rates. The study linearises along it; it is never
shown as a prediction."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.live.signals.channels import BY_NAME, of_actuators
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import WEATHER, Situation
from twin.recording.holes import HOLE_S, inside, longest, pieces
from twin.recording.unknown_controls import CONTROLS, known, of_ship
from twin.recording.voyage import Voyage
from twin.study.track.motion_channels import MEASURED, READINGS
from twin.study.track.outliers import Jump, outliers, stretches_of
from twin.study.track.sample_waits import hold_s_of, shortest_wait_s
from twin.study.track.smooth_motion import running_mean, smooth_motion

PLACE = ("north_m", "east_m")
WEATHER_CHANNELS = (  # name in Situation, channel, what turns "from" into "to"
    ("depth", "water_depth_m", 0.0),
    ("H_s", "wave_height_significant_m", 0.0),
    ("T_p", "wave_period_peak_s", 0.0),
    ("wave_to", "wave_direction_deg", np.pi),
    ("draught", "draught_mean_m", 0.0),
    ("phi", "roll_deg", 0.0),
    ("bank_port", "bank_distance_port_m", 0.0),
    ("bank_starboard", "bank_distance_starboard_m", 0.0),
)
TRUE_WIND = ("true_wind_speed_mps", "true_wind_direction_deg")
APPARENT_WIND = ("apparent_wind_speed_mps", "apparent_wind_angle_deg")
GRIDDED = (  # what is put on the grid whole: weather
    *(channel for _, channel, _ in WEATHER_CHANNELS),
    *TRUE_WIND,
    *APPARENT_WIND,
)
STATE = ("x", "y", "psi", "u", "v", "r")
STEPS_PER_LENGTH = 32  # grid steps in the time the ship takes to sail its own length
# and no fewer, however slowly it was logged: with longer steps a ship cannot be stepped at all
FEWEST_PER_LENGTH = 8
NEVER_TOGETHER = "no control, place and heading together. Check the map, and the clocks of the instruments."
ROLLED = 0.3  # L/U_0 over which the measured heel is averaged before its rate is taken


@dataclass(frozen=True)
class Track:
    """One voyage, ready for the study; every array is (N,) on the grid `t` [s]."""

    name: str
    t: np.ndarray
    h: float
    state: np.ndarray  # (N, 6): x, y, psi, u, v, r of the smooth motion
    delta: np.ndarray
    n: np.ndarray
    weather: Mapping[str, np.ndarray]  # only what was measured, by its name in Situation
    measured: np.ndarray  # (N, 8): READINGS, NaN where there was none
    sd: np.ndarray  # (8,): scatter of each reading about the smooth motion
    whole: np.ndarray  # (N,) bool: controls and motion known, so that the model can be run through
    # (N, 6): in surge, sway, yaw how fast waves swing it [rad/s], and their accelerations (seaway.py)
    swell: np.ndarray | None = None
    # (N, 8): times its usual scatter that each reading has at that moment (ripple.py)
    ripple: np.ndarray | None = None
    # of a ship with actuators of its own what is recorded of them, `name.attribute` in SI; else None
    orders: Mapping[str, np.ndarray] | None = None
    jumps: tuple[Jump, ...] = ()  # stretches whose readings do not count (outliers.py)
    # its roll as it was, where that of `weather` is averaged over a wave (seaway.py)
    rolled: Mapping[str, np.ndarray] = field(default_factory=dict)
    # behind each steering gear
    rudder: dict[Any, Any] = field(init=False, repr=False, compare=False, default_factory=dict)

    def __len__(self) -> int:
        return self.t.size

    def situation(self, **replaced: Any) -> Situation:
        """The whole track as one Situation of arrays."""
        values = dict(zip(STATE, self.state.T, strict=True))
        return Situation(
            **(
                values
                | {"delta": self.delta, "n": self.n, "orders": self.orders, "t": self.t}
                | dict(self.weather)
                | replaced
            )
        )

    def instruments(self, s: Situation) -> Situation:
        """The same moment for what is fixed to the ship and shows it, in SI: a wave rolls that as well."""
        return replace(s, **self.rolled) if self.rolled else s

    def missing(self) -> set[str]:
        """Fields of Situation that were not measured: effects that need one are switched off."""
        unread = {
            name
            for name, column in zip(READINGS, self.measured.T, strict=True)
            if not np.isfinite(column).any()
        }
        return {name for name in WEATHER if name not in self.weather} | unread

    def part(self, first: int, last: int) -> "Track":
        """Grid steps first <= k < last."""
        return self.where(slice(first, last))

    def where(self, keep: slice | np.ndarray) -> "Track":
        """Some of the grid steps; where others are left out between them, `whole` must be False on one
        side. `keep` (N,): mask, or an index (K,)."""
        swell, ripple = (None if x is None else x[keep] for x in (self.swell, self.ripple))
        return replace(
            self,
            t=self.t[keep],
            state=self.state[keep],
            delta=self.delta[keep],
            n=self.n[keep],
            whole=self.whole[keep],
            weather={k: w[keep] for k, w in self.weather.items()},
            measured=self.measured[keep],
            swell=swell,
            ripple=ripple,
            orders=None if self.orders is None else {k: x[keep] for k, x in self.orders.items()},
            rolled={k: x[keep] for k, x in self.rolled.items()},
        )

    def steps(self) -> np.ndarray:
        """(N,) which grid steps of the whole voyage these are."""
        return np.rint(self.t / self.h).astype(int)


def track(voyage: Voyage, ship: Ship, steps_per_length: float = STEPS_PER_LENGTH) -> Track:
    """Put a voyage on the ship's own grid and find the smooth motion under it; DataError when that cannot be
    done."""
    length_s = float(ship.scale("time"))
    sample_s = shortest_wait_s(voyage, (*MEASURED.values(), *of_ship(ship)))
    h = _step(max(sample_s, length_s / steps_per_length), length_s / FEWEST_PER_LENGTH)
    if voyage.sailed_s < 3.0 * length_s:
        raise DataError(
            f"{voyage.name}: {voyage.sailed_s:.0f} s is less than three ship lengths of sailing "
            f"({3 * length_s:.0f} s): nothing can be judged from it. Record at least twenty minutes of "
            "manoeuvring."
        )
    hold_s = {name: hold_s_of(voyage, name) for name in of_ship(ship)}
    hole_s = max(HOLE_S, 3.0 * max(hold_s.values()))
    grid = _alone(voyage, *GRIDDED).on_grid(h, hole_s=hole_s)
    nothing = np.full(grid.time_s.size, np.nan)
    at = np.rint((grid.time_s - voyage.time_s[0]) / h).astype(np.int64)
    measured = np.column_stack([_samples(voyage, channel, at, h) for channel in MEASURED.values()])
    controls = {
        BY_NAME[name].attribute: _bridge(
            _alone(voyage, name).on_grid(h, hold, hole_s).si(name) if name in voyage.columns else nothing,
            hold,
            at * h,
        )
        for name, hold in hold_s.items()
    }
    whole = np.isfinite(np.array(list(controls.values()))).all(0)
    if not whole.any():
        raise DataError(f"{voyage.name}: {_no_controls(voyage, tuple(hold_s), ship.name)}")
    if not np.isfinite(measured[:, :3]).any(0).all():
        raise DataError(f"{voyage.name}: {NEVER_TOGETHER}")
    whole &= known(voyage, grid.time_s, tuple(hold_s))
    made = _made(voyage.name, grid, measured, controls, whole, ship, h)
    if not made.whole.any():
        raise DataError(f"{voyage.name}: {NEVER_TOGETHER}")
    off = outliers(made.situation(), Model.of(ship).without_inputs(made.missing())[0], h, made.whole)
    if not off.any():
        return made
    made = _made(voyage.name, grid, np.where(off, np.nan, measured), controls, whole, ship, h)
    return replace(made, jumps=stretches_of(off, made.t))


def _no_controls(voyage: Voyage, wanted: tuple[str, ...], ship: str) -> str:
    """Why nothing says what drives and steers the ship."""
    lacking = [name for name in wanted if not voyage.has(name)]
    others = [c for c in (*CONTROLS, *of_actuators(voyage.columns)) if voyage.has(c) and c not in wanted]
    if lacking and others:
        return (
            f"it has {', '.join(others)}, and what drives {ship} is {', '.join(wanted)}. Is it another "
            "ship's voyage? Else check the names in the map and in the ship file."
        )
    said = f" The voyage has no {', no '.join(lacking)}." * bool(lacking)
    return f"{' and '.join(wanted)} are never there together.{said} Check the map."


def _made(
    name: str,
    grid: Voyage,
    measured: np.ndarray,
    controls: Mapping[str, np.ndarray],
    whole: np.ndarray,
    ship: Ship,
    h: float,
) -> Track:
    """The track with the smooth motion under these readings; `whole` (N,): where the controls are known."""
    length_s = float(ship.scale("time"))
    state, sd = smooth_motion(measured, h, ship)
    weather = _weather(grid, measured, state, max(1, round(ROLLED * length_s / h)))
    nothing = np.full(grid.time_s.size, np.nan)
    orders = {k: np.nan_to_num(x) for k, x in controls.items() if k not in ("delta", "n")}
    return Track(
        name,
        grid.time_s - grid.time_s[0],
        h,
        state,
        np.nan_to_num(controls.get("delta", nothing)),
        np.nan_to_num(controls.get("n", nothing)),
        weather,
        measured,
        sd,
        whole & moved_as_read(measured, h, length_s),
        orders=orders or None,
    )


def _step(usual: float, longest: float) -> float:
    """The usual step [s], or the part of it that is short enough: samples of a slow log then fall on steps
    still."""
    return usual / int(np.ceil(usual / longest - 1e-9))


def _samples(voyage: Voyage, channel: str, steps: np.ndarray, h: float) -> np.ndarray:
    """(N,) at these multiples (N,) of h: mean of the samples that fall nearest to each grid step, moved from
    their mean time to the step along the channel's own slope; NaN where none falls: nothing is interpolated.
    A rate that was derived is no second reading of what it came from."""
    if channel in voyage.meta.get("derived", {}) and channel not in PLACE:
        return np.full(steps.size, np.nan)
    values = voyage.si(channel)
    at = (voyage.time_s - voyage.time_s[0]) / h
    ok = np.isfinite(values) & (np.rint(at) <= steps[-1])
    at, values = at[ok], values[ok]
    k = np.searchsorted(steps, np.rint(at))
    count = np.bincount(k, minlength=steps.size)
    seen = np.flatnonzero(count)
    mean, when = (np.bincount(k, x, steps.size)[seen] / count[seen] for x in (values, at))
    out = np.full(steps.size, np.nan)
    slope = np.gradient(mean, when) if seen.size > 1 else np.zeros(seen.size)
    out[seen] = mean + slope * (steps[seen] - when)
    return out


def _alone(voyage: Voyage, *names: str) -> Voyage:
    """The voyage with these channels only."""
    return voyage.with_rows(voyage.time_s, {n: voyage.columns[n] for n in names if n in voyage.columns})


def _bridge(values: np.ndarray, longest_s: float, t: np.ndarray) -> np.ndarray:
    """Hold the last value through holes of at most longest_s; `t` (N,) [s]."""
    ok = np.isfinite(values)
    last = np.maximum.accumulate(np.where(ok, np.arange(values.size), -1))
    held = np.maximum(last, 0)
    return np.where((last >= 0) & (t - t[held] <= longest_s), values[held], np.nan)


def moved_as_read(measured: np.ndarray, h: float, time: float) -> np.ndarray:
    """(N,) bool: where readings (N, 8) of place and heading are near enough to say how it moved
    (holes.py)."""
    x, y, psi, u, v, r = np.isfinite(measured[:, :6]).T
    return np.logical_and.reduce(
        [
            inside(pieces(there, longest(there, h, time)), there.size)
            for there in (x | u & v, y | u & v, psi | r)
        ]
    )


def _weather(grid: Voyage, measured: np.ndarray, state: np.ndarray, rolled: int) -> dict[str, np.ndarray]:
    """What was measured of wind, waves, depth, loading, banks and heel, under the names and directions of
    Situation; heel's rate over so many steps (`rolled`)."""
    out: dict[str, np.ndarray] = {}

    def put(name: str, channel: str, turn: float = 0.0) -> None:
        if grid.has(channel):
            out[name] = _fill(grid.si(channel)) + turn

    for name, channel, turn in WEATHER_CHANNELS:
        put(name, channel, turn)
    true, apparent = (
        int((np.isfinite(grid[a]) & np.isfinite(grid[b])).sum()) for a, b in (TRUE_WIND, APPARENT_WIND)
    )
    if true >= max(apparent, 1):
        put("wind_speed", TRUE_WIND[0])
        put("wind_to", TRUE_WIND[1], np.pi)
    elif apparent:
        speed, angle = _fill(grid.si(APPARENT_WIND[0])), _fill(grid.si(APPARENT_WIND[1])) + np.pi
        ahead, aside = speed * np.cos(angle) + state[:, 3], speed * np.sin(angle) + state[:, 4]
        out["wind_speed"], out["wind_to"] = np.hypot(ahead, aside), np.arctan2(aside, ahead) + state[:, 2]
    if "phi" in out and len(grid) > 1:
        out["p"] = np.gradient(running_mean(out["phi"], rolled), grid.time_s)
    return out


def _fill(values: np.ndarray) -> np.ndarray:
    """Holes filled along straight lines; the ends are held."""
    ok = np.isfinite(values)
    k = np.arange(values.size)
    return np.interp(k, k[ok], values[ok])
