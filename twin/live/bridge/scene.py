"""One picture for the bridge, as plain words and numbers, from the twin's record of a tick.

Speeds are in knots and turns in degrees a minute, as a bridge reads them; forces keep one unit for a ship."""

from itertools import pairwise
from math import atan2, cos, degrees, hypot, radians, sin
from typing import Any, NamedTuple

from twin.live.bridge.feed import About
from twin.live.guard import HYBRID, INVALID, PHYSICS, RECKONING, STARTING
from twin.live.keelson.meanings import UNITS
from twin.live.signals.channels import CHANNELS
from twin.live.signals.readings import WORDS, Quality
from twin.physics.actuators import CHANNELS_OF
from twin.physics.maths import total

SILENT_S = 1.0  # after this the whole picture is marked as old
KNOT = 1852.0 / 3600.0  # [m/s]
SHOWN_S = (60.0, 120.0)  # horizons that are drawn, where the twin says them
OLD_AHEAD_S = 10.0  # a prediction said longer ago is shown as old
STEPS = 8  # points of the way between two horizons

Stop = tuple[float, Any, float | None]  # seconds from now, the state then, half width of the tube [m]

MODES = {
    HYBRID: ("good", "physics and learned force, on measurements"),
    PHYSICS: ("fair", "without the learned force, on measurements"),
    STARTING: ("fair", "waiting for the first measurements"),
    RECKONING: ("bad", "the model runs alone: place and motion are not measured"),
    INVALID: ("bad", "nothing shown here can be relied on"),
}
STATES = (  # name, field, unit, factor from the record's unit, decimals
    ("heading", "heading_true_north_deg", "°", 1.0, 1),
    ("rate of turn", "yaw_rate_degps", "°/min", 60.0, 1),
    ("speed ahead", "surge_velocity_mps", "kn", 1.0 / KNOT, 2),
    ("speed to starboard", "sway_velocity_mps", "kn", 1.0 / KNOT, 2),
    ("north of datum", "north_m", "m", 1.0, 1),
    ("east of datum", "east_m", "m", 1.0, 1),
)
FORCE_UNITS = ((1e6, "MN", "MN m"), (1e3, "kN", "kN m"), (1.0, "N", "N m"))


class Ahead(NamedTuple):
    """A round of predictions, the tick that said it, and when [s, of the voyage]."""

    tick: Any
    said_s: float


def scene(
    tick: Any, about: About, ahead: Ahead | None, largest: tuple[float, float], since_s: float = 0.0
) -> dict[str, Any]:
    """The picture of one tick; `largest` are the largest force [N] and moment [N m] seen so far, `since_s` is
    how long ago a twin that is silent said it: every age grows by it."""
    level, words = MODES.get(tick.mode, ("bad", "a mode that this viewer does not know"))
    return {
        "ship": about._asdict(),
        "wall_s": round(tick.wall_s, 1),
        "mode": {"name": tick.mode, "level": level, "words": words},
        "place": _place(tick.estimate),
        "states": [_state(tick, since_s, *row) for row in STATES],
        "ahead": _ahead(tick, ahead, since_s),
        "forces": _forces(tick, largest),
        "wind": _wind(tick, since_s),
        "stream": _stream(tick.estimate),
        "instruments": [row for channel in CHANNELS if (row := _instrument(tick, channel.name, since_s))],
        "actuators": [_actuator(channel, since_s) for channel in tick.actuators],
        "pace": _pace(tick),
    }


def number(message: Any, field: str, factor: float = 1.0, decimals: int = 3) -> float | None:
    """A field times `factor`, rounded; None where the record does not hold it."""
    return round(getattr(message, field) * factor, decimals) if message.HasField(field) else None


def largest_of(tick: Any, before: tuple[float, float]) -> tuple[float, float]:
    """The largest force [N] and moment [N m] so far."""
    forces = [*tick.known, tick.learned]
    return (
        max([before[0], *(abs(x) for f in forces for x in (f.X_N, f.Y_N))]),
        max([before[1], *(abs(f.N_Nm) for f in forces)]),
    )


def _place(state: Any) -> dict[str, float] | None:
    """Where the ship is and points to; None before the first estimate."""
    fields = ("north_m", "east_m", "heading_true_north_deg")
    if not all(state.HasField(field) for field in fields):
        return None
    return {name: round(getattr(state, f), 2) for name, f in zip(("n", "e", "psi"), fields, strict=True)}


