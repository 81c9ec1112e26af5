"""What is recorded of a thruster is its order: the lag between that and its thrust is found on the references
and becomes a part of the boat's model. The boats sail by equations that share no line with the twin."""

import numpy as np
import pytest

from bench.small_boats import sailed, ship_of
from tests.thorough import thorough
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.ship import load, save
from twin.study.calibration.calibration_lines import terminal_lines
from twin.study.calibration.core_fit import fitted_core
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.linear import linearise
from twin.study.estimation.respond import advance
from twin.study.reference.nuisance import TEMPER
from twin.study.reference.sailed import sailed as tracked
from twin.study.reference.steering_gear import (
    LATER,
    SLOWER,
    gear_unknowns,
    geared,
    gears_of,
    not_behind,
    with_or_without_gear,
)
from twin.study.track.track import track

BOAT, BOAT_SEED, SECONDS = "thrusters", 3, 60.0
BOTH = {"port": 0.4, "starboard": 0.4}


def voyages(lags_s):
    """Two of the same boat, whose thrusters are so many seconds behind their orders."""
    return [sailed(BOAT, seed, SECONDS, BOAT_SEED, lags_s) for seed in (1, 2)]


def found(lags_s):
    """The lags that the voyages ask for, by name."""
    ship = ship_of(BOAT)
    model = Model.of(ship)
    tracks = [track(v, ship) for v in voyages(lags_s)]
    fit = with_or_without_gear(tracks, model, core_unknowns(model), of_ship(ship), TEMPER)
    return {type(e).__name__: e.values() for e in fit.model.lags}


@thorough
def test_thrusters_that_lag_alike_share_one_lag():
    lags = found(BOTH)
    assert list(lags) == ["ActuatorLag.port", "ActuatorLag.starboard"]
    port, starboard = lags.values()
    assert port == starboard
    # believed to be 0.09 s or so before the voyages
    assert 0.2 < port["delay"] + port["ease"] < 0.5


def test_thrusters_that_lag_otherwise_have_a_lag_each():
    port, starboard = found({"port": 0.1, "starboard": 0.7}).values()
    assert starboard["delay"] + starboard["ease"] > 0.3 > 0.2 > port["delay"] + port["ease"]


def test_of_thrusters_that_hardly_lag_nothing_is_believed():
    assert not found({"port": 0.05, "starboard": 0.05})


def test_like_actuators_stand_together_and_others_alone():
    assert [len(g) for g in gears_of(ship_of("screws and bow thruster"))] == [2, 1]
    assert [[e.__name__ for e in g] for g in gears_of(load("kvlcc2"))] == [["SteeringLag"]]


@pytest.mark.parametrize("kind", ["screws and bow thruster", "azimuths"])
def test_what_a_lag_leaves_as_it_is_is_what_is_taken_over_from_the_model_without_it(kind):
    """Expected: the columns that are not made anew are the same behind a gear, and those of its actuators are not."""
    ship = ship_of(kind)
    model, t = Model.of(ship), track(sailed(kind, 1, SECONDS, BOAT_SEED), ship)
    unknowns, gears = core_unknowns(model), gears_of(ship)[0]
    slow = (g.plausible(ship) for g in gears)
    behind = model.but(*(lag.but(delay=2.0 * lag.delay, ease=2.0 * lag.ease) for lag in slow))
    before, after = (linearise(t, m, unknowns, of_ship(ship)) for m in (model, behind))
    same = not_behind(gears, unknowns, ship)
    assert "N_ur" in (names := [unknowns[j].name for j in same])
    assert "X_udot" not in names and not any(n.startswith(gears[0].actuator) for n in names)
    for j in range(len(unknowns)):
        a, b = before.A[:, :, j], after.A[:, :, j]
        change = np.abs(a - b).max() / max(np.abs(a).max(), 1e-12)
        assert j not in same or change < 1e-6, unknowns[j].label
    like = linearise(t, behind, unknowns, of_ship(ship), like=before.only(np.array(same)), same=same)
    np.testing.assert_allclose(like.A, after.A, rtol=1e-5, atol=1e-6 * np.abs(after.A).max())
    np.testing.assert_array_equal(like.e, after.e)
    assert np.abs(before.A - after.A).max() > 1e-3 * np.abs(after.A).max()


