"""Actuators of one make share the shape of their curve: one number for all, as long as the ship file has it
alike; what each has of its own is found for each."""

from bench.small_boats import ship_of
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.study.estimation.columns import changed, core_unknowns, with_values


def of_actuators(ship):
    return {u.name: u for u in core_unknowns(Model.of(ship)) if "." in u.name}


def test_the_shape_of_a_curve_is_one_number_for_all_of_a_make():
    ship = ship_of("azimuths")
    numbers = of_actuators(ship)
    assert numbers["bow_p.strut"].names == ("bow_p.strut", "bow_s.strut", "stern_p.strut", "stern_s.strut")
    assert {"bow_p.gain", "bow_s.gain", "stern_p.trim"} <= set(numbers)
    assert "bow_s.strut" not in numbers and numbers["bow_s.gain"].also == ()
    model = Model.of(ship)
    shape, own = numbers["bow_p.slow"], numbers["bow_s.gain"]
    new = changed(model, shape, 0.7, of_ship(ship)).ship
    assert {float(a.slow) for a in new.actuators} == {0.7}
    both = with_values(model, [shape, own], [0.6, 0.9], of_ship(ship)).ship
    assert [float(a.slow) for a in both.actuators] == 4 * [0.6]
    assert [float(a.gain) for a in both.actuators] == [1.0, 0.9, 1.0, 1.0]


def test_what_a_ship_file_has_unlike_is_found_for_each():
    ship = ship_of("azimuths").with_derivatives(**{"bow_s.slow": 0.5})
    numbers = of_actuators(ship)
    assert numbers["bow_s.slow"].also == () and numbers["bow_p.slow"].also == ("stern_p.slow", "stern_s.slow")


def test_another_make_has_a_curve_of_its_own():
    numbers = of_actuators(ship_of("screws and bow thruster"))
    assert numbers["port.linear"].also == ("starboard.linear",) and numbers["bow.linear"].also == ()
