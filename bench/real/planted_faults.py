"""Faults of a known size in the readings of real runs: a real ship with a hidden cause, without any
simulator.

What an instrument would have shown is exact: a compass that is off turns the speed over ground with it, and
the true wind, which is worked out on board from the wind about the ship; an antenna elsewhere sails its own
way, a stream carries everything along. Rudder and propeller are recorded
other than they were, which is what a ship with a weaker rudder or screw looks like, but for the flow that
meets them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from twin.physics.ship import Ship
from twin.recording.voyage import Voyage
from twin.study.diagnosis.effect_diagnosis import diagnose


@dataclass(frozen=True)
class PlantedReadings:
    """A voyage's readings [SI, rad]: place and velocity over ground along earth axes, heading, yaw rate."""

    x: np.ndarray
    y: np.ndarray
    north: np.ndarray
    east: np.ndarray
    psi: np.ndarray
    r: np.ndarray

    @classmethod
    def of(cls, v: Voyage) -> "PlantedReadings":
        psi, u, w = np.radians(v["heading_true_north_deg"]), v["surge_velocity_mps"], v["sway_velocity_mps"]
        c, s = np.cos(psi), np.sin(psi)
        return cls(
            v["north_m"], v["east_m"], u * c - w * s, u * s + w * c, psi, np.radians(v["yaw_rate_degps"])
        )

    def into(self, v: Voyage) -> Voyage:
        """The same voyage with these readings, velocity turned into body axes by the heading that is
        shown."""
        c, s = np.cos(self.psi), np.sin(self.psi)
        shown = {
            "north_m": self.x,
            "east_m": self.y,
            "heading_true_north_deg": np.degrees(self.psi),
            "yaw_rate_degps": np.degrees(self.r),
            "surge_velocity_mps": self.north * c + self.east * s,
            "sway_velocity_mps": self.east * c - self.north * s,
        }
        return replace(v, columns=dict(v.columns) | shown)


def turned_compass(v: Voyage, bias: float) -> Voyage:
    """A heading off by `bias` [rad], and what is turned by it: not the wind about the ship."""
    q = PlantedReadings.of(v)
    return replace(q, psi=q.psi + bias).into(_with_turned_wind(v, q, bias))


def _with_turned_wind(v: Voyage, q: PlantedReadings, bias: float) -> Voyage:
    """The true wind as worked out with that heading: what blows about the ship turns along earth axes, the
    velocity over ground that is added does not (none where it is unknown)."""
    speed, came = "true_wind_speed_mps", "true_wind_direction_deg"
    if not v.has(speed, came):
        return v
    ground = np.nan_to_num(q.north + 1j * q.east)
    true = -v[speed] * np.exp(1j * np.radians(v[came]))
    shown = ground + (true - ground) * np.exp(1j * bias)
    turned = {speed: np.abs(shown), came: np.degrees(np.angle(-shown)) % 360.0}
    return replace(v, columns=dict(v.columns) | turned)


def antenna_elsewhere(v: Voyage, ahead: float) -> Voyage:
    q = PlantedReadings.of(v)
    c, s = np.cos(q.psi), np.sin(q.psi)
    return replace(
        q,
        x=q.x + ahead * c,
        y=q.y + ahead * s,
        north=q.north - ahead * q.r * s,
        east=q.east + ahead * q.r * c,
    ).into(v)


def in_a_stream(v: Voyage, north: float, east: float) -> Voyage:
    q, t = PlantedReadings.of(v), v.time_s - v.time_s[0]
    return replace(q, x=q.x + north * t, y=q.y + east * t, north=q.north + north, east=q.east + east).into(v)


def late_receiver(v: Voyage, delay: float) -> Voyage:
    """Begun when the first late reading has come."""
    q = PlantedReadings.of(v)
    late = {
        name: np.interp(v.time_s - delay, v.time_s, getattr(q, name)) for name in ("x", "y", "north", "east")
    }
    out, there = replace(q, **late).into(v), v.time_s >= v.time_s[0] + delay
    return replace(
        out, time_s=v.time_s[there], columns={name: values[there] for name, values in out.columns.items()}
    )


def shown(v: Voyage, channel: str, factor: float = 1.0, offset: float = 0.0) -> Voyage:
    return replace(v, columns=dict(v.columns) | {channel: factor * v[channel] + offset})


