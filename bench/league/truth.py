"""The truth beside the diagnosis' numbers: where the reference sea's form and the catalogue's allow a
comparison."""

from collections.abc import Callable
from math import radians
from typing import Any, NamedTuple


class ComparedTruth(NamedTuple):
    """`of(truth)`: what the parameter should be; `size(truth)`: the effect's own size, by which its error is
    divided."""

    effect: str
    parameter: str
    of: Callable[[dict[str, Any]], float]
    size: Callable[[dict[str, Any]], float]


def _same(effect: str, parameter: str, key: str, factor: float = 1.0) -> ComparedTruth:
    def of(truth: dict[str, Any]) -> float:
        return factor * float(truth[key])

    return ComparedTruth(effect, parameter, of, lambda truth: abs(of(truth)))


def _vector(effect: str, names: dict[str, str]) -> list[ComparedTruth]:
    """Components of one vector: errors are divided by its length."""

    def length(truth: dict[str, Any]) -> float:
        return float(sum(truth[key] ** 2 for key in names.values()) ** 0.5)

    return [ComparedTruth(effect, p, lambda t, k=key: float(t[k]), length) for p, key in names.items()]  # type: ignore[misc]


TABLE: list[ComparedTruth] = [
    *_vector("Current", {"north": "north_mps", "east": "east_mps"}),
    *_vector("ExternalForce", {"north": "north_N", "east": "east_N"}),
    *_vector("TowForce", {"ahead": "X_N", "starboard": "Y_N"}),
    *_vector("AntennaOffset", {"ahead": "x_m", "starboard": "y_m"}),
    _same("TowForce", "turning", "N_Nm"),
    _same("CrossFlowDrag", "c_d", "drag_coefficient"),
    _same("HullFouling", "extra", "added_resistance_share"),
    _same("PropellerWear", "loss", "lost_thrust_share"),
    _same("RudderWear", "loss", "lost_effectiveness_share"),
    _same("RudderOffset", "offset", "offset_deg", radians(1.0)),
    _same("Loading", "mass", "mass_share"),
    _same("Loading", "draught", "draught_share"),
    _same("Loading", "x_G", "x_G_shift_m"),
    ComparedTruth(
        "SteeringLag", "travel_time", lambda t: 65.0 / t["rate_degps"], lambda t: 65.0 / t["rate_degps"]
    ),
    _same("SteeringLag", "delay", "delay_s"),
    _same("HeadingBias", "bias", "bias_deg", radians(1.0)),
    _same("SpeedLogBias", "bias", "surge_bias_mps"),
    _same("SpeedLogScale", "scale", "scale_share"),
    _same("SpeedLogMisalignment", "angle", "angle_deg", radians(1.0)),
    _same("SensorDelay", "delay", "delay_s"),
    _same("GyroBias", "bias", "bias_degps", radians(1.0)),
]


def beside(effect: str, parameters: list[dict[str, Any]], truth: dict[str, Any]) -> list[dict[str, Any]]:
    """Each parameter that can be compared: its value, whether its interval holds the truth, its error as a
    share of the effect."""
    given = {p["name"]: p for p in parameters}
    out = []
    for c in TABLE:
        if c.effect == effect and c.parameter in given:
            p, true = given[c.parameter], c.of(truth)
            error = abs(p["value"] - true) / max(c.size(truth), 1e-12)
            covered = p["low95"] <= true <= p["high95"]
            out.append(
                {
                    "name": f"{effect}.{c.parameter}",
                    "value": p["value"],
                    "truth": true,
                    "error": error,
                    "covered": covered,
                }
            )
    return out
