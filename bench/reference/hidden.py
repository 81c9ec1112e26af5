"""The effects that can be hidden in the truth: size at strength 1, and what a study may compare with.

Each entry takes (hull, rng, strength) and returns a Plan: numbers for flaws.py, changes of hull and
weather, truth. Environment effects change the weather; a voyage that does not hide them is calm.
"""

from dataclasses import dataclass, field, replace
from math import cos, degrees, pi, radians, sin, sqrt
from types import SimpleNamespace

import numpy as np

from bench.reference import flaws
from bench.reference.weather import strong_waves, strong_wind

FULL_SCALE = 50.0  # [m] above this length a ship, below a boat


@dataclass
class Plan:
    numbers: dict = field(default_factory=dict)
    hull: dict = field(default_factory=dict)
    weather: dict = field(default_factory=dict)
    truth: dict = field(default_factory=dict)


def calm_resistance(hull):
    """Resistance [N] at service speed."""
    return 0.5 * hull.rho * hull.L * hull.d * hull.U0**2 * hull.R0


def either(rng):
    return float(rng.choice([-1.0, 1.0]))


def wind(hull, rng, s):
    weather = strong_wind(hull, sqrt(s), float(rng.uniform(0, 360)))
    return Plan(
        weather=weather, truth={"wind_mps": weather["wind_mps"], "wind_from_deg": weather["wind_from_deg"]}
    )


def wave_drift(hull, rng, s):
    weather = strong_waves(hull, s, float(rng.uniform(0, 360)))
    return Plan(
        weather=weather, truth={"height_m": weather["wave_height_m"], "from_deg": weather["wave_from_deg"]}
    )


def cross_flow(hull, rng, s):
    return Plan({"crossflow": 0.4 * s}, truth={"drag_coefficient": 0.4 * s * float(flaws.STRIP_CD.mean())})


def fouling(hull, rng, s):
    return Plan({"fouling": 0.35 * s}, truth={"added_resistance_share": 0.35 * s})


def propeller_wear(hull, rng, s):
    return Plan({"prop_wear": 0.12 * s}, truth={"lost_thrust_share": 0.12 * s})


def rudder_wear(hull, rng, s):
    return Plan({"rudder_wear": 0.25 * s}, truth={"lost_effectiveness_share": 0.25 * s * 0.95})


def rudder_offset(hull, rng, s):
    angle = 2.0 * s * either(rng)
    return Plan({"rudder_offset": radians(angle)}, truth={"offset_deg": 0.97 * angle})


def loading(hull, rng, s):
    """12 % more mass, most of it aft, which nobody told the bridge: draught, centre, inertia, trim."""
    k, x_G = 1 + 0.12 * s, hull.x_G - 0.012 * s * hull.L
    d = hull.d * (1 + 0.11 * s)
    Y, N = list(hull.Y), list(hull.N)
    Y[0], N[0], N[1] = Y[0] * (1 + 0.08 * s), N[0] * (1 - 0.06 * s), N[1] * (1 + 0.06 * s)
    changes = {
        "m": hull.m * k * hull.d / d,
        "d": d,
        "x_G": x_G,
        "k_zz": hull.k_zz * (1 + 0.01 * s),
        "Y": tuple(Y),
        "N": tuple(N),
        "R0": hull.R0 * (1 - 0.06 * s),
    }
    return Plan(
        hull=changes, truth={"mass_share": 0.12 * s, "draught_share": 0.11 * s, "x_G_shift_m": x_G - hull.x_G}
    )


def bank(hull, rng, s):
    return Plan(
        {"bank_Y": 0.05 * s, "bank_N": 0.016 * s},
        weather={"bank_m": 1.2 * hull.B * either(rng)},
        truth={"clearance_m": 1.2 * hull.B},
    )


def tow_force(hull, rng, s):
    R, side = calm_resistance(hull), either(rng)
    X, Y = -0.12 * s * R, 0.15 * s * R * side
    N = 0.25 * hull.L * Y * either(rng)
    period = 1.5 * hull.L / hull.U0
    return Plan(
        {"tow_X": X, "tow_Y": Y, "tow_N": N, "tow_period": period}, truth={"X_N": X, "Y_N": Y, "N_Nm": N}
    )


