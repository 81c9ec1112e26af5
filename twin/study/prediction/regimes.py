"""Conditions a navigator would name (wind on the port beam, turning to starboard, the first third ...), found
in the data.

A condition is a sentence and a mask over windows. Thresholds are the data's own thirds; what hardly varies
yields none."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from twin.num import as_given, num
from twin.physics.maths import RAD
from twin.physics.ship import Ship
from twin.study.prediction.openloop import Windows

SECTORS = (("ahead", 0.0), ("the starboard beam", 90.0), ("astern", 180.0), ("the port beam", 270.0))
QUARTERS = (("north", 0.0), ("east", 90.0), ("south", 180.0), ("west", 270.0))
Condition = tuple[str, np.ndarray]


@dataclass(frozen=True)
class Means:
    """What went on in each window: means over it, (W,) for all voyages in a row."""

    values: dict[str, np.ndarray]
    voyage: np.ndarray
    names: tuple[str, ...]

    def __getitem__(self, name: str) -> np.ndarray | None:
        return self.values.get(name)


def means(windows: Sequence[Windows], horizon_s: float) -> Means:
    """Averages over every window; a channel that one voyage lacks is NaN there."""
    parts = [_of_track(w, horizon_s) for w in windows]
    names = sorted(set().union(*parts))
    sizes = [w.start.size for w in windows]
    values = {
        n: np.concatenate([p.get(n, np.full(size, np.nan)) for p, size in zip(parts, sizes, strict=True)])
        for n in names
    }
    return Means(values, np.repeat(np.arange(len(windows)), sizes), tuple(w.track.name for w in windows))


def _of_track(w: Windows, horizon_s: float) -> dict[str, np.ndarray]:
    t, ahead = w.track, max(1, round(horizon_s / w.track.h))
    end = np.minimum(w.start + ahead, len(t) - 1)

    def mean(values: np.ndarray) -> np.ndarray:
        total = np.concatenate([[0.0], np.cumsum(values)])
        return (total[end + 1] - total[w.start]) / (end + 1 - w.start)

    x, y, psi, u, v, r = t.state.T
    rate = np.abs(np.gradient(t.n, t.h)) * ahead * t.h
    out = {
        "time": t.t[w.start],
        "north": mean(x),
        "east": mean(y),
        "speed": mean(np.hypot(u, v)),
        "drift": mean(np.arctan2(v, np.abs(u) + 0.01)) * RAD,
        "rudder": mean(t.delta) * RAD,
        "rudder_size": mean(np.abs(t.delta)) * RAD,
        "turning": mean(r) * RAD,
        "turning_size": mean(np.abs(r)) * RAD,
        "heading": np.arctan2(mean(np.sin(psi)), mean(np.cos(psi))) * RAD,
        "rpm": mean(t.n) * 60.0,
        "rpm_change": mean(rate) * 60.0,
    }
    seas = t.weather
    if "wind_speed" in seas:
        ahead_, aside = (
            u - seas["wind_speed"] * np.cos(seas["wind_to"] - psi),
            v - seas["wind_speed"] * np.sin(seas["wind_to"] - psi),
        )
        out |= {"wind": mean(seas["wind_speed"]), "wind_angle": np.arctan2(mean(aside), mean(ahead_)) * RAD}
    if "H_s" in seas and "wave_to" in seas:
        angle = seas["wave_to"] + np.pi - psi
        out |= {
            "waves": mean(seas["H_s"]),
            "wave_angle": np.arctan2(mean(np.sin(angle)), mean(np.cos(angle))) * RAD,
        }
    for name in ("depth", "draught"):
        if name in seas:
            out[name] = mean(seas[name])
    for name in ("bank_port", "bank_starboard"):
        if name in seas:
            out["bank"] = np.minimum(out.get("bank", np.inf), mean(seas[name]))
    return out


def conditions(m: Means, ship: Ship) -> list[Condition]:
    """Every condition worth asking about. Each (W,): a mask of the windows."""
    U, L, T, B = (float(x) for x in (ship.U_0, ship.L_pp, ship.T, ship.B))
    rpm = float(np.nanmax(np.abs(m.values["rpm"])))
    turn = U / L * RAD  # a turn of one length's radius [deg/s]
    return [
        *_thirds(m["speed"], "speed", "m/s", 0.05 * U),
        *_thirds(m["rudder_size"], "rudder", "deg", 2.0),
        *_sides(m["rudder"], "rudder", "deg", 3.0),
        *_thirds(m["turning_size"], "turning", "deg/s", 0.05 * turn),
        *_sides(m["turning"], "turning", "deg/s", 0.1 * turn),
        *_sides(m["drift"], "drifting", "deg", 2.0),
        *_thirds(m["rpm"], "propeller rate", "rpm", 0.05 * rpm),
        *_above(m["rpm_change"], "propeller rate changing", 0.05 * rpm),
        *_below(m["rpm"], "propeller astern", 0.0),
        *_weather(m, "wind", "wind", "m/s", 0.5 + 0.1 * U),
        *_weather(m, "waves", "waves", "m", 0.003 * L),
        *_depth(m["depth"], T),
        *_bank(m["bank"], B),
        *_sectors(m["heading"], "heading", QUARTERS),
        *_thirds(m["draught"], "draught", "m", 0.03 * T),
        *_times(m),
        *_thirds(m["north"], "north of the datum by", "m", 3.0 * L),
        *_thirds(m["east"], "east of the datum by", "m", 3.0 * L),
    ]


def _number(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 20 else num(value, 3)


def _thirds(x: np.ndarray | None, what: str, unit: str, least: float) -> Iterator[Condition]:
    """The upper and the lower third, when they differ by more than `least`."""
    if x is None or not np.isfinite(x).any():
        return
    low, high = np.nanquantile(x, [1 / 3, 2 / 3])
    if np.nanquantile(x, 0.9) - np.nanquantile(x, 0.1) > least:
        yield f"{what} above {_number(high)} {unit}", x > high
        yield f"{what} below {_number(low)} {unit}", x < low


def _sides(x: np.ndarray | None, what: str, unit: str, least: float) -> Iterator[Condition]:
    if x is not None:
        yield f"{what} to starboard by more than {_number(least)} {unit}", x > least
        yield f"{what} to port by more than {_number(least)} {unit}", x < -least


def _above(x: np.ndarray | None, what: str, least: float) -> Iterator[Condition]:
    if x is not None:
        yield what, x > least


def _below(x: np.ndarray | None, what: str, most: float) -> Iterator[Condition]:
    if x is not None:
        yield what, x < most


def _sectors(angle: np.ndarray | None, what: str, names: Sequence[tuple[str, float]]) -> Iterator[Condition]:
    """Quarters of 90 degrees about each direction."""
    if angle is not None:
        for name, centre in names:
            yield f"{what} {name}", np.abs((angle - centre + 180.0) % 360.0 - 180.0) < 45.0


def _weather(m: Means, name: str, what: str, unit: str, least: float) -> Iterator[Condition]:
    """Strength, the side it comes from (relative to the moving ship), and both together."""
    strength, angle = m[name], m["wind_angle" if name == "wind" else "wave_angle"]
    if strength is None or angle is None or not np.nanmedian(strength) > least:
        return
    yield from _thirds(strength, what, unit, least)
    sides = list(_sectors(angle, f"{what} from", SECTORS))
    yield from sides
    half = float(np.nanmedian(strength))
    for text, mask in sides:
        yield f"{text}, above {_number(half)} {unit}", mask & (strength > half)


def _depth(depth: np.ndarray | None, T: float) -> Iterator[Condition]:
    for draughts in (1.5, 2.0, 3.0, 5.0):
        if depth is not None:
            yield (
                f"depth under {as_given(draughts)} draughts ({num(draughts * T, 3)} m)",
                depth < draughts * T,
            )


def _bank(bank: np.ndarray | None, B: float) -> Iterator[Condition]:
    for beams in (2.0, 4.0):
        if bank is not None:
            yield f"a bank within {as_given(beams)} beams ({num(beams * B, 3)} m)", bank < beams * B


def _times(m: Means) -> Iterator[Condition]:
    """Thirds of each voyage; with several, each voyage as a whole."""
    time = m.values["time"]
    for i, name in enumerate(m.names):
        mine, of = m.voyage == i, f" of {name}" if len(m.names) > 1 else ""
        if of:
            yield f"voyage {name}", mine
        edges = np.linspace(time[mine].min(), time[mine].max() + 1e-6, 4)
        for word, a, b in zip(("first", "second", "last"), edges[:-1], edges[1:], strict=True):
            yield f"the {word} third{of} ({a:.0f} to {b:.0f} s)", mine & (time >= a) & (time < b)
