"""What two reference voyages establish of the next one."""

from dataclasses import replace

import numpy as np
import pytest

from bench.small_boats import ship_of
from twin.physics.effects import find, of_ship
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.diagnosis.assemble import of_tracks
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.linear import linearise
from twin.study.reference.between import BetweenVoyages, doubted, scattered
from twin.study.reference.nuisance import (
    TEMPER,
    Known,
    from_ship,
    known_from,
    lasting,
    learned_since,
    nuisance_unknowns,
    usual_unknowns,
)
from twin.study.track.track import track

RUDDER = "SteeringLag.delay"


def rudder_age(make, late_s):
    """By how much [s] the age of the rudder's reading is expected to differ from voyage to voyage, where it was so
    late on each of these."""
    ship, lines = load("kvlcc2"), []
    model, known = Model.of(ship), of_ship(ship)
    unknowns = usual_unknowns(model, known)
    for seed, late in enumerate(late_s):
        one = make(seed=seed)
        one.columns["rudder_angle_deg"] = np.interp(
            one.time_s - late, one.time_s, one.columns["rudder_angle_deg"]
        )
        lines.append(linearise(track(one, ship), model, unknowns, known))
    told = known_from(lines, unknowns, NoiseModel(), TEMPER)
    i = [u.label for u in unknowns].index(RUDDER)
    assert RUDDER not in told.between
    return float(np.sqrt(told.scatter[i]) * unknowns[i].sd)


def test_how_far_ages_differ_is_learned_from_the_voyages(make):
    """Test: four voyages of 25 minutes whose rudder angle is shown at once, and four that show it 0 to 2 s late.
    Expected: a spread below a quarter of a second; one of 0.5 to 1.5 s."""
    assert rudder_age(make, (0.0, 0.0, 0.0, 0.0)) < 0.25
    assert 0.5 < rudder_age(make, (0.0, 2.0, 0.3, 1.5)) < 1.5


def test_one_voyage_does_not_tell_how_far_ages_differ(make):
    """Test: a single voyage, whose two halves agree. Expected: more than of four voyages that agree."""
    assert rudder_age(make, (0.0,)) > 0.3


def test_the_next_voyage_is_never_known_better_than_healthy_voyages_differ():
    """Test: two reference voyages that tell everything, and agree. Expected: of each number the variance foretold
    for the next voyage is what is usual, and half of it again, for the ship's own is known from two; of no number is
    it said that it differs."""
    ship = load("kvlcc2")
    unknowns = usual_unknowns(Model.of(ship), of_ship(ship))
    exact = BetweenVoyages(1e9 * np.eye(len(unknowns)), np.zeros(len(unknowns)), 0.0)
    usual, none = np.array([u.varies**2 for u in unknowns]), np.zeros(len(unknowns))
    known = Known(unknowns, (exact, exact), scattered((exact, exact), none, usual), usual, none)
    foretold = np.diag(np.linalg.inv(known.nuisance().information))
    lasting_ones = np.array([v for v, u in zip(usual, unknowns, strict=True) if not u.every_day])
    np.testing.assert_allclose(foretold, 1.5 * lasting_ones, rtol=0.05, atol=1e-8)
    assert known.between == {}
    assert {u.owner for u in unknowns if u.varies} == {"HeadingBias", "SpeedLogMisalignment"}


def usual_of_wind(days):
    """How much c_y of a ship whose file has wind is usually otherwise [-], when references had it so far from the
    file on these days, in what is usual of a ship that was never calibrated."""
    ship = replace(load("kvlcc2"), A_F=1200.0, A_L=3000.0)
    known = of_ship(ship)
    unknowns = usual_unknowns(Model.of(ship).but(known["Wind"].plausible(ship)), known)
    i, none = [u.label for u in unknowns].index("Wind.c_y"), np.zeros(len(unknowns))
    tells = 100.0 * np.diag(np.arange(none.size) == i)
    told = [BetweenVoyages(tells, tells[i] * day, tells[i, i] * day**2) for day in days]
    usual = doubted(told, none, none, np.array([u.of_file for u in unknowns]))
    found = Known(unknowns, tuple(told), scattered(told, none, usual), usual, none).nuisance()
    assert "Wind.c_y" not in [u.label for u in found.unknowns]
    return found.daily["Wind.c_y"] / unknowns[i].sd