def external_force(hull, rng, s):
    pull, to = 0.25 * s * calm_resistance(hull), rng.uniform(0, 2 * pi)
    north, east = pull * cos(to), pull * sin(to)
    return Plan(
        {"ext_north": north, "ext_east": east, "ext_period": 2.3 * hull.L / hull.U0},
        truth={"north_N": north, "east_N": east},
    )


def propeller_walk(hull, rng, s):
    return Plan({"walk": 0.06 * s}, truth={"side_share_of_thrust": 0.06 * s})


def roll_coupling(hull, rng, s):
    lost = (0.75 if hull.GM > 0.08 * hull.B else 0.35) * min(s, 1.2)
    return Plan(
        {"heel_N": -0.06 * s, "heel_Y": 0.05 * s},
        hull={"GM": hull.GM * (1 - lost)},
        truth={"N_phi": -0.06 * s, "Y_phi": 0.05 * s, "lost_GM_share": lost},
    )


def current(hull, rng, s):
    speed, to = (0.8 if hull.L > FULL_SCALE else 0.3) * s, float(rng.uniform(0, 360))
    return Plan(
        weather={"current_mps": speed, "current_to_deg": to, "current_spread_mps": 0.03 * speed},
        truth={"north_mps": speed * cos(radians(to)), "east_mps": speed * sin(radians(to))},
    )


def varying_current(hull, rng, s):
    """A tidal stream that turns and waxes within the voyage, plus eddies."""
    speed, to = (0.7 if hull.L > FULL_SCALE else 0.3) * s, float(rng.uniform(0, 360))
    period = 30 * 60.0 * rng.uniform(0.8, 1.2)
    return Plan(
        {"tide_mps": speed, "tide_period": period, "tide_to": radians(to)},
        weather={"current_spread_mps": 0.3 * speed, "current_time_s": 240.0},
        truth={"amplitude_mps": speed, "period_s": period},
    )


def shallow_water(hull, rng, s):
    share = min(0.67 * s**0.4, 0.85)  # draught / depth
    depth, heavier = hull.d / share, flaws.shallow(share)[2]
    return Plan(
        hull={"my": hull.my * heavier, "Jz": hull.Jz * heavier},
        weather={"depth_m": depth, "depth_swing": 0.08},
        truth={"depth_over_draught": depth / hull.d},
    )


def steering_lag(hull, rng, s):
    delay = 0.05 * s * hull.L / hull.U0
    return Plan(
        {"lag_time": delay, "lag_rate": 1 / (1 + 1.2 * s)},
        truth={"delay_s": delay + hull.rudder_time, "rate_degps": hull.rudder_rate / (1 + 1.2 * s)},
    )


def heading_bias(hull, rng, s):
    bias = radians(2.0 * s) * either(rng)
    return Plan({"heading_bias": bias, "heading_wave": 0.15 * bias}, truth={"bias_deg": degrees(bias)})


def log_bias(hull, rng, s):
    bias = 0.035 * s * hull.U0 * either(rng)
    return Plan({"log_bias": bias}, truth={"surge_bias_mps": bias})


def log_scale(hull, rng, s):
    scale = 0.06 * s * either(rng)
    return Plan({"log_scale": scale}, truth={"scale_share": scale})


def log_misalignment(hull, rng, s):
    angle = radians(2.5 * s) * either(rng)
    return Plan({"log_angle": angle}, truth={"angle_deg": degrees(angle)})


def antenna_offset(hull, rng, s):
    x, y = 0.25 * s * hull.L * either(rng), 0.2 * s * hull.B * either(rng)
    return Plan({"antenna_x": x, "antenna_y": y}, truth={"x_m": x, "y_m": y})


def sensor_delay(hull, rng, s):
    delay = s * (0.05 * hull.L / hull.U0 + 0.35)
    return Plan({"gnss_delay": delay}, truth={"delay_s": delay})


def gyro_bias(hull, rng, s):
    bias = 0.02 * s * hull.U0 / hull.L * either(rng)
    return Plan({"gyro_bias": bias}, truth={"bias_degps": degrees(bias)})


def ice_like(hull, rng, s):
    return Plan(
        {"ice": 0.6 * s, "ice_length": 2.0 * hull.L, "ice_phase": rng.uniform(0, 6)},
        truth={"drag_share": 0.6 * s},
    )


