"""A voyage of another ship is noticed by what its shaft and its rudder do to it; one of its own is not."""

import numpy as np
import pytest

import twin
from twin.physics.effects import find
from twin.physics.model import Model
from twin.recording.checks import of_voyages, run_checks, whose
from twin.recording.checks.other_ship import other_ship
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.voyage import Voyage
from twin.study.prediction.trial import sail, shaft_speed

LENGTH_M = {"container": 175.0, "kvlcc2": 320.0, "kvlcc2_model": 7.0, "usv": 2.0, "coaster": 110.0}
HULLS = ("container", "kvlcc2", "kvlcc2_model", "usv")
APART = [  # (the file's, the one that sailed), one at least twice as long as the other
    (file, other) for file in HULLS for other in LENGTH_M if not 0.5 < LENGTH_M[other] / LENGTH_M[file] < 2.0
]
LENGTHS = 40.0  # that a voyage lasts


def coaster():
    """A ship of 110 m, of the particulars that its owner has."""
    known = {"block_coefficient": 0.72, "service_speed_mps": 6.5, "shaft_speed_rpm": 150.0}
    return twin.first_model("coaster", 110.0, 17.0, 6.2, **known, propeller_diameter_m=3.5).ship


def zigzag(ship, name, straight=False):
    """A zigzag of 15 deg by the ship's own model, with straight legs between, and a little noise."""
    model, orders, side = Model.of(ship), [], [1.0]

    def steer(state):
        psi = np.degrees(state[2])
        side[0] = -side[0] if side[0] * psi > 15.0 else side[0]
        orders.append(0.0 if straight or len(orders) % 1500 < 400 else side[0] * np.radians(15.0))
        return orders[-1]

    n, speed = shaft_speed(model, float(ship.U_0)), float(ship.U_0)
    log = sail(model, steer, n, LENGTHS * float(ship.L_pp) / speed, speed, rate=1e6)[1:]
    t, states = np.array([row[0] for row in log]), np.array([row[1] for row in log], float)
    x, y, psi, u, v, r = states.T
    rng = np.random.default_rng(1)
    columns = {
        "north_m": x,
        "east_m": y,
        "heading_true_north_deg": np.degrees(psi) % 360.0,
        "surge_velocity_mps": u + 0.01 * speed * rng.normal(size=t.size),
        "sway_velocity_mps": v + 0.01 * speed * rng.normal(size=t.size),
        "yaw_rate_degps": np.degrees(r + 0.02 * np.std(r) * rng.normal(size=t.size)),
        "rudder_angle_deg": np.degrees(orders),
        "propeller_rate_rpm": np.full(t.size, 60.0 * float(n)),
    }
    return Voyage(name, t, columns, {"source": name})


@pytest.fixture(scope="module")
def zigzags():
    """A ship and its voyage, of every bundled hull and of the coaster."""
    ships = {name: twin.Ship.load(name) for name in HULLS} | {"coaster": coaster()}
    return {name: (ship, zigzag(ship, name)) for name, ship in ships.items()}


def asked(ship, voyage):
    return other_ship(VoyageView(voyage, ship))


@pytest.mark.parametrize("name", LENGTH_M)
def test_every_ship_is_taken_for_itself(zigzags, name):
    answer = asked(*zigzags[name])
    assert answer.ok and answer.informative, answer.text


@pytest.mark.parametrize(("file", "other"), APART)
def test_every_voyage_is_noticed_beside_the_file_of_another_size(zigzags, file, other):
    """Test: lengths from 2 to 320 m crossed, one twice the other or more. Expected: told, not refused."""
    answer = asked(zigzags[file][0], zigzags[other][1])
    assert not answer.ok and not answer.unusable, answer.text

    assert "no single cause does both" in answer.text


def test_a_coaster_beside_a_tankers_file_is_said_on_the_first_line(zigzags):
    found = twin.compare(zigzags["kvlcc2"][0], zigzags["coaster"][1])
    first = found.text()[0]
    assert first.startswith("this may be a voyage of another ship: at this shaft rate it makes 0.")
    assert "turns" in first and found.page().count("this may be a voyage of another ship") >= 1
    assert "another ship" not in twin.compare(*zigzags["kvlcc2"]).text()[0]


@pytest.mark.parametrize("effect", ["HullFouling", "PropellerWear", "RudderWear", "CrossFlowDrag", "Loading"])
def test_one_cause_at_a_plausible_size_makes_no_other_ship(zigzags, effect):
    ship = zigzags["container"][0]
    voyage = zigzag(ship.with_effects(find(effect).plausible(ship)), effect)
    answer = asked(ship, voyage)
    assert answer.ok and answer.informative, answer.text


def test_a_shaft_in_another_unit_is_a_unit_and_no_other_ship(zigzags):
    ship, voyage = zigzags["container"]
    turns = {"propeller_rate_rpm": voyage["propeller_rate_rpm"] / 60.0}
    answers = {
        c.name: c for c in run_checks(voyage.with_rows(voyage.time_s, {**voyage.columns, **turns}), ship)
    }
    assert answers["other_ship"].ok and answers["propeller_rate"].unusable
    assert 'unit = "1/s"' in answers["propeller_rate"].text


def test_the_unit_of_a_shaft_is_not_proved_by_the_propeller_of_another_ship(zigzags):
    """Test: a boat's voyage beside a tanker's file; 1200 turns a minute of a large propeller look like
    turns that were converted twice. Expected: a doubt that names both, and the file is not refused."""
    answers = {c.name: c for c in run_checks(zigzags["usv"][1], zigzags["kvlcc2"][0])}
    assert not answers["propeller_rate"].ok and not answers["propeller_rate"].unusable
    assert "Not proved: other_ship:" in answers["propeller_rate"].text
    assert whose(of_voyages([zigzags["usv"][1]], zigzags["kvlcc2"][0]))


def test_without_a_ship_a_rudder_or_a_turn_it_says_what_would_tell(zigzags):
    ship, voyage = zigzags["container"]
    assert "--ship" in asked(None, voyage).text
    nothing = {"rudder_angle_deg": np.full(len(voyage), np.nan)}
    blind = asked(ship, voyage.with_rows(voyage.time_s, {**voyage.columns, **nothing}))
    straight = zigzag(ship, "straight", straight=True)
    for answer in (blind, asked(ship, straight)):
        assert answer.ok and not answer.informative and answer.text.startswith("cannot tell")


def test_of_several_voyages_the_one_in_doubt_is_named(zigzags):
    ship, own, other = zigzags["kvlcc2"][0], zigzags["kvlcc2"][1], zigzags["container"][1]
    lines = whose(of_voyages([own, zigzags["usv"][1]], ship))
    assert len(lines) == 1 and lines[0].startswith(f"{zigzags['usv'][1].name}: this may be")
    assert other is not own