def test_the_numbers_of_a_shared_lag_are_asked_once_and_of_lags_that_differ_each():
    ship = ship_of(BOAT)
    port, starboard = (e.absent(ship).but(ease=0.2) for e in gears_of(ship)[0])
    assert not gear_unknowns(Model.of(ship))
    shared = gear_unknowns(Model.of(ship).but(port, starboard))
    assert [u.label for u in shared] == ["ActuatorLag.port.delay", "ActuatorLag.port.ease"]
    assert all(u.also == ("ActuatorLag.starboard",) for u in shared)
    assert len(gear_unknowns(Model.of(ship).but(port, starboard.but(ease=0.3)))) == 4


def test_a_lag_of_two_is_the_lag_of_each_and_is_looked_for_no_more():
    """Test: one lag of two alike, beside a lag of each that is as long. Expected: the same accelerations; what
    calibrates looks for no gear of theirs beside it."""
    ship = ship_of(BOAT)
    model, t = Model.of(ship), track(sailed(BOAT, 1, SECONDS, BOAT_SEED), ship)
    each = model.but(*(e.absent(ship).but(delay=0.1, ease=0.3) for e in gears_of(ship)[0]))
    both = model.but(of_ship(ship)["ActuatorLag.port+starboard"].absent(ship).but(delay=0.1, ease=0.3))
    np.testing.assert_array_equal(advance(t, both), advance(t, each))
    assert np.abs(advance(t, both) - advance(t, model)).max() > 0.0
    assert geared(both, [t], core_unknowns(both), of_ship(ship), TEMPER) is both


@pytest.fixture(scope="module")
def calibrated(tmp_path_factory):
    """A boat calibrated on two voyages: (what was told, ship file)."""
    fitted = [tracked(v, ship_of(BOAT)) for v in voyages(BOTH)]
    made = fitted_core(fitted, [(fitted[1].track, 0)], ship_of(BOAT), by="steps").calibrated()
    save(made.ship, out := tmp_path_factory.mktemp("lag") / "boat.toml")
    return made.result | {"held_out_is": "", "doubts": [], "data_checks": []}, load(out)


@thorough
def test_the_lag_stands_in_the_ship_file_and_in_what_calibrate_says(calibrated):
    said, boat = calibrated
    lags = {type(e).__name__: e for e in boat.effects}
    assert set(lags) == set(said["actuator_lags"]) == {"ActuatorLag.port", "ActuatorLag.starboard"}
    for name, numbers in said["actuator_lags"].items():
        assert numbers["ease"]["value"] == lags[name].ease > 0.0 and numbers["ease"]["sd"] > 0.0
    assert set(lags) <= set(boat.notes["structural"]["beside_effects"])
    for name in BOTH:
        assert any(
            line.startswith(f"  {name} lags behind what was recorded of it") for line in terminal_lines(said)
        )


@pytest.mark.parametrize("name", ["kvlcc2", "container", "usv"])
def test_the_gears_that_are_tried_before_a_rudder_are_to_the_last_digit_as_they_were(name):
    """Expected: what was tried when no other actuator was asked, in L/U_0."""
    ship = load(name)
    time, gear = float(ship.scale("time")), gears_of(ship)[0][0].plausible(ship)
    assert [k * gear.travel_time for k in SLOWER] == [k * time for k in (0.35, 0.7, 1.4, 2.8)]
    assert [k * gear.delay for k in LATER] == [k * time for k in (0.05, 0.1, 0.2)]
    assert gear.ease == 0.0
