"""What may be wrong with instruments: one table of numbers, each with its unit, prior, effect of the
catalogue and what would show it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from twin.physics.effects import catalogue


@dataclass(frozen=True)
class InstrumentUnknown:
    """One number. `sd`: prior width about none, in units of a scale of the voyage (`of`); `late`: it cannot
    be below zero; `varies`: the share of `sd` by which what one voyage says of it is off beside what its
    readings leave open, as on random ships: streams turn, a wind carries aside, a sea rolls."""

    name: str
    fault: str  # the group that is named together
    unit: str
    sd: float
    of: str  # "one", "speed" [m/s], "length" [m] or "time" [s] of this voyage
    meaning: str
    late: bool = False
    varies: float = 0.0


@dataclass(frozen=True)
class InstrumentFault:
    """A group of numbers that is one mistake (`effect_of`: its name in the catalogue). `turn`: the manoeuvre
    that shows it best."""

    words: str
    turn: str
    odds: float = 0.1


ODDS_LATE = 0.5  # odds that an instrument is late by something: most are by a little
CIRCLES = "a full circle to each side"
FAULTS: Mapping[str, InstrumentFault] = {
    "gnss_delay": InstrumentFault("position and velocity late", "turns to both sides", ODDS_LATE),
    "smoothing": InstrumentFault("course and speed over ground smoothed", "turns to both sides"),
    "heading_delay": InstrumentFault(
        "heading late", "turns to both sides, with rate of turn recorded", ODDS_LATE
    ),
    "rate_delay": InstrumentFault("rate of turn late", "turns to both sides", ODDS_LATE),
    "log_delay": InstrumentFault("speed log late", "changes of speed", ODDS_LATE),
    "heading_bias": InstrumentFault("compass bias (variation and alignment)", CIRCLES),
    "deviation": InstrumentFault("compass deviation curve", CIRCLES),
    "gyro_bias": InstrumentFault("rate gyro bias", "any voyage with heading and rate of turn"),
    "gyro_scale": InstrumentFault("rate gyro scale", "turns, with heading and rate of turn recorded"),
    "log_scale": InstrumentFault("speed log scale", "reciprocal courses or a circle"),
    "log_bias": InstrumentFault("speed log bias", "reciprocal courses at two speeds"),
    "log_angle": InstrumentFault("speed log askew", CIRCLES),
    "antenna": InstrumentFault("antenna's place", CIRCLES + ", with a log of two axes"),
    "mast": InstrumentFault("antenna's height", "rolling in a sea"),
    "vane": InstrumentFault("wind vane offset", CIRCLES),
    "anemometer": InstrumentFault("wind speed scale", "reciprocal courses in a steady wind"),
    "leeway": InstrumentFault("leeway by the wind", CIRCLES + " in wind"),
    "current": InstrumentFault("stream", CIRCLES),
    "drift": InstrumentFault("drift of a turning ship", "turns"),
}
ALWAYS = ("current", "drift")  # never left out: every voyage has a stream, and every ship drifts in a turn

UNKNOWNS: tuple[InstrumentUnknown, ...] = (
    InstrumentUnknown(
        "gnss_delay", "gnss_delay", "s", 1.0, "one", "age of position and velocity", late=True, varies=0.2
    ),
    InstrumentUnknown(
        "smoothing",
        "smoothing",
        "s",
        2.0,
        "one",
        "time constant of the smoothing of course and speed over ground",
        late=True,
        varies=0.12,
    ),
    InstrumentUnknown(
        "heading_delay", "heading_delay", "s", 1.0, "one", "age of the heading", late=True, varies=0.4
    ),
    InstrumentUnknown(
        "rate_delay", "rate_delay", "s", 1.0, "one", "age of the rate of turn", late=True, varies=0.28
    ),
    InstrumentUnknown(
        "log_delay", "log_delay", "s", 1.0, "one", "age of the speed through water", late=True, varies=0.48
    ),
    InstrumentUnknown(
        "A",
        "heading_bias",
        "rad",
        0.2,
        "one",
        "shown heading less the true one, on all headings",
        varies=0.003,
    ),
    InstrumentUnknown(
        "B", "deviation", "rad", 0.05, "one", "deviation with the sine of the heading", varies=0.05
    ),
    InstrumentUnknown(
        "C", "deviation", "rad", 0.05, "one", "deviation with the cosine of the heading", varies=0.05
    ),
    InstrumentUnknown(
        "D", "deviation", "rad", 0.03, "one", "deviation with the sine of twice the heading", varies=0.05
    ),
    InstrumentUnknown(
        "E", "deviation", "rad", 0.03, "one", "deviation with the cosine of twice the heading", varies=0.055
    ),
    InstrumentUnknown(
        "gyro_bias", "gyro_bias", "rad/s", 0.002, "one", "shown rate of turn less the true one"
    ),
    InstrumentUnknown(
        "gyro_scale",
        "gyro_scale",
        "-",
        0.1,
        "one",
        "shown rate of turn over the true one, less 1",
        varies=0.055,
    ),
    InstrumentUnknown(
        "log_scale",
        "log_scale",
        "-",
        0.2,
        "one",
        "shown speed through water over the true one, less 1",
        varies=0.25,
    ),
    InstrumentUnknown(
        "log_bias",
        "log_bias",
        "m/s",
        0.1,
        "speed",
        "shown speed through water less the true one",
        varies=0.55,
    ),
    InstrumentUnknown(
        "log_angle",
        "log_angle",
        "rad",
        0.1,
        "one",
        "how far the log's axis points to starboard",
        varies=0.035,
    ),
    InstrumentUnknown(
        "antenna_ahead",
        "antenna",
        "m",
        0.3,
        "length",
        "antenna ahead of the log, or of where the settings have it",
        varies=0.125,
    ),
    InstrumentUnknown(
        "antenna_starboard",
        "antenna",
        "m",
        0.1,
        "length",
        "antenna to starboard of where the settings have it",
        varies=0.06,
    ),
    InstrumentUnknown(
        "antenna_above", "mast", "m", 0.2, "length", "antenna above the axis of roll", varies=0.35
    ),
    InstrumentUnknown("vane", "vane", "rad", 0.1, "one", "shown wind angle less the true one", varies=0.16),
    InstrumentUnknown(
        "wind_scale", "anemometer", "-", 0.2, "one", "shown wind speed over the true one, less 1", varies=0.07
    ),
    InstrumentUnknown(
        "leeway",
        "leeway",
        "-",
        0.01,
        "one",
        "leeway speed x ship's speed / (wind speed x its part from abeam)",
    ),
    InstrumentUnknown(
        "current_north", "current", "m/s", 0.2, "speed", "stream toward north in the middle of the voyage"
    ),
    InstrumentUnknown(
        "current_east", "current", "m/s", 0.2, "speed", "stream toward east in the middle of the voyage"
    ),
    InstrumentUnknown("drift_r", "drift", "m", 0.5, "length", "speed aside for a rate of turn"),
    InstrumentUnknown("drift_rr", "drift", "m s", 0.2, "length time", "the same, for one that grows"),
    InstrumentUnknown("drift_r_r", "drift", "m", 0.3, "length", "the same, more of it in a hard turn"),
    InstrumentUnknown("drift_late", "drift", "s", 0.5, "time", "the same, later than the turn"),
)
# correlation of what varies: how much a log shows is well known, and which of the two it is is not
TOGETHER: Mapping[tuple[str, str], float] = {("log_scale", "log_bias"): -0.985}
INDEX: Mapping[str, int] = {u.name: i for i, u in enumerate(UNKNOWNS)}
OWN = ("current_north", "current_east")  # of each voyage; the rest is the ship's


def members(fault: str) -> list[int]:
    """Rows of UNKNOWNS of one fault."""
    return [i for i, u in enumerate(UNKNOWNS) if u.fault == fault]


def effect_of(fault: str) -> str | None:
    """The effect of the catalogue that holds numbers of this fault (`by_readings`); None: none does."""
    own = {UNKNOWNS[i].name for i in members(fault)}
    return next((name for name, e in catalogue().items() if own & set(e.by_readings)), None)


def day_to_day() -> np.ndarray:
    """(P, P) covariance of what varies, in prior widths."""
    sd = np.array([u.varies for u in UNKNOWNS])
    out = np.diag(sd**2)
    for (a, b), share in TOGETHER.items():
        i, j = INDEX[a], INDEX[b]
        out[i, j] = out[j, i] = share * sd[i] * sd[j]
    return out


def widths(speed: float, length: float, time: float) -> np.ndarray:
    """(P,) prior widths in the numbers' own units on a voyage of this speed [m/s], length [m] and time of
    motion [s]."""
    scale = {"one": 1.0, "speed": speed, "length": length, "time": time, "length time": length * time}
    return np.array([u.sd * scale[u.of] for u in UNKNOWNS])
