"""Wind that pushes by other coefficients than the ship file has may be something else."""

from dataclasses import replace

import pytest

from twin.physics.effects import find
from twin.physics.ship import load
from twin.study.diagnosis.beyond_file import beyond_file

TODAY = {"c_x": 0.8, "c_y": 1.2, "c_n": -0.12, "c_m": 0.0}


def told(sd):
    """Today's numbers with that standard deviation, as an answer has them."""
    return [
        {"name": n, "value": x, "low95": x - 1.96 * sd, "high95": x + 1.96 * sd, "unit": "-"}
        for n, x in TODAY.items()
    ]


@pytest.fixture
def ship():
    """A ship whose wind was calibrated, all but c_m."""
    ship = load("kvlcc2").with_effects(find("Wind")(c_x=0.8, c_y=1.0, c_n=0.08, c_m=1.0))
    noted = {n: {"value": 0.0, "sd": 0.03} for n in ("c_x", "c_y", "c_n")}
    return replace(ship, notes={**ship.notes, "effects": {"Wind": noted}})


@pytest.mark.parametrize("sd, beyond", [(0.05, ["c_y", "c_n"]), (0.06, []), (0.2, [])])
def test_what_is_farther_from_the_file_than_both_allow_is_beyond_it(ship, sd, beyond):
    """Test: by hand, 0.2 of c_y and of c_n over 3 sqrt(0.03^2 + sd^2): 0.175, 0.201 and 0.61."""
    found = beyond_file(ship, "Wind", told(sd))
    assert [p["name"] for p in found] == beyond
    assert all(p["sd"] == 0.03 for p in found)


@pytest.mark.parametrize("below, above", [(0.196, 0.196), (0.196, 0.01), (0.01, 0.196)])
def test_an_interval_that_ends_with_its_box_leaves_today_as_unsure_as_it_is(ship, below, above):
    """Test: by hand, 0.25 from the file's 0.8 +- 0.03 is within 3 sqrt(0.03^2 + 0.1^2) = 0.31, and 0.4 is not,
    whichever end of today's interval is that of its box."""
    for value, beyond in ((1.05, []), (1.2, ["c_x"])):
        today = {"name": "c_x", "value": value, "low95": value - below, "high95": value + above, "unit": "-"}
        assert [p["name"] for p in beyond_file(ship, "Wind", [today])] == beyond


def test_a_ship_whose_file_knows_no_wind_has_none_beyond_it(ship):
    assert beyond_file(load("kvlcc2"), "Wind", told(0.01)) == []
    assert beyond_file(ship, "Current", told(0.01)) == []