def _state(
    tick: Any, since_s: float, name: str, field: str, unit: str, factor: float, decimals: int
) -> dict[str, Any]:
    parts = {"measured": tick.measured, "estimate": tick.estimate, "sigma": tick.sigma}
    said = {what: number(part, field, factor, decimals) for what, part in parts.items()}
    lost = getattr(tick.quality, field) == Quality.STALE if tick.quality.HasField(field) else False
    age = _age(tick, field, since_s)
    return {"name": name, "unit": unit, "decimals": decimals, "age": age, "lost": lost, **said}


def _ahead(tick: Any, ahead: Ahead | None, since_s: float) -> dict[str, Any] | None:
    if ahead is None:
        return None
    age_s = max(tick.time_s - ahead.said_s, 0.0) + since_s
    rounds = [p for p in ahead.tick.predictions if _place(p.state) and p.horizon_s <= max(SHOWN_S)]
    promised = max((p.tube.level for p in rounds if p.HasField("tube")), default=0.0)
    shown = [_prediction(p, ahead.tick, promised) for p in rounds if p.horizon_s in SHOWN_S]
    stops: list[Stop] = [(0.0, ahead.tick.estimate, _width(ahead.tick.sigma))]
    stops += [
        (p.horizon_s, p.state, _half_width(p, promised)) for p in sorted(rounds, key=lambda p: p.horizon_s)
    ]
    way = [point for a, b in pairwise(stops) for point in _between(a, b)]
    return {"age": round(age_s, 1), "old": age_s > OLD_AHEAD_S, "shown": shown, "way": way}


def _drawn(p: Any, promised: float) -> bool:
    """Whether its region is drawn: only those of the highest level are, and no sigma beside them, for side by
    side the smaller one would look the surer one."""
    return bool(promised and p.HasField("tube") and p.tube.level == promised)


def _prediction(p: Any, tick: Any, promised: float) -> dict[str, Any]:
    """One horizon: the place, how far off that is, and the published uncertainty."""
    north, east = p.state.north_m - tick.estimate.north_m, p.state.east_m - tick.estimate.east_m
    fields = (("sn", "north_m"), ("se", "east_m"))
    sigmas = {name: None if promised else number(p.sigma, field, 1.0, 2) for name, field in fields}
    return {
        "horizon": p.horizon_s,
        **(_place(p.state) or {}),
        **sigmas,
        "tube": _tube(p, promised),
        "distance": round(hypot(north, east), 1),
        "bearing": round(degrees(atan2(east, north)) % 360.0, 1),
        "status": p.status,
    }


def _tube(p: Any, promised: float) -> dict[str, Any] | None:
    """The region that reference voyages promise: half axes along and across the course, and how sure."""
    if not p.HasField("tube"):
        return None
    t = p.tube
    return {
        "along": round(t.along_m, 1),
        "across": round(t.across_m, 1),
        "course": round(t.course_deg, 1),
        "heading": round(t.heading_deg, 1),
        "level": round(100.0 * t.level),
        "voyages": t.voyages,
        "words": t.status,
        "drawn": _drawn(p, promised),
    }


def _between(a: Stop, b: Stop) -> list[list[float | None]]:
    """Points [north, east, half width of the tube] from one state to the next: the cubic through both places
    with both speeds over ground. No width on the way to or from a place for which none is known."""
    T = b[0] - a[0]
    (n0, e0, dn0, de0), (n1, e1, dn1, de1) = _motion(a[1]), _motion(b[1])
    w0, w1 = a[2], b[2]
    points: list[list[float | None]] = []
    for i in range(STEPS + 1):
        s = i / STEPS
        h0, h1 = (1 + 2 * s) * (1 - s) ** 2, s * s * (3 - 2 * s)
        g0, g1 = s * (1 - s) ** 2 * T, s * s * (s - 1) * T
        north = h0 * n0 + g0 * dn0 + h1 * n1 + g1 * dn1
        east = h0 * e0 + g0 * de0 + h1 * e1 + g1 * de1
        width = None if w0 is None or w1 is None else round(w0 + s * (w1 - w0), 1)
        points.append([round(north, 1), round(east, 1), width])
    return points


def _motion(state: Any) -> tuple[float, float, float, float]:
    """North, east [m] and their rates [m/s]."""
    psi = radians(state.heading_true_north_deg)
    u, v = state.surge_velocity_mps, state.sway_velocity_mps
    return (
        state.north_m,
        state.east_m,
        u * cos(psi) - v * sin(psi),
        u * sin(psi) + v * cos(psi),
    )


def _width(sigma: Any) -> float:
    return max(sigma.north_m, sigma.east_m)


