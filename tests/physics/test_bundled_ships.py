"""The bundled ships: made from published numbers, and sailing as their papers say."""

from math import radians

import pytest

from bench import ships
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.first_model.modulus import error_share
from twin.study.prediction.trial import shaft_speed, straight_line_stability, turning_circle, zigzag

each = pytest.mark.parametrize("key", ships.NAMES)


@each
def test_the_file_is_what_its_program_makes(key):
    made, found = ships.ship(key), load(key)
    assert found == made, "run: python -m bench.ships"
    assert found.notes["derivatives"] == {
        k: {**v, "unit": found.notes["derivatives"][k]["unit"]} for k, v in made.notes["derivatives"].items()
    }


@each
def test_the_modulus_form_keeps_the_published_forces(key):
    h = ships.HULLS[key]
    sway, yaw = error_share(ships.published(h), ships.derivatives(h), h.mx, h.my)
    assert sway < 0.1 and yaw < 0.13


@each
def test_she_turns_and_zigzags_as_a_ship_does(key):
    model = Model.of(load(key))
    circle = turning_circle(model, radians(35))
    assert 2.0 < circle.tactical_diameter < 6.0 and circle.advance < 4.5 and 0.3 < circle.speed_left < 0.8
    over = zigzag(model, radians(20), radians(20))
    assert len(over) >= 3 and 1.0 < over[0] < 25.0
    assert abs(straight_line_stability(model)) < 0.05


@pytest.mark.parametrize("key", ["kvlcc2", "kvlcc2_model"])
def test_the_tanker_turns_as_her_model_tests_say(key):
    """Advance about 3.3 L, tactical diameter about 3.4 L; overshoots of the free-running tests within a few
    degrees."""
    model, rate = Model.of(load(key)), radians(ships.HULLS[key].rudder_rate)
    circle = turning_circle(model, radians(35), rate=rate)
    assert circle.advance == pytest.approx(3.3, abs=0.3) and circle.tactical_diameter == pytest.approx(
        3.4, abs=0.35
    )
    for angle, tolerance in ((10, 3.0), (20, 4.5)):
        over = zigzag(model, radians(angle), radians(angle), rate=rate)
        measured = ships.MEASURED_ZIGZAG[angle]
        assert over[0] == pytest.approx(sum(side[0] for side in measured) / 2, abs=tolerance)


def test_model_and_ship_are_similar_by_froude():
    big, small = load("kvlcc2"), load("kvlcc2_model")
    assert big.L_pp / small.L_pp == pytest.approx(45.714, rel=1e-3)
    assert pytest.approx(45.714**0.5, rel=1e-3) == big.U_0 / small.U_0
    assert big.derivatives.Y_uv == small.derivatives.Y_uv and big.derivatives.w != small.derivatives.w


def test_at_the_shaft_speed_found_she_keeps_her_speed():
    model = Model.of(load("kvlcc2"))
    from twin.physics.state import Situation

    n = shaft_speed(model, 7.0)
    assert model.nu_dot(Situation(u=7.0, n=n)).u == pytest.approx(0.0, abs=1e-9)
    assert 1.0 < n < 2.5
