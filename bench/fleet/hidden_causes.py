"""What is hidden: every effect of the catalogue in a form of its own, and kinds that no catalogue has. Each
entry takes (particulars, drive, rng, strength) and returns what changes: numbers of `Flaws`, of the
weather, of
the ship's loading; strength 1 is plain to see, 0.1 is not."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bench.fleet.drive import Propulsion
from bench.fleet.random_particulars import RHO, G, Particulars

Draw = np.random.Generator


@dataclass
class Flaws:
    """Numbers of what is wrong; zero is a healthy ship. Forces in N, angles in rad."""

    fouling: float = 0.0  # added resistance at service speed [N]
    fouling_power: float = 2.0
    prop_wear: float = 0.0
    rudder_wear: float = 0.0
    rudder_offset: float = 0.0
    cross_flow: float = 0.0  # drag coefficient at the ends
    walk: float = 0.0  # side share of thrust at the propeller
    tow: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tow_s: float = 60.0
    pull: tuple[float, float] = (0.0, 0.0)  # north, east
    heel_Y: float = 0.0
    heel_N: float = 0.0
    soft: float = 0.0  # share of the righting lever that is lost
    bank: float = 0.0
    shallow: float = 0.0  # draught over depth
    lag_s: float = 0.0
    slow: float = 0.0  # share of the gear's rate that is lost
    heading: float = 0.0
    deviation: float = 0.0
    gyro: float = 0.0
    log_bias: float = 0.0
    log_scale: float = 0.0
    log_angle: float = 0.0
    antenna: tuple[float, float] = (0.0, 0.0)
    late_s: float = 0.0  # of the receiver
    mass: float = 0.0  # share
    x_G: float = 0.0  # [m]
    # outside the catalogue
    ice: float = 0.0
    ice_s: float = 60.0
    passing: tuple[float, float] = (0.0, 0.0)
    passing_s: float = 600.0
    slosh: float = 0.0
    slosh_w: float = 1.0
    backlash: float = 0.0
    thruster: float = 0.0  # [N] at rest
    ventilation: float = 0.0
    stuck_s: float = 0.0
    hunting: float = 0.0
    yaw_damping: float = 0.0  # [N m s]
    sway_damping: float = 0.0  # [N s/m]
    flood: float = 0.0  # [m/s] by which the centre of gravity moves
    wander: float = 0.0  # [m] of the receiver
    compass_s: float = 0.0
    rate_scale: float = 0.0
    flap: float = 0.0  # side force of a bent plate, over speed squared [N s2/m2]


@dataclass
class HiddenChange:
    """What one hidden thing changes."""

    flaws: dict[str, Any] = field(default_factory=dict)
    weather: dict[str, float] = field(default_factory=dict)


Entry = Callable[[Particulars, Propulsion, Draw, float], HiddenChange]


def side(rng: Draw) -> float:
    return float(rng.choice([-1.0, 1.0]))


def drag0(p: Particulars, d: Propulsion) -> float:
    """Calm resistance at service speed [N], as the propeller balances it."""
    return (1 - d.t) * d.thrust(d.n0, p.U0, 0.0)[0]


def _flaw(make: Callable[[Particulars, Propulsion, Draw, float], dict[str, Any]]) -> Entry:
    return lambda p, d, rng, s: HiddenChange(make(p, d, rng, s))


def _weather(make: Callable[[Particulars, Propulsion, Draw, float], dict[str, float]]) -> Entry:
    return lambda p, d, rng, s: HiddenChange(weather=make(p, d, rng, s))


def shallow(p: Particulars, d: Propulsion, rng: Draw, s: float) -> HiddenChange:
    share = min(0.7 * s**0.5, 0.8)
    return HiddenChange({"shallow": share}, {"depth": p.T / share})


def bank(p: Particulars, d: Propulsion, rng: Draw, s: float) -> HiddenChange:
    return HiddenChange(
        {"bank": 0.03 * s * rng.uniform(0.7, 1.3)}, {"bank": side(rng) * rng.uniform(1.2, 2.5) * p.B}
    )


def big_wind(p: Particulars, d: Propulsion, rng: Draw, s: float) -> dict[str, float]:
    return {"wind": 15.0 * min(1.0, (p.L / 120) ** 0.4) * s**0.5, "wind_from": rng.uniform(0, 6.28)}


def big_sea(p: Particulars, d: Propulsion, rng: Draw, s: float) -> dict[str, float]:
    return {"swell": 0.025 * p.L**0.85 * s**0.5, "swell_from": rng.uniform(0, 6.28)}


def stream(p: Particulars, d: Propulsion, rng: Draw, s: float) -> dict[str, float]:
    return {"stream": 0.2 * p.U0 * s, "stream_to": rng.uniform(0, 6.28)}


def tide(p: Particulars, d: Propulsion, rng: Draw, s: float) -> dict[str, float]:
    return {"tide": 0.15 * p.U0 * s, "tide_s": rng.uniform(60, 150) * p.unit_s, "eddy": 0.02 * p.U0 * s}


CATALOGUE: dict[str, Entry] = {
    "HullFouling": _flaw(
        lambda p, d, rng, s: {"fouling": 0.4 * s * drag0(p, d), "fouling_power": rng.uniform(1.7, 2.1)}
    ),
    "PropellerWear": _flaw(lambda p, d, rng, s: {"prop_wear": 0.16 * s}),
    "RudderWear": _flaw(lambda p, d, rng, s: {"rudder_wear": min(0.3 * s, 0.7)}),
    "RudderOffset": _flaw(lambda p, d, rng, s: {"rudder_offset": side(rng) * np.radians(2.2) * s}),
    "CrossFlowDrag": _flaw(lambda p, d, rng, s: {"cross_flow": 0.6 * s}),
    "PropellerWalk": _flaw(lambda p, d, rng, s: {"walk": side(rng) * 0.07 * s}),
    "TowForce": _flaw(
        lambda p, d, rng, s: {"tow": _hook(p, drag0(p, d), rng, s), "tow_s": rng.uniform(2, 5) * p.unit_s}
    ),
    "ExternalForce": _flaw(lambda p, d, rng, s: {"pull": _to(rng, 0.3 * s * drag0(p, d))}),
    "RollCoupling": _flaw(
        lambda p, d, rng, s: {"heel_N": -0.08 * s, "heel_Y": 0.05 * s, "soft": min(0.5 * s, 0.6)}
    ),
    "Loading": _flaw(lambda p, d, rng, s: {"mass": 0.13 * s, "x_G": -0.014 * s * p.L * side(rng)}),
    "SteeringLag": _flaw(lambda p, d, rng, s: {"lag_s": 0.07 * s * p.unit_s, "slow": min(0.5 * s, 0.7)}),
    "HeadingBias": _flaw(lambda p, d, rng, s: _compass(rng, np.radians(2.2) * s)),
    "GyroBias": _flaw(lambda p, d, rng, s: {"gyro": side(rng) * 0.025 * s / p.unit_s}),
    "SpeedLogBias": _flaw(lambda p, d, rng, s: {"log_bias": side(rng) * 0.045 * s * p.U0}),
    "SpeedLogScale": _flaw(lambda p, d, rng, s: {"log_scale": side(rng) * 0.07 * s}),
    "SpeedLogMisalignment": _flaw(lambda p, d, rng, s: {"log_angle": side(rng) * np.radians(3.0) * s}),
    "AntennaOffset": _flaw(
        lambda p, d, rng, s: {"antenna": (side(rng) * 0.3 * s * p.L, side(rng) * 0.2 * s * p.B)}
    ),
    "SensorDelay": _flaw(lambda p, d, rng, s: {"late_s": s * (0.06 * p.unit_s + 0.4)}),
    "Wind": _weather(big_wind),
    "WaveDrift": _weather(big_sea),
    "Current": _weather(stream),
    "VaryingCurrent": _weather(tide),
    "ShallowWater": shallow,
    "Bank": bank,
}


def _hook(p: Particulars, R: float, rng: Draw, s: float) -> tuple[float, float, float]:
    Y = 0.2 * s * R * side(rng)
    return -0.15 * s * R, Y, rng.uniform(-0.45, 0.4) * p.L * Y


def _to(rng: Draw, pull: float) -> tuple[float, float]:
    a = rng.uniform(0, 2 * np.pi)
    return pull * float(np.cos(a)), pull * float(np.sin(a))


def _compass(rng: Draw, bias: float) -> dict[str, float]:
    return {"heading": side(rng) * bias, "deviation": 0.2 * bias * rng.uniform(-1, 1)}


OUTSIDE: dict[str, Entry] = {
    "Ice": _flaw(lambda p, d, rng, s: {"ice": 0.7 * s * drag0(p, d), "ice_s": rng.uniform(2, 4) * p.unit_s}),
    "PassingShip": _flaw(
        lambda p, d, rng, s: {
            "passing": (0.03 * s * side(rng), 0.01 * s * side(rng)),
            "passing_s": rng.uniform(10, 16) * p.unit_s,
        }
    ),
    "Sloshing": _flaw(
        lambda p, d, rng, s: {"slosh": 0.13 * s, "slosh_w": rng.uniform(2, 3) * (G / p.L) ** 0.5}
    ),
    "Backlash": _flaw(lambda p, d, rng, s: {"backlash": np.radians(3.0) * s}),
    "Squall": _weather(lambda p, d, rng, s: {"squall": 20.0 * min(1.0, (p.L / 120) ** 0.4) * s**0.5}),
    "Thruster": _flaw(lambda p, d, rng, s: {"thruster": side(rng) * 0.5 * s * drag0(p, d)}),
    "Ventilation": _flaw(lambda p, d, rng, s: {"ventilation": 0.35 * s}),
    "StuckRudder": _flaw(lambda p, d, rng, s: {"stuck_s": s * rng.uniform(1, 2) * p.unit_s}),
    "Hunting": _flaw(lambda p, d, rng, s: {"hunting": 0.12 * s}),
    "YawDamping": _flaw(
        lambda p, d, rng, s: {"yaw_damping": 0.012 * s * RHO * p.L**3 * p.T * p.U0 * side(rng)}
    ),
    "SwayDamping": _flaw(lambda p, d, rng, s: {"sway_damping": 0.08 * s * RHO * p.L * p.T * p.U0}),
    "Flooding": _flaw(lambda p, d, rng, s: {"flood": -0.03 * s * p.L / (60 * p.unit_s), "mass": 0.04 * s}),
    "ReceiverWander": _flaw(lambda p, d, rng, s: {"wander": s * (3.0 + 0.05 * p.L)}),
    "SlowCompass": _flaw(lambda p, d, rng, s: {"compass_s": s * (0.15 * p.unit_s + 0.5)}),
    "RateScale": _flaw(lambda p, d, rng, s: {"rate_scale": side(rng) * 0.2 * s}),
    "BentPlate": _flaw(lambda p, d, rng, s: {"flap": side(rng) * 0.006 * s * RHO * p.L * p.T}),
}
OF_THE_VOYAGE = ("Wind", "WaveDrift", "Current", "VaryingCurrent", "ShallowWater", "Bank")
EVERY = {**CATALOGUE, **OUTSIDE}