def early_rudder(v: Voyage, lead: float) -> Voyage:
    """What was recorded is the order: the rudder came so much later."""
    return replace(
        v,
        columns=dict(v.columns)
        | {"rudder_angle_deg": np.interp(v.time_s + lead, v.time_s, v["rudder_angle_deg"])},
    )


class PlantedFault(NamedTuple):
    """What is put into the readings; `effects` by which the catalogue would name it, none when nothing is
    wrong."""

    words: str
    effects: tuple[str, ...]
    put: Callable[[Voyage, float, float], Voyage]  # of a voyage, L [m] and U_0 [m/s]


FAULTS = (
    PlantedFault("nothing", (), lambda v, L, U: v),
    PlantedFault(
        "compass 2.5 deg to starboard", ("HeadingBias",), lambda v, L, U: turned_compass(v, np.radians(2.5))
    ),
    PlantedFault(
        "antenna 15 % of L ahead", ("AntennaOffset",), lambda v, L, U: antenna_elsewhere(v, 0.15 * L)
    ),
    PlantedFault(
        "receiver 0.08 L/U_0 late", ("SensorDelay",), lambda v, L, U: late_receiver(v, 0.08 * L / U)
    ),
    PlantedFault(
        "rate gyro off by 0.02 U_0/L",
        ("GyroBias",),
        lambda v, L, U: shown(v, "yaw_rate_degps", offset=np.degrees(0.02 * U / L)),
    ),
    PlantedFault("a stream of 8 % of U_0", ("Current",), lambda v, L, U: in_a_stream(v, 0.06 * U, -0.05 * U)),
    PlantedFault(
        "rudder shown 2 deg to starboard of where it is",
        ("RudderOffset",),
        lambda v, L, U: shown(v, "rudder_angle_deg", offset=2.0),
    ),
    PlantedFault(
        "rudder shown a quarter larger than it is",
        ("RudderWear",),
        lambda v, L, U: shown(v, "rudder_angle_deg", 1.25),
    ),
    PlantedFault(
        "rudder 0.35 L/U_0 later than recorded",
        ("SteeringLag",),
        lambda v, L, U: early_rudder(v, 0.35 * L / U),
    ),
    PlantedFault(
        "screw shown 6 % faster than it turns",
        ("PropellerWear",),
        lambda v, L, U: shown(v, "propeller_rate_rpm", 1.06),
    ),
    PlantedFault(
        "compass and stream together",
        ("HeadingBias", "Current"),
        lambda v, L, U: turned_compass(in_a_stream(v, 0.06 * U, -0.05 * U), np.radians(2.5)),
    ),
)


def answer(fault: PlantedFault, voyages: Sequence[Voyage], ship: Ship) -> dict[str, Any]:
    """What the diagnosis of these voyages says when the fault is in their readings."""
    L, U = float(ship.L_pp), float(ship.scale("speed"))
    found = diagnose([fault.put(v, L, U) for v in voyages], ship).result
    numbers = [p for c in found["candidates"] if c["effect"] in found["missing"] for p in c["parameters"]]
    keep = {k: found[k] for k in ("verdict", "reason", "missing", "one_of", "probabilities", "facts")}
    return {"put": fault.words, "effects": fault.effects, "numbers": numbers} | keep


def table(rows: Sequence[dict[str, Any]]) -> str:
    """The answers as a table."""
    lines = [
        "| put into the readings | the catalogue's name | verdict | reason | named | numbers (95 %) |",
        "|---|---|---|---|---|---|",
    ]
    for r in rows:
        few = [p for p in r["numbers"] if "_c" not in p["name"] and "_s" not in p["name"]]
        sizes = "; ".join(
            f"{p['name']} {p['value']:.3g} {p['unit']} ({p['low95']:.2g} to {p['high95']:.2g})" for p in few
        )
        one_of = f"one of {', '.join(r['one_of'])}" if r["one_of"] else ""
        lines.append(
            f"| {r['put']} | {' + '.join(r['effects'])} | `{r['verdict']}` | "
            f"`{r['reason']}` | {' + '.join(r['missing']) or one_of} | {sizes} |"
        )
    return "\n".join(lines)
