"""Units a file may use, as factors to the unit that ends a channel's name; how each scales to a ship."""

from math import pi

from twin.errors import SettingsError, did_you_mean

DEG_PER_RAD = 180.0 / pi
KNOT_MPS = 1852.0 / 3600.0

UNITS: dict[str, dict[str, float]] = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "ft": 0.3048, "nmi": 1852.0},
    "mps": {"m/s": 1.0, "kn": KNOT_MPS, "km/h": 1.0 / 3.6, "ft/s": 0.3048},
    "deg": {"deg": 1.0, "rad": DEG_PER_RAD, "cdeg": 1e-2, "degE7": 1e-7},
    "degps": {"deg/s": 1.0, "deg/min": 1.0 / 60.0, "rad/s": DEG_PER_RAD},
    "rpm": {"rpm": 1.0, "1/min": 1.0, "1/s": 60.0, "Hz": 60.0, "rad/s": 30.0 / pi},
}
FROUDE_POWER = {"s": 0.5, "m": 1.0, "mps": 0.5, "deg": 0.0, "degps": -0.5, "rpm": -0.5}


def unit_of(name: str) -> str:
    """The unit a name ends with: `yaw_rate_degps` -> `degps`, `wave_period_peak_s` -> `s`."""
    return name.rpartition("_")[2]


def factor(name: str, unit: str, where: str) -> float:
    """What a number in `unit` is multiplied by to become the channel `name`; `where` names the map."""
    known = UNITS[unit_of(name)]
    if unit not in known:
        raise SettingsError(f"{where}: {name} cannot be in {unit!r}.{did_you_mean(unit, known)}")
    return known[unit]


def froude(name: str, scale: float) -> float:
    """What a model's number is multiplied by for a ship `scale` times as long, at equal Froude number."""
    return scale ** FROUDE_POWER[unit_of(name)]
