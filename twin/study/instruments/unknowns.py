"""What may be wrong with instruments: one table of numbers, each with its unit, prior, effect of the
catalogue and what would show it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Unknown:
    """One number. `sd`: prior width about none, in units of a scale of the voyage (`of`); `late`: it cannot
    be below zero."""

    name: str
    fault: str  # the group that is named together
    unit: str
    sd: float
    of: str  # "one", "speed" [m/s], "length" [m] or "time" [s] of this voyage
    meaning: str
    late: bool = False


@dataclass(frozen=True)
class Fault:
    """A group of numbers that is one mistake. `effect`: its name in the catalogue; `turn`: the manoeuvre that
    shows it best;
    `by`: the instrument whose disagreement shows it."""

    effect: str | None
    words: str
    by: str
    turn: str
    odds: float = 0.1


LATE = 0.5  # odds that an instrument is late by something: most are by a little
CIRCLES = "a full circle to each side"
FAULTS: Mapping[str, Fault] = {
    "gnss_delay": Fault("SensorDelay", "position and velocity late", "position", "turns to both sides", LATE),
    "smoothing": Fault(
        "ReceiverSmoothing", "course and speed over ground smoothed", "velocity", "turns to both sides"
    ),
    "heading_delay": Fault(
        "HeadingLag", "heading late", "heading", "turns to both sides, with rate of turn recorded", LATE
    ),
    "rate_delay": Fault(None, "rate of turn late", "rate", "turns to both sides", LATE),
    "log_delay": Fault(None, "speed log late", "log", "changes of speed", LATE),
    "heading_bias": Fault("HeadingBias", "compass bias (variation and alignment)", "heading", CIRCLES),
    "deviation": Fault("CompassDeviation", "compass deviation curve", "heading", CIRCLES),
    "gyro_bias": Fault("GyroBias", "rate gyro bias", "rate", "any voyage with heading and rate of turn"),
    "log_scale": Fault("SpeedLogScale", "speed log scale", "log", "reciprocal courses or a circle"),
    "log_bias": Fault("SpeedLogBias", "speed log bias", "log", "reciprocal courses at two speeds"),
    "log_angle": Fault("SpeedLogMisalignment", "speed log askew", "log aside", CIRCLES),
    "antenna": Fault("AntennaOffset", "antenna's place", "velocity", CIRCLES + ", with a log of two axes"),
    "mast": Fault("AntennaOffset", "antenna's height", "position", "rolling in a sea"),
    "vane": Fault(None, "wind vane offset", "wind", CIRCLES),
    "anemometer": Fault(None, "wind speed scale", "wind", "reciprocal courses in a steady wind"),
    "leeway": Fault(None, "leeway by the wind", "drift", CIRCLES + " in wind"),
    "current": Fault("Current", "stream", "drift", CIRCLES),
    "drift": Fault(None, "drift of a turning ship", "drift", "turns"),
}
ALWAYS = ("current", "drift")  # never left out: every voyage has a stream, and every ship drifts in a turn

UNKNOWNS: tuple[Unknown, ...] = (
    Unknown("gnss_delay", "gnss_delay", "s", 1.0, "one", "age of position and velocity", late=True),
    Unknown(
        "smoothing",
        "smoothing",
        "s",
        2.0,
        "one",
        "time constant of the smoothing of course and speed over ground",
        late=True,
    ),
    Unknown("heading_delay", "heading_delay", "s", 1.0, "one", "age of the heading", late=True),
    Unknown("rate_delay", "rate_delay", "s", 1.0, "one", "age of the rate of turn", late=True),
    Unknown("log_delay", "log_delay", "s", 1.0, "one", "age of the speed through water", late=True),
    Unknown("A", "heading_bias", "rad", 0.2, "one", "shown heading less the true one, on all headings"),
    Unknown("B", "deviation", "rad", 0.05, "one", "deviation with the sine of the heading"),
    Unknown("C", "deviation", "rad", 0.05, "one", "deviation with the cosine of the heading"),
    Unknown("D", "deviation", "rad", 0.03, "one", "deviation with the sine of twice the heading"),
    Unknown("E", "deviation", "rad", 0.03, "one", "deviation with the cosine of twice the heading"),
    Unknown("gyro_bias", "gyro_bias", "rad/s", 0.002, "one", "shown rate of turn less the true one"),
    Unknown("log_scale", "log_scale", "-", 0.2, "one", "shown speed through water over the true one, less 1"),
    Unknown("log_bias", "log_bias", "m/s", 0.1, "speed", "shown speed through water less the true one"),
    Unknown("log_angle", "log_angle", "rad", 0.1, "one", "how far the log's axis points to starboard"),
    Unknown(
        "antenna_ahead",
        "antenna",
        "m",
        0.3,
        "length",
        "antenna ahead of the log, or of where the settings have it",
    ),
    Unknown(
        "antenna_starboard",
        "antenna",
        "m",
        0.1,
        "length",
        "antenna to starboard of where the settings have it",
    ),
    Unknown("antenna_above", "mast", "m", 0.2, "length", "antenna above the axis of roll"),
    Unknown("vane", "vane", "rad", 0.1, "one", "shown wind angle less the true one"),
    Unknown("wind_scale", "anemometer", "-", 0.2, "one", "shown wind speed over the true one, less 1"),
    Unknown(
        "leeway",
        "leeway",
        "-",
        0.01,
        "one",
        "leeway speed x ship's speed / (wind speed x its part from abeam)",
    ),
    Unknown(
        "current_north", "current", "m/s", 0.2, "speed", "stream toward north in the middle of the voyage"
    ),
    Unknown("current_east", "current", "m/s", 0.2, "speed", "stream toward east in the middle of the voyage"),
    Unknown("drift_r", "drift", "m", 0.5, "length", "speed aside for a rate of turn"),
    Unknown("drift_rr", "drift", "m s", 0.2, "length time", "the same, for one that grows"),
    Unknown("drift_r_r", "drift", "m", 0.3, "length", "the same, more of it in a hard turn"),
)
INDEX: Mapping[str, int] = {u.name: i for i, u in enumerate(UNKNOWNS)}
OWN = ("current_north", "current_east")  # of each voyage; the rest is the ship's


def members(fault: str) -> list[int]:
    """Rows of UNKNOWNS of one fault."""
    return [i for i, u in enumerate(UNKNOWNS) if u.fault == fault]


def widths(speed: float, length: float, time: float) -> np.ndarray:
    """(P,) prior widths in the numbers' own units on a voyage of this speed [m/s], length [m] and time of
    motion [s]."""
    scale = {"one": 1.0, "speed": speed, "length": length, "length time": length * time}
    return np.array([u.sd * scale[u.of] for u in UNKNOWNS])
