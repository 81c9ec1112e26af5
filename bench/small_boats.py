"""`python -m bench.small_boats`: are sides and signs of actuators named, and are healthy boats left in peace?

Boats with actuators as parts, sailed by equations that share no line with the twin: heavy and light, with
two thrusters, two screws and a bow thruster, two outboards, or four azimuths; thrust curves, lags, gusts and
noise of their own, which the ship file does not know. Then each mistake of the wiring: is it named?
"""

import argparse
import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from twin import whole
from twin.physics.actuators import Actuator
from twin.physics.ship import Ship, load
from twin.recording.checks.actuator_response import actuators
from twin.recording.checks.standstill import actuator_zero
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.voyage import Voyage

STEP_S, SAMPLE = 0.05, 4  # integrated so finely, recorded every fourth step
LENGTH_M, MASS_KG, THRUST_N = 3.0, 180.0, 150.0
SMALL = 0.4  # of these: the electric catamaran with two thrusters
Columns = dict[str, np.ndarray]
AZIMUTHS = (("bow_p", 1.1, -0.5), ("bow_s", 1.1, 0.5), ("stern_p", -1.1, -0.5), ("stern_s", -1.1, 0.5))


def scale(kind: str) -> float:
    """Its length over LENGTH_M."""
    return SMALL if kind == "thrusters" else 1.0


def parts(kind: str) -> tuple[Actuator, ...]:
    """The actuators of a kind of boat, as its owner writes them down."""

    k = scale(kind)

    def one(name: str, what: str, channels: tuple[str, ...], x: float, y: float) -> Actuator:
        numbers = {"ahead": THRUST_N * k**2, "astern": 0.6 * THRUST_N * k**2}
        return Actuator(name, what, channels, x=k * x, y=k * y, **numbers)

    pwm, turned = ("pwm_us",), ("command", "angle_deg")
    sides = (("port", -0.6), ("starboard", 0.6))
    return {
        "thrusters": tuple(one(n, "fixed_thruster", pwm, -1.2, y) for n, y in sides),
        "screws and bow thruster": (
            *(one(n, "fixed_thruster", ("command",), -1.3, 0.5 * y) for n, y in sides),
            one("bow", "tunnel_thruster", ("command",), 1.2, 0.0),
        ),
        "outboards": tuple(one(n, "outboard", turned, -1.5, 0.4 * y) for n, y in sides),
        "azimuths": tuple(one(n, "azimuth", turned, x, y) for n, x, y in AZIMUTHS),
    }[kind]


KINDS = ("thrusters", "screws and bow thruster", "outboards", "azimuths")


def ship_of(kind: str) -> Ship:
    base, k = load("usv"), scale(kind)
    inertia = MASS_KG * 0.06 * LENGTH_M**2 * k**5
    return replace(
        base,
        L_pp=k * LENGTH_M,
        B=k * 1.4,
        T=k * 0.25,
        m=MASS_KG * k**3,
        I_z=inertia,
        U_0=2.0,
        actuators=parts(kind),
    )