def _half_width(p: Any, promised: float) -> float | None:
    """Of the tube beside the way: one sigma, or what is promised across it where anything is."""
    if not promised:
        return _width(p.sigma)
    return float(p.tube.across_m) if _drawn(p, promised) else None


def _forces(tick: Any, largest: tuple[float, float]) -> dict[str, Any]:
    unit, per_N = _unit(largest[0], 1)
    moment_unit, per_Nm = _unit(largest[1], 2)

    def row(name: str, parts: list[Any]) -> dict[str, Any]:
        sums = (total(p.X_N for p in parts), total(p.Y_N for p in parts), total(p.N_Nm for p in parts))
        X, Y, N = (round(x / per, 1) for x, per in zip(sums, (per_N, per_N, per_Nm), strict=True))
        return {"name": name, "X": X, "Y": Y, "N": N}

    return {
        "unit": unit,
        "moment_unit": moment_unit,
        "rows": [row("known", list(tick.known)), row("learned", [tick.learned])],
        "parts": [row(force.name, [force]) for force in tick.known],
        "share": round(100.0 * tick.learned.share),
    }


def _unit(largest: float, column: int) -> tuple[str, float]:
    """The unit in which the largest number has at least three digits, and how much it is."""
    found = next((row for row in FORCE_UNITS if largest >= 100.0 * row[0]), FORCE_UNITS[-1])
    return str(found[column]), float(found[0])


def _wind(tick: Any, since_s: float) -> dict[str, float] | None:
    speed = number(tick.measured, "true_wind_speed_mps", 1.0, 1)
    comes_from = number(tick.measured, "true_wind_direction_deg", 1.0, 0)
    if speed is None or comes_from is None:
        return None
    return {
        "speed": speed,
        "from": comes_from % 360.0,
        "age": _age(tick, "true_wind_speed_mps", since_s) or 0.0,
    }


def _stream(state: Any) -> dict[str, float] | None:
    if not (state.HasField("current_north_mps") and state.HasField("current_east_mps")):
        return None
    north, east = state.current_north_mps, state.current_east_mps
    return {
        "speed": round(hypot(north, east) / KNOT, 2),
        "to": round(degrees(atan2(east, north)) % 360.0) % 360,
    }


def _instrument(tick: Any, name: str, since_s: float) -> dict[str, Any] | None:
    """One channel: how old its newest sample is, and how it fares in words; None where it was never heard."""
    if not tick.quality.HasField(name) and not tick.age_s.HasField(name):
        return None
    code = getattr(tick.quality, name)
    if code in (Quality.NEVER_SEEN, Quality.NOT_GIVEN):
        return None
    return {"name": _plain(name), "age": _age(tick, name, since_s), **_fares(code)}


def _fares(code: int) -> dict[str, str]:
    words = WORDS[Quality(code)] if code in Quality._value2member_map_ else "unknown"
    level = "good" if code == Quality.OK else "bad" if code == Quality.STALE else "fair"
    return {"level": level, "words": words}


def _actuator(channel: Any, since_s: float) -> dict[str, Any]:
    """One channel of an actuator: the value that holds, how old it is, and how it fares; without a value it
    is lost, or nobody has said it yet."""
    owner, _, last = channel.name[:80].rpartition(".")
    known, age = CHANNELS_OF.get(last), number(channel, "age_s", 1.0, 1)
    quality = "bad" if not channel.HasField("value") and channel.quality else _fares(channel.quality)["level"]
    return {
        "name": f"{owner} {known.attribute if known else last}",
        "unit": known.unit if known else "",
        "value": number(channel, "value", 1.0, 2),
        "age": None if age is None else round(age + since_s, 1),
        **_fares(channel.quality),
        "level": quality,
    }


def _age(tick: Any, channel: str, since_s: float) -> float | None:
    """How old a channel's newest good sample is now [s]."""
    age = number(tick.age_s, channel, 1.0, 1)
    return None if age is None else round(age + since_s, 1)


def _plain(channel: str) -> str:
    """A channel's name without its unit."""
    words = channel.split("_")
    return " ".join(words[:-1] if words[-1] in UNITS and len(words) > 1 else words)


def _pace(tick: Any) -> dict[str, Any]:
    timed = tick.HasField("slack_us")
    return {
        "rate": round(tick.rate_hz, 2),
        "slack_ms": round(tick.slack_us / 1e3, 1) if timed else None,
        "step_ms": round(tick.step_us / 1e3, 2) if timed else None,
        "overruns": tick.overruns,
        "rejected": tick.rejected,
        "log_dropped": tick.log_dropped,
    }
