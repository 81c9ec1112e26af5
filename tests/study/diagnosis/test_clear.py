"""How clear the numbers of an effect are, and how far from what the ship's file has."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from twin.physics.effects import catalogue
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.clear import change, significance
from twin.study.diagnosis.refine import refine
from twin.study.estimation.columns import Unknown


@pytest.fixture(scope="module")
def judged(tanker, voyages):
    case = assemble([voyages["RudderWear"]], tanker)
    return case, refine(case, ("RudderWear",), "usual", np.ones(len(case.effects)), ())[0]


@pytest.mark.parametrize(
    "delay, travel_time, other", [(1.0, 25.0, 0.67), (1.5, 31.0, 2.4), (4.0, 25.0, 3.33), (1.5, 25.0, 0.0)]
)
def test_how_far_what_the_ship_has_is_from_its_file_over_what_its_form_may_be_off(delay, travel_time, other):
    """Test: a gear in the ship's file, 1.5 s and 25 s; its dead time may be off by half, the other by a tenth
    (one standard deviation)."""
    own = [
        Unknown("SteeringLag", name, "s", centre, sd, 0.0, 300.0)
        for name, centre, sd in (("delay", 1.5, 0.5), ("travel_time", 25.0, 10.0))
    ]
    z = np.array([(value - u.centre) / u.sd for value, u in zip((delay, travel_time), own, strict=True)])
    found = SimpleNamespace(posterior=SimpleNamespace(z=z))
    case = SimpleNamespace(present={"SteeringLag"}, catalogue=catalogue(), effects=own)
    assert change(case, found, "SteeringLag") == pytest.approx(other, abs=0.01)
    assert change(SimpleNamespace(present=set()), found, "SteeringLag") == 0.0


def test_how_clear_an_effect_is_tells_its_clearest_number(judged):
    """Test: two numbers known to 0.2 each, at 0.7 and 0.1. Expected: three and a half standard deviations."""
    case, found = judged
    rows = [i for i, u in enumerate(case.effects) if u.owner == "SensorDelay"]
    z, covariance = np.zeros(len(case.effects)), np.eye(len(case.effects))
    covariance[np.ix_(rows, rows)] = 0.04 * np.eye(len(rows))
    z[rows[:2]] = 0.7, 0.1
    assert significance(
        case, replace(found, posterior=replace(found.posterior, z=z, covariance=covariance)), "SensorDelay"
    ) == pytest.approx(3.5)
