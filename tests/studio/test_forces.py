"""The missing force and a cause in the words of the bridge, against what is known to be there."""

import numpy as np
import pytest

from tests.live.actuators import PODS, craft
from twin.physics.model import Model
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.studio.causes import cause_view, number, ways, with_cause
from twin.studio.forces import autocorrelation, correlated, force_view
from twin.studio.project import BUNDLED
from twin.study.prediction.unexplained import energy, missing_force
from twin.study.reference.sailed import sailed

FOULED = {
    "effect": "HullFouling",
    "parameters": [{"name": "extra", "value": 0.32, "low95": 0.24, "high95": 0.4, "unit": "-"}],
}


@pytest.fixture(scope="module")
def monday():
    """(track, model) of the fouled tanker and its clean model."""
    ship = load(BUNDLED / "tanker.toml")
    return sailed(read_voyage(BUNDLED / "monday.mcap"), ship).track, Model.of(ship)


def test_what_a_fouled_hull_misses_acts_against_the_motion_and_goes_with_the_speed_squared(monday):
    view = force_view(*monday)
    test = view["tests"][0]
    squared = next(c for c in test["causes"] if c["cause"] == "speed squared [kn2]")
    assert view["mean"]["X_N"] < -3e5 and abs(view["mean"]["Y_N"]) < abs(view["mean"]["X_N"])
    assert squared["correlation"] < -0.6 and squared["p"] < 0.001 and test["independent_p"] < 0.001


def test_a_cause_of_one_thruster_is_a_model_to_predict_with():
    """Expected: the boat's model with the worn thruster; none with a cause that the boat cannot have."""
    boat = Model.of(craft(*PODS))
    worn = {"effect": "ThrusterWear.port", "parameters": [{"name": "loss", "value": 0.3, "unit": "-"}]}
    assert [type(e).__name__ for e in with_cause(boat, worn).effects] == ["ThrusterWear.port"]
    assert with_cause(boat, FOULED | {"effect": "PropellerWear"}) is None


def test_with_the_cause_the_missing_force_is_less(monday):
    track, model = monday
    better = with_cause(model, FOULED)
    before, after = missing_force(track, model), missing_force(track, better)
    assert abs(after.force[after.whole, 0].mean()) < 0.3 * abs(before.force[before.whole, 0].mean())
    assert energy([track], [better]).unexplained()["surge"] < energy([track], [model]).unexplained()["surge"]


def test_a_cause_is_told_in_the_words_of_the_bridge(monday):
    track, model = monday
    assert ways([track], with_cause(model, FOULED), "HullFouling") == ["against the motion"]
    told = cause_view([track], model, FOULED, 120.0)
    speed = told["changes"][0]
    assert (
        speed["what"] == "speed"
        and speed["unit"] == "kn"
        and speed["high95"] < speed["value"] < speed["low95"] < 0.0
    )
    assert (
        number(FOULED["parameters"][0])["value"] == pytest.approx(32.0)
        and number(FOULED["parameters"][0])["unit"] == "%"
    )
    current = {"name": "north", "value": 0.514444, "low95": 0.0, "high95": None, "unit": "m/s"}
    assert number(current)["value"] == pytest.approx(1.0, rel=1e-4) and number(current)["unit"] == "kn"


def test_noise_goes_with_nothing_and_what_persists_counts_as_few_samples():
    """Test: a thousand pairs of white noise, and of slow wandering. Expected: p below 0.05 in about 5 % of both."""
    rng = np.random.default_rng(1)
    for make in (
        lambda: rng.standard_normal(200),
        lambda: np.convolve(rng.standard_normal(204), np.ones(5), "valid"),
    ):
        p = np.array([correlated(make(), make())["p"] for _ in range(1000)])
        assert 0.02 < np.mean(p < 0.05) < 0.12
    assert autocorrelation(rng.standard_normal(5000))[1:] == pytest.approx(0.0, abs=0.06)
