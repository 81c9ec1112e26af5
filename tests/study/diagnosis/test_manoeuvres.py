"""The next manoeuvre: each can be sailed by any ship, and the advised one excites what it should."""

import numpy as np
import pytest

from bench.boats.actuator_questions import from_sheet
from twin.physics.effects import find
from twin.physics.model import Model
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.manoeuvres import (
    MANOEUVRES,
    HelmOrder,
    inputs,
    next_manoeuvre,
    reason,
    sail,
    sailed,
    separation,
    showing,
)
from twin.study.diagnosis.tell_diagnosis import to_sail
from twin.study.prediction.trial import shaft_speed

OF_ANY_SHIP = [name for name, m in MANOEUVRES.items() if m.alone is None and m.side is None]


@pytest.fixture(scope="module")
def case(case_of):
    return case_of("straight")


@pytest.mark.parametrize("name", OF_ANY_SHIP)
def test_the_ship_sails_every_manoeuvre(case, name):
    t = sail(case, case.model, MANOEUVRES[name])
    assert np.isfinite(t.state).all()
    assert t.state[:, 3].max() < 2.0 * float(case.model.ship.U_0)


def test_a_ship_with_wind_in_its_file_sails_where_none_was_recorded(tanker, voyages):
    calm = voyages["nothing"]
    columns = {name: x for name, x in calm.columns.items() if "wind" not in name}
    windy = tanker.with_effects(find("Wind").plausible(tanker))
    windless = assemble([calm.with_rows(calm.time_s, columns)], windy)
    assert sorted(sailed(windless, windless.model)) == sorted(OF_ANY_SHIP)


@pytest.mark.parametrize("name", OF_ANY_SHIP)
def test_a_model_that_runs_away_has_sailed_no_manoeuvre(case, name):
    """Test: a hull that pushes it on. Expected: a track that ends, and no advice that was made of it."""
    wild = case.model.but(find("TowForce").absent(case.model.ship).but(ahead=1e300))
    assert np.isnan(sail(case, wild, MANOEUVRES[name]).state[-1]).any()
    assert next_manoeuvre(case, wild, "HullFouling", "PropellerWear", np.ones(len(case.effects))) is None


def test_fouling_and_a_worn_propeller_are_told_apart_where_the_speed_changes(case):
    """At one speed more resistance and less thrust are the same; a ship that turns at constant power slows
    down, too."""
    z = np.ones(len(case.effects))
    advice = next_manoeuvre(case, case.model, "HullFouling", "PropellerWear", z)
    scores = {
        name: separation(case, t, "HullFouling", "PropellerWear", z)
        for name, t in sailed(case, case.model).items()
    }
    assert advice is not None
    assert advice["separates"] == ["HullFouling", "PropellerWear"]
    assert scores[advice["manoeuvre"]] == max(scores.values())
    assert scores["speed changes"] > np.log(1000.0)
    assert "to 1" in advice["why"]


def test_a_stream_may_be_the_rival_where_several_voyages_are_asked(case, tanker, voyages):
    """Test: the same question of one voyage and of two, each of which has a stream of its own. Expected: beside
    the first voyage's stream fouling is told apart by as much, and that stream itself shows."""
    several = assemble([voyages["straight"], voyages["nothing"]], tanker)

    def odds(case, *pair):
        z = np.ones(len(case.effects))
        return separation(case, sail(case, case.model, MANOEUVRES["speed changes"]), *pair, z)

    for pair in (("HullFouling", "Current"), ("Current", "HullFouling")):
        assert odds(several, *pair) == pytest.approx(odds(case, *pair), rel=0.2)


