"""The fleet of families: ships that are ships, mirrored alike, and hidden things that show."""

import argparse
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from bench.fleet import fleet_weather, hidden_causes, instrument_recording, run, sail, voyage_plan
from bench.fleet.answer_score import Share, each_gains, kind, right, wrong_names
from bench.fleet.answer_score import hidden_causes as hidden_causes_of
from bench.fleet.decision_fit import healthy_limits
from bench.fleet.fleet_legs import RUDDER, FleetLeg, zigzag
from bench.fleet.hull_families import FAMILIES
from bench.fleet.plausibility import build

SEED = 3


@pytest.fixture(scope="module")
def ships():
    return {family: build(family, SEED) for family in FAMILIES}


@pytest.mark.parametrize("family", FAMILIES)
def test_port_and_starboard_are_alike(ships, family):
    """Expected: the mirrored motion gives the same force ahead, and the others with the other sign."""
    ship = ships[family]
    hull, U, L = ship.hull, ship.p.U0, ship.p.L
    forces = []
    for side in (1.0, -1.0):
        hull.start()
        forces.append(hull.force(0.9 * U, side * 0.1 * U, side * 0.3 * U / L, side * 0.05, 0.1))
    (X, Y, N), (x, y, n) = forces
    assert (
        pytest.approx(x, rel=1e-9) == X
        and pytest.approx(-y, rel=1e-9) == Y
        and pytest.approx(-n, rel=1e-9) == N
    )


@pytest.mark.parametrize("family", FAMILIES)
def test_a_ship_goes_as_fast_as_its_shaft_was_balanced_for(ships, family):
    """Test: straight ahead in calm water, from service speed. Expected: it stays there within a tenth."""
    ship = ships[family]
    true = sail.sail(ship, [], fleet_weather.FleetWeather(), 20 * ship.p.unit_s, 1)
    assert true["u"][-1] == pytest.approx(ship.p.U0, rel=0.1)


@pytest.mark.parametrize("family", FAMILIES)
def test_place_and_heading_are_those_of_the_motion_and_no_later(ships, family):
    """Test: a zigzag. Expected: heading and place are the integrals of rate of turn and velocity, to a hundredth of
    the step that the ship is sailed with."""
    ship = ships[family]
    true = sail.sail(ship, zigzag(20), fleet_weather.FleetWeather(stream=0.5), 40 * ship.p.unit_s, 1)
    psi, dt = np.unwrap(true["psi"]), true["t"][1]
    way = (true["u"] + 1j * true["v"]) * np.exp(1j * psi)
    for shown, rate in ((psi, true["r"]), (true["x"] + 1j * true["y"], way)):
        went = np.concatenate([[0.0], np.cumsum(0.5 * dt * (rate[1:] + rate[:-1]))])
        off = shown - shown[0] - went
        varied, at = rate - rate.mean(), off - np.polyval(np.polyfit(true["t"], off, 1), true["t"])
        assert abs(np.vdot(varied, at) / np.vdot(varied, varied)) < 0.01 * dt, family


def test_a_turn_to_starboard_rolls_a_ship_to_port_and_carries_its_antenna_there(ships):
    """Expected: roll, positive to starboard, below none; the antenna that stands high is to port of where one on
    deck is, by its height times the sine of the roll."""
    ship = ships["heeling"]
    kit = replace(ship.kit, has_roll=True, gnss=0.0, gnss_wander=0.0, gnss_late=0.0, coarse=False, lost=0.0)
    true = sail.sail(
        ship, [FleetLeg(RUDDER, 500, np.radians(15))], fleet_weather.FleetWeather(), 30 * ship.p.unit_s, 1
    )
    assert true["r"][-1] > 0.0
    places = []
    for high in (0.0, 20.0):
        own = replace(ship, kit=replace(kit, high=high, every_s=1.0))
        places.append(instrument_recording.record(own, true, fleet_weather.FleetWeather(), 1)[1])
    roll, psi = np.radians(places[0]["roll_deg"][-1]), np.radians(places[0]["heading_true_north_deg"][-1])
    moved = [places[1][n][-1] - places[0][n][-1] for n in ("north_m", "east_m")]
    aside = moved[1] * np.cos(psi) - moved[0] * np.sin(psi)
    assert roll < 0.0 and aside == pytest.approx(20.0 * np.sin(roll), rel=0.2)


