"""What each instrument said and when: samples at their own times, from a voyage or from a track on its
grid."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from twin.errors import DataError
from twin.recording.voyage import Voyage
from twin.study.track.track import READINGS, Track

LEAST_INSTRUMENT_SAMPLES = 30  # samples of an instrument that can tell anything
OWN = {"body": True, "course": False, "earth": False}  # by the frame in which the velocity was recorded
PER_MOTION = 20  # samples kept in the time in which the ship's turning changes; more say nothing more of it


@dataclass(frozen=True)
class ReadingSamples:
    """One instrument: times (n,) [s] and values (n, d) in SI units."""

    t: np.ndarray
    y: np.ndarray

    def thinned(self, width: float) -> "ReadingSamples":
        """Means over so many seconds, at the mean of their times."""
        cell = np.floor((self.t - self.t[0]) / width).astype(int)
        first = np.flatnonzero(np.r_[True, np.diff(cell) != 0])
        count = np.diff(np.r_[first, self.t.size])
        if (count == 1).all():
            return self
        return ReadingSamples(
            np.add.reduceat(self.t, first) / count, np.add.reduceat(self.y, first, axis=0) / count[:, None]
        )


@dataclass(frozen=True, eq=False)
class Readings:
    """One voyage; equal only to itself. `by`: place (N, E), velocity (north, east, or ahead and to starboard
    where `own`), heading, rate, log, wind (from, in the ship's axes), roll. `own`: whether the receiver
    turned its velocity by an attitude of its own; None: nobody said."""

    name: str
    by: Mapping[str, ReadingSamples]
    own: bool | None
    speed: float  # usual speed [m/s]
    time: float  # in which the rate of turn changes [s]

    @property
    def length(self) -> float:
        """How long a ship that turns so hard may be [m]: half the radius of its hard turns (r L/U is 0.5 in
        one)."""
        s = self.by["heading"].thinned(0.5 * self.time)
        rate = float(np.percentile(np.abs(np.diff(s.y[:, 0]) / np.diff(s.t)), 95.0)) if s.t.size > 2 else 0.0
        return 0.5 * self.speed / max(rate, 1e-4)

    @property
    def span(self) -> tuple[float, float]:
        """The times of the first and of the last heading [s]."""
        t = self.by["heading"].t
        return float(t[0]), float(t[-1])


def of_voyage(voyage: Voyage) -> Readings:
    """The readings of a voyage; what was derived when it was read is no reading. DataError when heading or
    place and velocity lack."""
    derived = voyage.meta.get("derived", {})

    def samples(*channels: str) -> ReadingSamples | None:
        if any(c in derived or not voyage.has(c) for c in channels):
            return None
        y = np.column_stack([voyage.si(c) for c in channels])
        ok = np.isfinite(y).all(axis=1)
        return ReadingSamples(voyage.time_s[ok], y[ok]) if ok.sum() >= LEAST_INSTRUMENT_SAMPLES else None

    body = samples("surge_velocity_mps", "sway_velocity_mps", "heading_true_north_deg")
    return _readings(
        voyage.name,
        {
            "place": samples("north_m", "east_m"),
            "body": body,
            "velocity": samples("surge_velocity_mps", "sway_velocity_mps"),
            "heading": samples("heading_true_north_deg"),
            "rate": samples("yaw_rate_degps"),
            "log": samples("surge_velocity_through_water_mps"),
            "log aside": samples("sway_velocity_through_water_mps"),
            "air": samples("apparent_wind_speed_mps", "apparent_wind_angle_deg"),
            "roll": samples("roll_deg"),
        },
        OWN.get(voyage.meta.get("velocity_frame", "")) if body is not None else None,
    )


def of_track(track: Track) -> Readings:
    """The readings of a track, on its grid."""
    column = dict(zip(READINGS, track.measured.T, strict=True))

    def samples(*names: str) -> ReadingSamples | None:
        y = np.column_stack([column[n] for n in names])
        ok = np.isfinite(y).all(axis=1)
        return ReadingSamples(track.t[ok], y[ok]) if ok.sum() >= LEAST_INSTRUMENT_SAMPLES else None

    roll = (
        ReadingSamples(track.t, np.asarray(track.weather["phi"])[:, None]) if "phi" in track.weather else None
    )
    found = {
        "place": samples("x", "y"),
        "body": samples("u", "v", "psi"),
        "velocity": samples("u", "v"),
        "heading": samples("psi"),
        "roll": roll,
        "rate": samples("r"),
        "log": samples("u_r"),
        "log aside": samples("v_r"),
        "air": None,
    }
    return _readings(track.name, found)


def _readings(name: str, found: Mapping[str, ReadingSamples | None], own: bool | None = None) -> Readings:
    """What was read while the heading was: the path is as long as that, and where it ended nothing can be
    compared."""
    by = {k: s for k, s in found.items() if s is not None}
    if "heading" in by:
        by = _while_read(by["heading"], by)
    if "heading" not in by or ("place" not in by and "velocity" not in by):
        raise DataError(
            f"{name}: nothing can be compared without {LEAST_INSTRUMENT_SAMPLES} samples of the heading "
            "and as many, while it was read, of the position or of the velocity over ground. Record them "
            "(longer, or more often), or say in a map which columns they are."
        )
    time = _time(by["heading"])
    body = by.pop("body", None)
    speed = _speed(by, time)
    if "air" in by:
        air = by.pop("air")
        by["wind"] = ReadingSamples(
            air.t, air.y[:, :1] * np.column_stack([np.cos(air.y[:, 1]), np.sin(air.y[:, 1])])
        )
    if "velocity" in by:
        by["heading at velocity"] = ReadingSamples(
            by["velocity"].t, np.interp(by["velocity"].t, by["heading"].t, by["heading"].y[:, 0])[:, None]
        )
        if body is not None and body.t.size > 0.8 * by["velocity"].t.size:
            by["velocity"], by["heading at velocity"] = (
                ReadingSamples(body.t, body.y[:, :2]),
                ReadingSamples(body.t, body.y[:, 2:]),
            )
    return Readings(name, by, own, speed, time)


def _while_read(heading: ReadingSamples, by: Mapping[str, ReadingSamples]) -> dict[str, ReadingSamples]:
    """The instruments between the first and the last reading of the heading; none with too few samples
    there."""
    cropped = {}
    for kind, s in by.items():
        there = (s.t >= heading.t[0]) & (s.t <= heading.t[-1])
        if there.sum() >= LEAST_INSTRUMENT_SAMPLES:
            cropped[kind] = ReadingSamples(s.t[there], s.y[there])
    return cropped


def _time(heading: ReadingSamples) -> float:
    """The time in which the rate of turn changes: its size over that of its slope, both smoothed alike
    [s]."""
    t = np.arange(heading.t[0], heading.t[-1], max(float(np.median(np.diff(heading.t))), 1e-3))
    psi = np.interp(t, heading.t, heading.y[:, 0])
    noise = _scatter(heading.y[:, 0])
    h, time = float(t[1] - t[0]), 0.0
    for width in np.geomspace(4.0, max(t.size / 16.0, 5.0), 12):
        kernel = np.hanning(int(width) + 3)
        smooth = np.convolve(psi - psi[0], kernel / kernel.sum(), "valid")
        rate, slope = np.diff(smooth) / h, np.diff(smooth, 2) / h**2
        time = float(np.std(rate)) / max(float(np.std(slope)), 1e-12)
        if np.std(slope) > 100.0 * noise / (width * h) ** 2:
            break
    return float(np.clip(time, 3.0 * h, float(np.ptp(t)) / 20.0 + 3.0 * h))


def _scatter(y: np.ndarray) -> float:
    """White scatter, from third differences."""
    return 1.4826 * float(np.median(np.abs(np.diff(y, 3)))) / np.sqrt(20.0) if y.size > 3 else 0.0


def _speed(by: Mapping[str, ReadingSamples], time: float) -> float:
    """Usual speed [m/s]: by velocity, else from mean place to mean place, as long as the ship turns alike
    (`time` [s]), lest the place's noise be sailed too."""
    if "velocity" in by:
        return max(float(np.median(np.hypot(*by["velocity"].y.T))), 1e-3)
    p = by["place"].thinned(0.5 * time)
    p = p if p.t.size > 2 else by["place"]
    sailed = float(np.hypot(*np.diff(p.y, axis=0).T).sum())
    return max(sailed / float(np.ptp(p.t)), 1e-3)