def test_where_nothing_shows_the_manoeuvre_is_one_that_would_show_more(case):
    """Test: a straight run, which shows nothing of the rudder. Expected: a manoeuvre that turns the ship, what it
    would show, and no word of two effects that nobody asked about; nothing where nothing is to be shown."""
    advice = showing(case, case.model, ["RudderWear", "RudderOffset"])
    assert "RudderWear" in advice["shows"] and advice["separates"] == []
    assert advice["manoeuvre"] in MANOEUVRES and "of the 2" in advice["why"]
    said = to_sail(advice)
    assert said.startswith("To see RudderWear") and advice["manoeuvre"] in said
    assert showing(case, case.model, []) is None


def test_a_model_that_can_be_sailed_through_one_manoeuvre_alone_has_it_named_without_another(tanker):
    model = Model.of(tanker)
    alone = reason({"zigzag 10/10": 3.0}, "zigzag 10/10", model)
    beside = reason({"zigzag 10/10": 3.0, "turning circles": 1.0}, "zigzag 10/10", model)
    assert "runs away" in alone and "next best" not in alone
    assert "next best: turning circles" in beside
    said = to_sail({"separates": ["Wind", "Current"], "manoeuvre": "zigzag 10/10", "why": beside})
    assert said.count("(") == said.count(")") == 1 and said.endswith(").")


def test_the_usual_power_of_a_ferry_whose_file_knows_the_wind_is_that_without_wind():
    """Test: a wind's force is part of the model, and no wind is told. Expected: as without the wind."""
    ferry = Model.of(from_sheet("ferry2"))
    windy = ferry.but(find("Wind").plausible(ferry.ship))
    assert 0.1 < shaft_speed(windy, 3.0) == shaft_speed(ferry, 3.0) < 1.0


def told_at(model, name, lengths):
    return inputs(model, MANOEUVRES[name], HelmOrder(lengths), 0.0, 0.5)["orders"]


def test_each_actuator_of_a_ship_with_two_screws_works_alone_in_turn():
    ferry = Model.of(from_sheet("ferry2"))
    early, late = (told_at(ferry, "one actuator at a time", s) for s in (2.0, 7.0))
    assert early["port.rate"] > 0.0 == early["starboard.rate"]
    assert late["starboard.rate"] == pytest.approx(early["port.rate"]) and late["port.rate"] == 0.0
    uneven = told_at(ferry, "uneven thrust", 2.0)
    assert uneven["starboard.rate"] == pytest.approx(0.6 * uneven["port.rate"])
    both = told_at(ferry, "zigzag 10/10", 5.0)
    assert both["port.rate"] == both["starboard.rate"] and both["bow.command"] == 0.0


def test_a_tunnel_thruster_pushes_to_each_side_at_low_speed():
    ferry = Model.of(from_sheet("ferry2"))
    a, b = (told_at(ferry, "side thrust at low speed", s)["bow.command"] for s in (2.0, 7.0))
    assert (a, b) == (-1.0, 1.0)


def test_no_ship_is_asked_to_sail_with_what_it_has_not(tanker):
    def asked(model):
        return {name for name, m in MANOEUVRES.items() if m.suits(model)}

    of_parts = {"one actuator at a time", "uneven thrust"}
    tunnels = {"side thrust at low speed"}
    assert asked(Model.of(tanker)) == set(MANOEUVRES) - of_parts - tunnels
    assert asked(Model.of(from_sheet("catamaran"))) == set(MANOEUVRES) - tunnels
    assert asked(Model.of(from_sheet("ferry2"))) == set(MANOEUVRES)


@pytest.mark.parametrize("name", ["zigzag 10/10", "zigzag 20/20"])
def test_azimuths_are_spoken_of_only_where_the_ship_has_some(tanker, name):
    """Test: a tanker with a rudder, a ferry with two screws and their rudders, and one with azimuths. Expected:
    that all azimuths work alike is said of the last alone."""
    ferry, azimuths = (Model.of(from_sheet(sheet)) for sheet in ("ferry2", "ferry4"))
    says = [reason({name: 3.0}, name, model) for model in (Model.of(tanker), ferry, azimuths)]
    assert ["azimuth" in said for said in says] == [False, False, True]
    assert all("deg of helm" in said for said in says)
