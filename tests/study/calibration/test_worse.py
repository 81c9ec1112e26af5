"""A calibration that made its ship worse is not written, and says what to sail."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import twin
from twin.errors import DataError
from twin.physics.ship import load
from twin.study.calibration.worse import away_on_references, refusal, to_sail
from twin.study.reference.path_error import PathError

USV = load("usv")
SPEEDS, ZIGZAGS = (
    "speed changes from stop to full and back",
    "zigzags and full turns to both sides at two speeds",
)
ALONE = "stretches on which one actuator works alone"


def entry(horizon_s, before_m, position_m, before_deg=4.0, heading_deg=3.0):
    return {
        "horizon_s": horizon_s,
        "windows": 20,
        "before_m": before_m,
        "position_m": position_m,
        "before_deg": before_deg,
        "heading_deg": heading_deg,
    }


def test_an_error_that_fell_is_accepted():
    assert refusal(USV, [entry(10.0, 2.0, 1.0), entry(60.0, 9.0, 6.0)], ["Y_vv"]) == ""


def test_an_error_that_grew_names_its_horizon_before_and_after_and_the_manoeuvres():
    told = refusal(USV, [entry(10.0, 2.0, 2.1), entry(60.0, 9.0, 30.0, 4.0, 12.0)], ["X_uu", "port.gain"])
    assert "after 60 s" in told and "9.00 m" in told and "30.0 m" in told and "12.0 deg" in told
    assert "speed changes" in told and "one actuator works alone" in told and "zigzags" not in told


@pytest.mark.parametrize(
    ("unexcited", "told"),
    [
        (["kappa"], ZIGZAGS),
        (["K_T1", "gamma_v"], f"{SPEEDS} and {ZIGZAGS}"),
        (["K_T0", "X_uu"], SPEEDS),
        (["gamma_r", "N_r", "port.gain"], f"{ZIGZAGS} and {ALONE}"),
        ([], f"{SPEEDS} and {ZIGZAGS}"),
    ],
)
def test_what_is_to_be_sailed_shows_what_was_left_open(unexcited, told):
    """What a rudder does shows by its angle, what a screw does by its turns, and what one of several actuators does while
    it works alone."""
    assert to_sail(unexcited) == told


def test_a_model_that_runs_away_is_refused_though_most_numbers_fell():
    told = refusal(USV, [entry(10.0, 2.0, 0.5, 9.0, 1.0), entry(120.0, 40.0, 4.4e5, 90.0, 60.0)], ["Y_vv"])
    assert "runs away" in told and "440 km" in told and "zigzags" in told


def test_a_little_more_at_one_horizon_is_no_reason():
    assert refusal(USV, [entry(10.0, 1.0, 1.02), entry(60.0, 9.0, 6.0)], []) == ""


def test_where_nothing_could_be_judged_nothing_is_refused():
    assert refusal(USV, [entry(10.0, 2.0, 9.0) | {"windows": 0}], []) == ""


def test_a_better_heading_does_not_pay_for_a_place_worse_than_keeping_speed():
    worse = [entry(10.0, 0.4, 0.7, 41.0, 5.0), entry(60.0, 2.3, 10.0, 90.0, 13.0)]
    assert refusal(USV, worse, []) == ""
    told = refusal(USV, [e | {"kept_m": 0.2} for e in worse], ["Y_vv"])
    assert "worse than keeping its speeds (0.200 m)" in told and "10.0 m" in told


def test_of_a_boat_at_one_place_standing_still_is_what_it_must_not_be_worse_than():
    """Expected: refused though it is nearer than keeping its speeds, by the name of the nearer prediction."""
    worse = [
        entry(10.0, 0.10, 0.25, 41.0, 5.0) | {"kept_m": 0.3, "stood_m": 0.2},
        entry(60.0, 0.40, 1.50, 90.0, 13.0) | {"kept_m": 1.9, "stood_m": 0.7},
    ]
    told = refusal(USV, worse, ["Y_vv"])
    assert "worse than standing still (0.700 m)" in told and "keeping" not in told
    assert refusal(USV, [e | {"stood_m": 2.0} for e in worse], []) == ""


def test_under_way_it_is_keeping_its_speeds():
    worse = [entry(10.0, 0.4, 0.7, 41.0, 5.0) | {"kept_m": 0.2, "stood_m": 20.0}]
    assert "worse than keeping its speeds (0.200 m)" in refusal(USV, worse, [])


def test_a_ship_that_sails_straight_may_be_worse_than_keeping_speed_if_it_got_better():
    better = [entry(10.0, 0.7, 0.4) | {"kept_m": 0.1}, entry(60.0, 9.0, 6.0) | {"kept_m": 1.0}]
    assert refusal(USV, better, []) == ""


def test_a_place_that_grew_but_is_nearer_than_keeping_speed_is_judged_with_the_heading():
    assert refusal(USV, [entry(10.0, 0.4, 0.7, 41.0, 5.0) | {"kept_m": 3.0}], []) == ""


def with_errors(means_m):
    """A ship whose reference voyages, each left out in turn, were so far off after 10 and 60 s."""
    mean = np.column_stack([means_m, means_m, [0.01, 0.1]])
    sd = np.outer(means_m, np.ones(8))
    covariance = sd[:, :, None] * sd[:, None, :] * (0.2 * np.eye(8) + 0.8)
    path = PathError(np.array([10.0, 60.0]), covariance, np.full(2, 0.3), 6.0, mean, 5)
    return replace(USV, notes=dict(USV.notes) | {"structural": {"path_error": path.entry()}})


@pytest.mark.parametrize("after_60_s, away", [(25.0, False), (5.7e4, True)])
def test_a_model_that_runs_away_on_its_own_references_is_refused(after_60_s, away):
    """Test: what was held back fell, and the reference voyages, each left out in turn, end 25 m or 57 km off."""
    told = away_on_references(with_errors(np.array([2.0, after_60_s])), ["X_u"])
    assert bool(told) == away
    if away:
        assert "57.0 km" in told and "after 60 s" in told and "speed changes" in told
    assert away_on_references(USV, []) == ""


def test_a_voyage_of_another_ship_that_no_numbers_fit_is_refused_in_words():
    """Test: the tanker's Monday for a boat of 2 m. Expected: which voyage, which ship, and what a check of the
    data says of it; no error of the algebra."""
    monday = twin.read_voyage(Path(twin.__file__).parent / "voyages" / "monday.mcap")
    with pytest.raises(DataError, match=r"^monday: no numbers of USV, 2 m can.* propeller_rate: "):
        twin.calibrate(USV, [monday])