def test_how_far_the_answer_to_wind_differs_is_learned_from_the_voyages():
    """Test: references that have the same wind, references that scatter, and none. Expected: less freedom than a
    ship that was never calibrated has, more, and about as much."""
    assert usual_of_wind([0.0, 0.1, -0.1, 0.05]) < 0.5
    assert usual_of_wind([1.5, -1.4, 0.2, -1.2]) > 0.9
    assert 1.0 < usual_of_wind([]) < 1.5


def test_ages_of_readings_are_numbers_of_their_effects():
    """Expected: each name in `ages` is a number of its effect, in seconds; rudder, receiver and the instruments' usual
    lateness have one."""
    for effect in of_ship(load("kvlcc2")).values():
        unit = {p.name: p.unit for p in effect.params()}
        assert all(unit[name] == "s" for name in effect.ages), effect.__name__
    unknowns = usual_unknowns(Model.of(load("kvlcc2")), of_ship(load("kvlcc2")))
    owners = {u.label for u in unknowns if u.age}
    assert owners >= {"SteeringLag.delay", "SensorDelay.delay", "late.log", "late.compass", "late.gyro"}


@pytest.mark.parametrize("told, open_to_doubt", [({}, False), ({"sd": 2.0}, True)])
def test_an_antenna_whose_place_the_owner_knows_is_no_candidate_and_takes_nothing_of_a_lateness(
    told, open_to_doubt, make
):
    """Test: its place in the ship file, without and with a standard error. Expected: without one none of its
    numbers is asked; with one, or by name (`twin add`), they are."""
    antenna, ship = find("AntennaOffset"), load("kvlcc2")
    numbers = {n: {"value": 3.0, "unit": "m"} | told for n in ("ahead", "starboard")}
    placed = replace(
        ship.with_effects(antenna(ahead=3.0, starboard=3.0, above=0.0)),
        notes={**ship.notes, "effects": {"AntennaOffset": numbers}},
    )
    sailed = [track(make(seed=1), placed)]
    for asked, there in (((), open_to_doubt), ((antenna,), True)):
        case = of_tracks(sailed, placed, asked=asked)
        assert ("AntennaOffset" in case.candidates) is there
        assert any(u.owner == "AntennaOffset" for u in case.unknowns) is there


def test_a_calibration_that_lacks_a_number_of_a_cause_is_older_than_it_and_none_is_older_than_nothing():
    """Test: labels as a calibration writes them, then without one number of a load. Expected: the load alone;
    of an uncalibrated ship, and where the file has a fault that no calibration fits, nothing."""
    ship, known = load("kvlcc2"), of_ship(load("kvlcc2"))
    every = [u.label for u in lasting(Model.of(ship), known)]

    def of(labels, *effects):
        notes = {**ship.notes, "structural": {"labels": labels}} if labels else {}
        return learned_since(Model.of(replace(ship.with_effects(*effects), notes=notes)), known)

    assert of(every) == [] and of([]) == []
    assert of([x for x in every if x != "Loading.N_ur"]) == ["Loading"]
    assert of(every, find("GyroBias")()) == []


@pytest.mark.parametrize(
    ("ship", "name"), [(load("kvlcc2"), "PropellerWear"), (ship_of("thrusters"), "ThrusterWear.port")]
)
@pytest.mark.parametrize("beside", [False, True])
def test_what_a_calibration_left_open_of_an_effect_does_not_count_once_the_ship_has_it(ship, name, beside):
    """Test: a calibration that left the loss of a propeller, and of one of two thrusters, at 0.05 with an sd of
    0.2 widths; then the ship gets that effect with a loss of 0.3. Expected: about its new number it is as open as
    its prior; a calibration that was done beside that effect is believed as it stands."""
    model, catalogue = Model.of(ship), of_ship(ship)
    label = f"{name}.loss"
    (width,) = (u.sd for u in nuisance_unknowns(model, catalogue) if u.label == label)
    notes = {"labels": [label], "offset": [0.05], "covariance": [[(0.2 * width) ** 2]]}
    notes["beside_effects"] = [name] if beside else []
    with_it = ship.with_effects(find(name)(loss=0.3))
    model = Model.of(replace(with_it, notes={**ship.notes, "structural": notes}))
    unknowns = nuisance_unknowns(model, catalogue)
    left, i = from_ship(model, unknowns), [u.label for u in unknowns].index(label)
    covariance = np.linalg.inv(left.information)
    mean, sd = (covariance @ left.pull)[i] * unknowns[i].sd, np.sqrt(covariance[i, i])
    assert (mean, sd) == (pytest.approx((0.05, 0.2) if beside else (0.0, 1.0), abs=1e-3))