@pytest.mark.parametrize("name", hidden_causes.EVERY)
def test_what_is_hidden_shows_at_a_plain_size(ships, name):
    """Test: the same zigzag and noise with it and without. Expected: a column that a bridge reads differs by more
    than rounding."""
    ship = next(s for f, s in ships.items() if f != "planing")
    kit = ship.kit
    ship = type(ship)(**{**ship.__dict__, "kit": type(kit)(**{**vars(kit), "has_log": True})})
    change = hidden_causes.EVERY[name](ship.p, ship.drive, np.random.default_rng(1), 1.5)
    flaws = hidden_causes.Flaws(**change.flaws)
    read = []
    for f, w in ((hidden_causes.Flaws(), {}), (flaws, change.weather)):
        true = sail.sail(
            ship,
            zigzag(20),
            fleet_weather.stronger(fleet_weather.FleetWeather(), **w),
            40 * ship.p.unit_s,
            7,
            f,
        )
        read.append(instrument_recording.record(ship, true, fleet_weather.FleetWeather(), 7, f)[1])
    most = max(
        float(np.nanmax(np.abs(read[0][c] - read[1][c])) / (np.nanstd(read[0][c]) + 1e-9))
        for c in read[0]
        if c not in ("heading_true_north_deg", "true_wind_direction_deg")
    )
    turned = read[0]["heading_true_north_deg"] - read[1]["heading_true_north_deg"]
    turned = float(np.percentile(np.abs((turned + 180) % 360 - 180), 90))
    assert most > 0.05 or turned > 0.5


def test_a_case_is_the_same_whenever_it_is_sailed(ships):
    ship = ships["modulus"]
    case = voyage_plan.plan(ship)[0]
    one, two = voyage_plan.sailed(ship, case), voyage_plan.sailed(ship, case)
    assert all(np.array_equal(one.columns[c], two.columns[c], equal_nan=True) for c in one.columns)


def test_a_stuck_rudder_hides_nothing_where_its_own_angle_is_recorded(ships, monkeypatch):
    """Test: a stuck rudder on every voyage, of a ship that records the order and of one that records the
    rudder. Expected: outside the catalogue, and a healthy ship that was steered so."""
    monkeypatch.setattr(hidden_causes, "OUTSIDE", {"StuckRudder": hidden_causes.OUTSIDE["StuckRudder"]})
    monkeypatch.setattr(voyage_plan, "SHARES", {"outside": 1.0})
    ship = ships["modulus"]
    for ordered, hidden in ((True, "outside"), (False, "nothing")):
        cases = voyage_plan.plan(replace(ship, drive=replace(ship.drive, ordered=ordered)))
        assert {(c.kind, *c.hidden) for c in cases} == {(hidden, "StuckRudder")}


def test_wilsons_interval_by_hand():
    """Expected: 8 of 10 lies between 0.490 and 0.943 (Wilson 1927; z = 1.96)."""
    assert Share(8, 10).interval() == pytest.approx((0.490, 0.943), abs=1e-3)


def test_a_cause_too_many_makes_an_answer_wrong_and_weather_does_not():
    row = {"kind": "single", "hidden": {"HullFouling": 1.0}, "verdict": "missing", "weather": []}
    assert right(row | {"missing": ["HullFouling", "Wind"]})
    assert not right(row | {"missing": ["HullFouling", "GyroBias"]})
    assert not right(row | {"missing": []})


