"""A digital twin of a ship's motion that runs on board in real time and that its owner can correct.

    ship = twin.Ship.load("alma.toml")
    calm = twin.read_voyages("calm/*.mcap")
    fit = twin.calibrate(ship, calm)
    june = twin.read_voyage("june.csv", map="map.toml")
    found = twin.diagnose(fit.ship, june)

One order of arguments everywhere: ship, voyages, then keywords. Names load when they are first used, so that
`import twin` costs nothing and the loop on board stays light.
"""

import importlib
from typing import Any

__version__ = "0.2.0"

PUBLIC = {  # name -> the module that holds it
    "Calibration": "twin.api.calibration",
    "Comparison": "twin.api.comparison",
    "Diagnosis": "twin.api.diagnosis",
    "EffectCheck": "twin.api.effect_check",
    "FirstModel": "twin.api.first_model",
    "Fleet": "twin.api.fleet",
    "InstrumentCheck": "twin.api.instruments",
    "Ship": "twin.physics.ship",
    "Simulation": "twin.api.simulation",
    "TubeCalibration": "twin.api.tube",
    "Update": "twin.api.update",
    "Voyage": "twin.recording.voyage",
    "VoyageCheck": "twin.api.voyage_check",
    "add": "twin.api.update",
    "calibrate": "twin.api.calibration",
    "catalogue": "twin.physics.effects",
    "check_effect": "twin.api.effect_check",
    "check_voyage": "twin.api.voyage_check",
    "compare": "twin.api.comparison",
    "diagnose": "twin.api.diagnosis",
    "first_model": "twin.api.first_model",
    "fleet": "twin.api.fleet",
    "instruments": "twin.api.instruments",
    "read_voyage": "twin.api.voyages",
    "read_voyages": "twin.api.voyages",
    "remove": "twin.api.update",
    "simulate": "twin.api.simulation",
    "suggest_map": "twin.api.voyage_check",
    "tube": "twin.api.tube",
}
__all__ = ["__version__", *PUBLIC]


def __getattr__(name: str) -> Any:
    """A public name, from its module, once."""
    if name not in PUBLIC:
        raise AttributeError(f"module 'twin' has no attribute {name!r}. It has: {', '.join(sorted(PUBLIC))}.")
    value = getattr(importlib.import_module(PUBLIC[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *PUBLIC])