def sailed(
    kind: str,
    seed: int,
    duration_s: float = 240.0,
    boat_seed: int | None = None,
    lags_s: Mapping[str, float] | None = None,
) -> Voyage:
    """One boat under orders that nobody planned: straight, turning, stopping. `boat_seed`: the same boat on
    voyages of several seeds; `lags_s`: by how much the thrust of each part is behind its order, if not as it
    was drawn."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    drawn = rng if boat_seed is None else np.random.default_rng([boat_seed, KINDS.index(kind), 7])
    boat, order = _Boat(kind, drawn, rng), _orders(kind, rng, round(duration_s / STEP_S))
    boat.lag |= lags_s or {}
    rows = [boat.step({n: x[k] for n, x in order.items()}) for k in range(round(duration_s / STEP_S))]
    x, y, psi, u, v, r = np.array(rows)[::SAMPLE].T
    n = x.size
    columns = {
        "north_m": x + 0.02 * rng.standard_normal(n),
        "east_m": y + 0.02 * rng.standard_normal(n),
        "heading_true_north_deg": np.degrees(psi) + 0.3 * rng.standard_normal(n),
        "surge_velocity_mps": u + 0.02 * rng.standard_normal(n),
        "sway_velocity_mps": v + 0.02 * rng.standard_normal(n),
        "yaw_rate_degps": np.degrees(r) + 0.3 * rng.standard_normal(n),
    }
    columns["heading_true_north_deg"] %= 360.0
    recorded = {name: order[name][::SAMPLE] for name in order}
    return Voyage(f"{kind} {seed}", STEP_S * SAMPLE * np.arange(n), columns | recorded)


def _orders(kind: str, rng: np.random.Generator, steps: int) -> Columns:
    """Steps of power and steering, each held for some seconds; a rest at the beginning."""

    def held(values: Callable[[], float], first: float) -> np.ndarray:
        out, k = np.full(steps, first), round(20.0 / STEP_S)
        while k < steps:
            n = round(rng.uniform(3.0, 15.0) / STEP_S)
            out[k : k + n] = values()
            k += n
        return out

    def power() -> float:
        return float(rng.choice([0.0, 0.3, 0.6, 0.9, -0.4], p=[0.15, 0.25, 0.3, 0.2, 0.1]))

    common, out = held(power, 0.0), dict[str, np.ndarray]()
    for a in parts(kind):
        if a.kind == "tunnel_thruster":
            share = held(lambda: float(rng.choice([0.0, 0.5, -0.5])), 0.0)
        elif a.kind == "fixed_thruster":
            other = held(lambda: float(rng.uniform(-0.3, 0.3)), 0.0)
            share = np.clip(common + other, -1.0, 1.0)
        else:
            share = np.abs(held(power, 0.0)) if a.kind == "azimuth" else common
        out[a.columns()[0]] = 1500.0 + 400.0 * share if "pwm" in a.attributes else share
        if "angle" in a.attributes:
            widest = 180.0 if a.kind == "azimuth" else 30.0
            out[a.columns()[1]] = held(lambda w=widest: float(rng.uniform(-w, w)), 0.0)  # type: ignore[misc]
    return out


class _Boat:
    """Its own equations: mass and added mass, linear and quadratic drag, a thrust curve of some power between
    1 and 2, a lag, gusts."""

    def __init__(self, kind: str, rng: np.random.Generator, gusts: np.random.Generator):
        k = scale(kind)
        self.parts, self.rng, self.full = parts(kind), gusts, THRUST_N * k**2
        self.mass = MASS_KG * k**3 * np.array([rng.uniform(1.05, 1.2), rng.uniform(1.4, 2.0)])
        self.inertia = MASS_KG * (0.25 * LENGTH_M) ** 2 * k**5 * rng.uniform(1.2, 1.8)
        self.drag = np.array([25.0 * k**2, 90.0 * k**2, 60.0 * k**3]) * rng.uniform(0.6, 1.5, 3)
        self.linear = np.array([10.0 * k**2, 30.0 * k**2, 20.0 * k**3]) * rng.uniform(0.3, 1.5, 3)
        self.curve = rng.uniform(1.0, 2.0)
        self.lag = dict.fromkeys((a.name for a in self.parts), rng.uniform(0.1, 0.6))
        self.strength = {a.name: rng.uniform(0.7, 1.2) for a in self.parts}
        self.push = dict.fromkeys(self.strength, 0.0)
        self.gust, self.wind = np.zeros(3), np.array([2.0, 4.0, k]) * k**2 * rng.uniform(0.0, 0.25)
        self.state = np.zeros(6)

    def step(self, order: dict[str, float]) -> np.ndarray:
        _, _, psi, u, v, r = self.state
        force = self.wind * self.gust
        self.gust += STEP_S * (-self.gust / 5.0) + self.rng.standard_normal(3) * np.sqrt(2.0 * STEP_S / 5.0)
        for a in self.parts:
            force = force + self._of(a, order)
        force = force - self.linear * (u, v, r) - self.drag * np.abs((u, v, r)) * (u, v, r)
        m_u, m_v = self.mass
        du, dv = (force[0] + m_v * v * r) / m_u, (force[1] - m_u * u * r) / m_v
        dr = (force[2] - 0.5 * (m_v - m_u) * u * v) / self.inertia
        rate = (u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi), r, du, dv, dr)
        self.state = self.state + STEP_S * np.array(rate)
        return self.state

    def _of(self, a: Actuator, order: dict[str, float]) -> np.ndarray:
        c = order[a.columns()[0]]
        c = (c - 1500.0) / 400.0 if "pwm" in a.attributes else c
        full = self.full * (1.0 if c > 0.0 else 0.6) * self.strength[a.name]
        self.push[a.name] += (
            STEP_S / self.lag[a.name] * (full * np.sign(c) * abs(c) ** self.curve - self.push[a.name])
        )
        T = self.push[a.name]
        angle = np.radians(order.get(f"{a.name}.angle_deg", 0.0))
        X, Y = T * np.cos(angle), T * np.sin(angle) * (-1.0 if a.kind == "outboard" else 1.0)
        if a.kind == "tunnel_thruster":
            X, Y = 0.0, T
        return np.array([X, Y, a.x * Y - a.y * X])


def exchange(a: str, b: str) -> Callable[[Columns], Columns]:
    def plant(c: Columns) -> Columns:
        names = {n: n.replace(f"{a}.", f"{b}.") for n in c if n.startswith(f"{a}.")}
        return c | {n: c[m] for n, m in names.items()} | {m: c[n] for n, m in names.items()}

    return plant


def line(name: str, sign: float, offset: float) -> Callable[[Columns], Columns]:
    return lambda c: c | {name: sign * c[name] + offset}


# (kind of boat, what was done, how, words of the answer)
MISTAKES: tuple[tuple[str, str, Callable[[Columns], Columns], str], ...] = (
    ("thrusters", "sides exchanged", exchange("port", "starboard"), "port and starboard are exchanged"),
    ("thrusters", "one reversed", line("port.pwm_us", -1.0, 3000.0), "port is reversed"),
    ("screws and bow thruster", "sides exchanged", exchange("port", "starboard"), "are exchanged"),
    ("screws and bow thruster", "bow thruster reversed", line("bow.command", -1.0, 0.0), "bow is reversed"),
    ("screws and bow thruster", "one reversed", line("port.command", -1.0, 0.0), "port is reversed"),
    ("azimuths", "one angle mirrored", line("bow_p.angle_deg", -1.0, 0.0), "bow_p is positive to port"),
    ("azimuths", "one angle 90 deg off", line("stern_s.angle_deg", 1.0, 90.0), "stern_s is 90 deg too large"),
    ("azimuths", "two exchanged", exchange("bow_p", "stern_s"), "bow_p and stern_s are exchanged"),
)


def healthy(seeds: int) -> dict[str, Any]:
    """How many voyages on which nothing is wrong had something proved wrong, or asked for a look."""
    out: dict[str, Any] = {"voyages": 0, "proved": [], "looks": []}
    for kind in KINDS:
        for seed in range(seeds):
            view = VoyageView(sailed(kind, seed), ship_of(kind))
            out["voyages"] += 1
            for check in (actuators(view), actuator_zero(view)):
                if not check.ok:
                    out["proved" if check.unusable else "looks"].append(f"{kind} {seed}: {check.text}")
    return out


def mistakes(seeds: int, first: int = 1000) -> list[dict[str, Any]]:
    """Each mistake on so many boats: named and proved, named for a look, or something else proved."""
    rows = []
    for kind, what, plant, words in MISTAKES:
        row = {"boat": kind, "mistake": what, "voyages": 0, "proved": 0, "look": 0, "wrong": 0}
        for seed in range(first, first + seeds):
            v = sailed(kind, seed)
            found = actuators(VoyageView(replace(v, columns=plant(dict(v.columns))), ship_of(kind)))
            believed = found.text.partition(": ")[0] if not found.ok else ""
            right = believed.partition(", thrust explains")[0].removeprefix("if ").endswith(words)
            row["voyages"] += 1
            row["proved"] += right and found.unusable
            row["look"] += right and not found.unusable
            row["wrong"] += found.unusable and not right
        rows.append(row)
    return rows


STOP_US = 1511.0  # of its controllers
# column of a log, its channel, and the log's number of the channel's
LOG: tuple[tuple[str, str, float, float], ...] = (
    ("x_ned", "north_m", 1.0, 0.0), ("y_ned", "east_m", 1.0, 0.0),
    ("yaw", "heading_true_north_deg", 1.0, 0.0),
    ("surge", "surge_velocity_mps", 1.0, 0.0), ("sway", "sway_velocity_mps", 1.0, 0.0),
    ("yaw_rate", "yaw_rate_degps", np.pi / 180.0, 0.0),
    ("thr_right", "port.pwm_us", 1.0, 11.0), ("thr_left", "starboard.pwm_us", -1.0, 3011.0),
)  # fmt: skip


def log_of(seed: int, factor: float, path: str, duration_s: float) -> None:
    """A log of the small catamaran as its autopilot writes it: milliseconds, radians a second, one controller
    wired in reverse, and the sides named as seen from ahead. `factor`: of what is recorded of starboard."""
    v = sailed("thrusters", seed, duration_s, boat_seed=0)
    c = {n: k * v[channel] + add for n, channel, k, add in LOG}
    c["thr_left"] = STOP_US + factor * (c["thr_left"] - STOP_US)
    rows = np.column_stack([1000.0 * v.time_s, *c.values()])
    text = ",".join(["original_timestamp", *c]) + "\n"
    text += "".join(",".join(f"{x:.6g}" for x in row) + "\n" for row in rows.tolist())
    whole.write(path, text, "--csv")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--csv", metavar="FILE", help="write the log of one small catamaran instead")
    parser.add_argument("--seed", type=int, default=1, help="which one")
    parser.add_argument("--seconds", type=float, default=240.0, help="how long it sails")
    parser.add_argument(
        "--scaled", type=float, default=1.0, help="its starboard thruster is recorded so much"
    )
    parser.add_argument("--seeds", type=int, default=25, help="healthy boats of each kind")
    parser.add_argument("--planted", type=int, default=10, help="boats of each mistake")
    args = parser.parse_args()
    if args.csv:
        return log_of(args.seed, args.scaled, args.csv, args.seconds)
    json.dump({"healthy": healthy(args.seeds), "mistakes": mistakes(args.planted)}, sys.stdout, indent=1)


if __name__ == "__main__":
    main()