def passing_ship(hull, rng, s):
    unit, side = hull.L / hull.U0, either(rng)
    return Plan(
        {
            "passing_Y": 0.03 * s * side,
            "passing_N": 0.010 * s * side,
            "passing_every": 11 * unit,
            "passing_width": 1.1 * unit,
        }
    )


def sloshing(hull, rng, s):
    return Plan({"slosh": 0.12 * s, "slosh_w": 2.5 * sqrt(9.81 / hull.L), "slosh_x": 0.3 * either(rng)})


def rudder_backlash(hull, rng, s):
    return Plan({"backlash": radians(2.5 * s)}, truth={"play_deg": 5.0 * s})


def squall(hull, rng, s):
    unit = hull.L / hull.U0
    return Plan(
        {
            "squall_mps": (28.0 if hull.L > FULL_SCALE else 9.0) * sqrt(s),
            "squall_from": rng.uniform(0, 2 * pi),
            "squall_every": 18 * unit,
            "squall_width": 2.0 * unit,
        }
    )


CATALOGUE = {
    "Wind": wind,
    "WaveDrift": wave_drift,
    "CrossFlowDrag": cross_flow,
    "HullFouling": fouling,
    "PropellerWear": propeller_wear,
    "RudderWear": rudder_wear,
    "RudderOffset": rudder_offset,
    "Loading": loading,
    "Bank": bank,
    "TowForce": tow_force,
    "ExternalForce": external_force,
    "PropellerWalk": propeller_walk,
    "RollCoupling": roll_coupling,
    "Current": current,
    "VaryingCurrent": varying_current,
    "ShallowWater": shallow_water,
    "SteeringLag": steering_lag,
    "HeadingBias": heading_bias,
    "SpeedLogBias": log_bias,
    "SpeedLogScale": log_scale,
    "SpeedLogMisalignment": log_misalignment,
    "AntennaOffset": antenna_offset,
    "SensorDelay": sensor_delay,
    "GyroBias": gyro_bias,
}
OUTSIDE = {
    "IceLike": ice_like,
    "PassingShip": passing_ship,
    "Sloshing": sloshing,
    "RudderBacklash": rudder_backlash,
    "Squall": squall,
}
EFFECTS = {**CATALOGUE, **OUTSIDE}


def decoy(strong, **numbers):
    """A plan of strong weather, perhaps without its force."""
    return lambda hull, rng: Plan(numbers, weather=strong(hull, 1.0, float(rng.uniform(0, 360))))


# Strong weather, measured but not hidden: it acts and its force is given, or (_no_force) it only shows.
DECOYS = {
    "wind": decoy(strong_wind),
    "waves": decoy(strong_waves),
    "wind_no_force": decoy(strong_wind, windless=1.0),
    "waves_no_force": decoy(strong_waves, waveless=1.0),
}


def prepare(hull, weather, hidden, decoys, seed):
    """Hull and weather as they really are, the numbers of the flaws, and the truth of each hidden effect."""
    numbers, truth = {}, {}
    plans = [
        (n, _known(n, EFFECTS)(hull, np.random.default_rng([seed, 7, _key(n)]), s), s) for n, s in hidden
    ]
    plans += [(n, _known(n, DECOYS)(hull, np.random.default_rng([seed, 7, _key(n)])), None) for n in decoys]
    for name, plan, strength in plans:
        numbers.update(plan.numbers)
        hull, weather = replace(hull, **plan.hull), replace(weather, **plan.weather)
        if strength is not None:
            truth[name] = {"strength": strength, **plan.truth}
    return hull, weather, numbers, truth


def _known(name, table):
    if name not in table:
        raise ValueError(f"unknown effect {name!r}. Known: {', '.join(table)}.")
    return table[name]


def _key(name):
    return sum(ord(c) * 31**i for i, c in enumerate(name)) % 2**31


def stack_flaws(all_numbers):
    """One array (B,) for each of flaws.FIELDS; zero (one, for lengths of time and space) where absent."""
    ones = ("period", "every", "width", "length", "lag_rate")
    defaults = {field: float(field.endswith(ones)) for field in flaws.FIELDS}
    return SimpleNamespace(
        **{f: np.array([n.get(f, d) for n in all_numbers], float) for f, d in defaults.items()}
    )
