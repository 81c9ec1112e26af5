"""What an owner is told of a first model's manoeuvres."""

import pytest

from twin.study.first_model.first_trial import doubts

USUAL = {"straight_line_stability": 1.0, "speed_left": 0.5, "overshoot_20_20_deg": 12.0}


@pytest.mark.parametrize("diameter", [1.75, 1.9, 6.4, 6.6])
def test_the_usual_diameters_that_are_told_are_those_that_are_checked(diameter):
    """Expected: a doubt says between which diameters there is none, and those of 1.9 and 6.4 lengths lie
    there."""
    said = doubts(USUAL | {"tactical_diameter_L": diameter}, C_b=0.8)
    assert len(said) == (diameter in (1.75, 6.6)) and all("(1.8 to 6.5 L)" in doubt for doubt in said)
