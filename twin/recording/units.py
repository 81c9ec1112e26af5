"""Units a file may use, as factors to the unit that ends a channel's name; how each scales to a ship."""

from math import pi

from twin.errors import SettingsError, did_you_mean

DEG_PER_RAD = 180.0 / pi
KNOT_MPS = 1852.0 / 3600.0

UNITS: dict[str, dict[str, float]] = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "d": 86400.0},
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048, "nmi": 1852.0},
    "mps": {"m/s": 1.0, "kn": KNOT_MPS, "km/h": 1.0 / 3.6, "ft/s": 0.3048, "cm/s": 1e-2, "mm/s": 1e-3},
    "deg": {"deg": 1.0, "rad": DEG_PER_RAD, "cdeg": 1e-2, "degE7": 1e-7},
    "degps": {"deg/s": 1.0, "deg/min": 1.0 / 60.0, "rad/s": DEG_PER_RAD},
    "rpm": {"rpm": 1.0, "1/min": 1.0, "1/s": 60.0, "Hz": 60.0, "rad/s": 30.0 / pi},
}
# the last part of an actuator's channel -> its unit
OF_ACTUATORS = {
    "command": "share",
    "pwm_us": "us",
    "rate_rpm": "rpm",
    "rate_rev_s": "rev_s",
    "thrust_n": "n",
    "angle_deg": "deg",
    "angle_rad": "rad",
    "pitch_ratio": "ratio",
}
UNITS |= {
    "share": {"share": 1.0, "%": 0.01},
    "us": {"us": 1.0, "ms": 1e3},
    "rev_s": {"1/s": 1.0, "rpm": 1.0 / 60.0, "rad/s": 0.5 / pi},
    "n": {"N": 1.0, "kN": 1e3, "kgf": 9.80665},
    "rad": {"rad": 1.0, "deg": pi / 180.0},
    "ratio": {"ratio": 1.0, "%": 0.01},
}
FROUDE_POWER = {
    "share": 0.0,
    "us": 0.0,
    "rev_s": -0.5,
    "n": 3.0,
    "rad": 0.0,
    "ratio": 0.0,
    "s": 0.5,
    "m": 1.0,
    "mps": 0.5,
    "deg": 0.0,
    "degps": -0.5,
    "rpm": -0.5,
}


def unit_of(name: str) -> str:
    """The unit a name ends with: `yaw_rate_degps` -> `degps`, `wave_period_peak_s` -> `s`."""
    if "." in name:
        return OF_ACTUATORS[name.rpartition(".")[2]]
    return name.rpartition("_")[2]


def factor(name: str, unit: str, where: str) -> float:
    """What a number in `unit` is multiplied by to become the channel `name`; `where` names the map.
    SettingsError: the channel cannot be in it."""
    known = UNITS[unit_of(name)]
    if unit not in known:
        raise SettingsError(f"{where}: {name} cannot be in {unit!r}.{did_you_mean(unit, known)}")
    return known[unit]


def froude(name: str, scale: float) -> float:
    """What a model's number is multiplied by for a ship `scale` times as long, at equal Froude number."""
    return scale ** FROUDE_POWER[unit_of(name)]