def test_a_slow_compass_has_a_name_by_now_and_beside_another_it_is_wrong():
    row = {"kind": "outside", "hidden": {"SlowCompass": 1.0}, "verdict": "missing", "weather": []}
    assert right(row | {"missing": ["HeadingLag", "Wind"]}) and not wrong_names(
        row | {"missing": ["HeadingLag"]}
    )
    assert not right(row | {"missing": ["HeadingLag", "SensorDelay"]})
    assert not right(row | {"missing": ["SensorDelay"]})
    assert not right(row | {"missing": [], "verdict": "unknown"})
    outside = row | {"hidden": {"Ice": 1.0}}
    assert not right(outside | {"missing": ["HeadingLag"]})
    assert right(outside | {"missing": [], "verdict": "unknown"})
    assert (kind(row), kind(outside)) == ("by now", "outside")


def test_weather_that_is_told_is_right_but_beside_something_unknown_it_is_not():
    row = {"kind": "single", "hidden": {"Current": 1.0}, "missing": [], "verdict": "undecided"}
    told = row | {"weather": [{"effect": "VaryingCurrent", "probability": 0.9}]}
    assert right(told) and not right(told | {"verdict": "unknown"})
    assert not right(row | {"weather": [{"effect": "VaryingCurrent", "probability": 0.3}]})


def test_two_causes_pay_where_both_were_asked_and_weather_is_none():
    row = {"kind": "pair", "hidden": {"HullFouling": 1.0, "GyroBias": 1.0}}
    assert each_gains(row | {"oracle": {"gain_by_each": {"HullFouling": 0.2, "GyroBias": 0.1}}})
    assert not each_gains(row | {"oracle": {"gain_by_each": {"HullFouling": 0.2, "GyroBias": 0.09}}})
    mixed = row | {"hidden": {"HullFouling": 1.0, "Current": 1.0}}
    assert not each_gains(mixed | {"oracle": {"gain_by_each": {"HullFouling": 0.2}}})
    assert not each_gains(row | {"oracle": None})


def test_a_stuck_rudder_that_hides_nothing_is_no_cause_and_counts_for_no_effect():
    row = {"kind": "nothing", "hidden": {"StuckRudder": 1.0}}
    assert hidden_causes_of(row) == set()
    assert hidden_causes_of({"kind": "outside", "hidden": {"RateScale": 1.0}}) == {"RateScale", "GyroScale"}


def test_cross_flow_drag_on_a_hull_is_alike_fore_and_aft(ships):
    """Test: a plain cross-flow drag, on a ship that drifts and does not turn. Expected: a side force, and no moment
    about midship."""
    ship = ships["modulus"]
    flaws = hidden_causes.Flaws(cross_flow=1.0)
    strips = sail.cross_flow_strips(flaws, ship.p.L)
    drag = np.array([k for _, k in strips])
    assert len(strips) == 10 and drag.min() > 0.0
    assert np.dot([x for x, _ in strips], drag) == pytest.approx(0.0, abs=1e-9 * ship.p.L)


def test_what_healthy_voyages_end_within_leaves_each_form_of_hull_out():
    """Test: healthy voyages of one form that end within 0.00 to 1.00 of what is expected, of another at 3, and
    one with something hidden. Expected: 98 of 100 within 0.98 without the other form."""
    row = lambda family, error, kind="nothing": {
        "family": family, "kind": kind, "read": SimpleNamespace(error_nothing=error)
    }  # fmt: skip
    rows = [row("near", k / 100) for k in range(101)] + [row("far", 3.0)] * 9 + [row("near", 9.0, "single")]
    limits = healthy_limits(rows)
    assert limits["far"] == pytest.approx(0.98) and limits["near"] == limits[""] == pytest.approx(3.0)


@pytest.mark.parametrize("seeds", ["x", "0-y"])
def test_seeds_that_are_no_numbers_are_one_line_that_shows_how_they_are_written(seeds, capsys):
    parser = argparse.ArgumentParser()
    run.add_arguments(parser)
    with pytest.raises(SystemExit):
        parser.parse_args(["folder", "--seeds", seeds])
    assert f"{seeds!r} is no FIRST-LAST, as in 0-3" in capsys.readouterr().err
