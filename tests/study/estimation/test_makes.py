"""Actuators of one make share the shape of their curve: one number for all, as long as the ship file has it
alike; what each has of its own is found for each."""

from dataclasses import replace

import pytest

from bench.small_boats import ship_of
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.ship import load, save
from twin.study.estimation.columns import changed, core_unknowns, with_values


def of_actuators(ship):
    return {u.name: u for u in core_unknowns(Model.of(ship)) if "." in u.name}


def test_the_shape_of_a_curve_is_one_number_for_all_of_a_make():
    ship = ship_of("azimuths")
    numbers = of_actuators(ship)
    assert numbers["bow_p.strut"].names == ("bow_p.strut", "bow_s.strut", "stern_p.strut", "stern_s.strut")
    assert {"bow_p.own_gain", "bow_s.own_gain", "stern_p.trim"} <= set(numbers)
    assert "bow_s.strut" not in numbers and numbers["bow_s.own_gain"].also == ()
    model = Model.of(ship)
    shape, own = numbers["bow_p.slow"], numbers["bow_s.own_gain"]
    new = changed(model, shape, 0.7, of_ship(ship)).ship
    assert {float(a.slow) for a in new.actuators} == {0.7}
    both = with_values(model, [shape, own], [0.6, 0.9], of_ship(ship)).ship
    assert [float(a.slow) for a in both.actuators] == 4 * [0.6]
    assert [float(a.strength) for a in both.actuators] == [1.0, 0.9, 1.0, 1.0]


def test_one_gain_for_a_make_and_beside_it_one_for_each_that_differs_from_it_by_little():
    ship = ship_of("azimuths")
    numbers = of_actuators(ship)
    gain, own = numbers["bow_p.gain"], numbers["stern_s.own_gain"]
    assert gain.names == tuple(f"{a.name}.gain" for a in ship.actuators) and gain.sd == 0.2
    assert own.centre == 1.0 and own.sd == 0.05
    both = with_values(Model.of(ship), [gain, own], [0.8, 1.1], of_ship(ship)).ship
    assert [float(a.strength) for a in both.actuators] == pytest.approx([0.8, 0.8, 0.8, 0.88])


def test_thrust_goes_with_the_gain_of_the_make_times_its_own():
    ship = ship_of("azimuths")
    orders = {f"{a.name}.command": 0.7 for a in ship.actuators} | {
        f"{a.name}.angle": 0.4 for a in ship.actuators
    }
    make, own, both = (
        ship.with_derivatives(**numbers).actuators[0].force(orders, 0.0, 0.0, 0.0, ship)
        for numbers in (
            {"bow_p.gain": 0.72},
            {"bow_p.own_gain": 0.72},
            {"bow_p.gain": 0.9, "bow_p.own_gain": 0.8},
        )
    )
    assert abs(make[0]) > 1.0
    assert own == pytest.approx(make) and both == pytest.approx(make)


@pytest.mark.parametrize("ship", ["one of each make", "gains told apart", "kvlcc2"])
def test_where_nobody_shares_a_gain_the_unknowns_are_what_they_were(ship):
    """Expected: no gain of its own beside a gain; to the last digit the thrust of a gain alone."""
    boat = ship_of("screws and bow thruster")
    one_each = replace(boat, actuators=tuple(a for a in boat.actuators if a.name != "port"))
    told_apart = ship_of("azimuths").with_derivatives(
        **{f"{a.name}.gain": 1.0 + 0.01 * i for i, a in enumerate(ship_of("azimuths").actuators)}
    )
    asked = {"one of each make": one_each, "gains told apart": told_apart}.get(ship) or load(ship)
    numbers = of_actuators(asked)
    assert not [n for n in numbers if n.endswith("own_gain")]
    assert [n for n in numbers if n.endswith(".gain")] == [f"{a.name}.gain" for a in asked.actuators]
    assert all(u.also == () for n, u in numbers.items() if n.endswith(".gain"))
    assert [a.strength for a in asked.actuators] == [a.gain for a in asked.actuators]


def test_a_gain_of_its_own_is_kept_in_the_ship_file(tmp_path):
    ship = ship_of("azimuths").with_derivatives(**{"stern_p.own_gain": 0.83})
    save(ship, tmp_path / "boat.toml")
    assert [a.own_gain for a in load(tmp_path / "boat.toml").actuators] == [1.0, 1.0, 0.83, 1.0]


def test_what_a_ship_file_has_unlike_is_found_for_each():
    ship = ship_of("azimuths").with_derivatives(**{"bow_s.slow": 0.5})
    numbers = of_actuators(ship)
    assert numbers["bow_s.slow"].also == () and numbers["bow_p.slow"].also == ("stern_p.slow", "stern_s.slow")


def test_another_make_has_a_curve_of_its_own():
    numbers = of_actuators(ship_of("screws and bow thruster"))
    assert numbers["port.linear"].also == ("starboard.linear",) and numbers["bow.linear"].also == ()
