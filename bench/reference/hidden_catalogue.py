"""The effects that can be hidden in the truth: size at strength 1, and what a study may compare with.

Each entry takes (hull, rng, strength) and returns a Plan: numbers for flaws.py, changes of hull and
weather, truth. Environment effects change the weather; a voyage that does not hide them is calm.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from bench.reference import flaws
from bench.reference.hidden_forces import (
    bank,
    cross_flow,
    current,
    external_force,
    fouling,
    loading,
    propeller_walk,
    propeller_wear,
    roll_coupling,
    rudder_offset,
    rudder_wear,
    shallow_water,
    steering_lag,
    tow_force,
    varying_current,
    wave_drift,
    wind,
)
from bench.reference.hidden_instruments import (
    antenna_offset,
    gyro_bias,
    heading_bias,
    log_bias,
    log_misalignment,
    log_scale,
    sensor_delay,
)
from bench.reference.hidden_outside import ice_like, passing_ship, rudder_backlash, sloshing, squall
from bench.reference.hidden_plan import Plan
from bench.reference.weather import strong_waves, strong_wind

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
