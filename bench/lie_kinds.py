"""The lies: what an instrument says instead of what it sees."""

import math
import random
from collections.abc import Callable
from typing import NamedTuple

RATE_HZ = 10.0  # of the voyages
Row = dict[str, float]


class Lie(NamedTuple):
    """`tell(row, since_s, memory)` alters what the instruments say since the lie began."""

    name: str
    wanted_s: float
    tell: Callable[[Row, float, dict[str, float]], None]
    since: tuple[str, float] | None = None  # counted from when this channel is told wrong by so much


def _add(**rates: float) -> Callable[[Row, float, dict[str, float]], None]:
    """So much more on each channel for each second of the lie."""

    def tell(row: Row, since_s: float, memory: dict[str, float]) -> None:
        for name, rate in rates.items():
            row[name] += rate * since_s

    return tell


def _off(**by: float) -> Callable[[Row, float, dict[str, float]], None]:
    def tell(row: Row, since_s: float, memory: dict[str, float]) -> None:
        for name, off in by.items():
            row[name] += off

    return tell


def _stuck(name: str, at: float | None = None) -> Callable[[Row, float, dict[str, float]], None]:
    def tell(row: Row, since_s: float, memory: dict[str, float]) -> None:
        if row[name] == row[name]:
            row[name] = memory.setdefault(name, row[name]) if at is None else at

    return tell


def _spoof(rate: float) -> Callable[[Row, float, dict[str, float]], None]:
    """Positions and speed over ground drawn away together, towards north."""

    def tell(row: Row, since_s: float, memory: dict[str, float]) -> None:
        if row["heading_true_north_deg"] == row["heading_true_north_deg"]:
            memory["psi"] = math.radians(row["heading_true_north_deg"])
        row["north_m"] += rate * since_s
        row["surge_velocity_mps"] += rate * math.cos(memory.get("psi", 0.0))
        row["sway_velocity_mps"] -= rate * math.sin(memory.get("psi", 0.0))

    return tell


def _random(row: Row, since_s: float, memory: dict[str, float]) -> None:
    memory["seed"] = (memory.get("seed", 1.0) * 16807.0) % 2147483647.0
    if row["heading_true_north_deg"] == row["heading_true_north_deg"]:
        row["heading_true_north_deg"] = 360.0 * memory["seed"] / 2147483647.0


def _noisy(**sigma: float) -> Callable[[Row, float, dict[str, float]], None]:
    """Normal random numbers on each channel."""

    def tell(row: Row, since_s: float, memory: dict[str, float]) -> None:
        chance = random.Random(round(since_s * RATE_HZ))
        for name, by in sigma.items():
            row[name] += chance.gauss(0.0, by)

    return tell


def _swing(row: Row, since_s: float, memory: dict[str, float]) -> None:
    """Half round and back again, every 20 s, at 18 deg/s."""
    row["heading_true_north_deg"] += 180.0 * (1.0 - abs((since_s % 20.0) - 10.0) / 10.0)


LIES = (
    Lie("position walks off, 0.3 m/s", 300.0, _add(north_m=0.3)),
    Lie("position walks off, 1 m/s", 60.0, _add(north_m=1.0)),
    Lie("positions and speed drawn away together, 1 m/s", 60.0, _spoof(1.0)),
    Lie("positions and speed drawn away together, 0.3 m/s", 300.0, _spoof(0.3)),
    Lie("speed over ground +0.5 m/s", 120.0, _off(surge_velocity_mps=0.5)),
    Lie("water speed +0.5 m/s", 120.0, _off(surge_velocity_through_water_mps=0.5)),
    Lie("compass walks off, 0.05 deg/s", 120.0, _add(heading_true_north_deg=0.05)),
    Lie("compass random", 10.0, _random),
    Lie("compass swings by 180 deg", 10.0, _swing),
    Lie("positions noisy, 5 m", 10.0, _noisy(north_m=5.0, east_m=5.0)),
    Lie("heading noisy, 2 deg", 10.0, _noisy(heading_true_north_deg=2.0)),
    Lie("speed over ground noisy, 0.5 m/s", 10.0, _noisy(surge_velocity_mps=0.5, sway_velocity_mps=0.5)),
    Lie("rate of turn noisy, 1 deg/s", 10.0, _noisy(yaw_rate_degps=1.0)),
    Lie("shaft feedback stuck at 0", 60.0, _stuck("propeller_rate_rpm", 0.0)),
    Lie("rudder feedback stuck", 10.0, _stuck("rudder_angle_deg"), ("rudder_angle_deg", 10.0)),
)
