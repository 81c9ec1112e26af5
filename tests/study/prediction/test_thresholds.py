"""A limit that a script holds the twin to is met or not met, however its horizon is written."""

import argparse

import pytest

from twin.study.prediction.thresholds import metric, threshold

RESULT = {
    "horizons": [{"horizon_s": 60.0, "position_mae_m": 3.0}, {"horizon_s": 120.0, "position_mae_m": 7.0}]
}


@pytest.mark.parametrize("limit", ["nan", "inf", "-inf"])
def test_a_limit_that_nothing_can_be_above_is_refused(limit):
    with pytest.raises(argparse.ArgumentTypeError, match="position_mae_m=50"):
        threshold(f"position_mae_m={limit}")


@pytest.mark.parametrize("at", ["60", "60.0", "6e1", "060"])
def test_a_horizon_is_a_number_and_not_its_digits(at):
    name, limit = threshold(f"position_mae_m@{at}=5")
    assert metric(RESULT, name) == 3.0 and limit == 5.0
    assert metric(RESULT, "position_mae_m@61") is None and metric(RESULT, "position_mae_m") == 7.0
