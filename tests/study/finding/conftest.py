"""Voyages of the reference sea with something hidden in them, and the tanker that was calibrated on calm ones."""

import pytest

from bench.bundled import recorded
from bench.reference import Case, simulate
from twin.physics.ship import load
from twin.study.story import SHIP

HIDDEN = {
    "nothing": (),
    "HeadingBias": (("HeadingBias", 1.0),),
    "Current": (("Current", 1.0),),
    "RudderWear": (("RudderWear", 1.0),),
    "SteeringLag": (("SteeringLag", 1.0),),
    "IceLike": (("IceLike", 1.0),),
    "Wind": (("Wind", 1.0),),
    "Wind again": (("Wind", 1.0),),
    "RudderBacklash": (("RudderBacklash", 1.0),),
    "Sloshing": (("Sloshing", 1.0),),
}


@pytest.fixture(scope="session")
def tanker():
    return load(SHIP)


@pytest.fixture(scope="session")
def voyages():
    """One 20 min voyage for each name in HIDDEN, a straight one, and two to calibrate on; every second a sample."""
    cases = {name: Case("kvlcc2", "mixed", hidden=h, seed=900 + i, duration_s=1200.0) for i, (name, h) in enumerate(HIDDEN.items())}
    cases["straight"] = Case("kvlcc2", "straight", seed=950, duration_s=1200.0)
    cases["calm"] = Case("kvlcc2", "zigzag_20", seed=960, duration_s=1200.0)
    cases["calm too"] = Case("kvlcc2", "speed_changes", seed=961, duration_s=1200.0)
    sailed = simulate(list(cases.values()))
    return {name: recorded(name, r.columns, every=10) for name, r in zip(cases, sailed, strict=True)}
