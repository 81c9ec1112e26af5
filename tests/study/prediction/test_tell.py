"""What compare found, on a terminal."""

import re

from twin.study.prediction.tell import horizon_lines


def test_numbers_with_many_digits_do_not_run_together():
    """Test: errors of a boat of a metre, as long as three and two significant digits become."""
    row = {"horizon_s": 10.0, "position_mae_m": 0.0172, "lateral_mae_m": 0.00808, "heading_mae_deg": 9.19}
    floor = {"position_mae_m": 0.00059, "lateral_mae_m": 0.00042, "heading_mae_deg": 13.0, "of": "noise"}
    *_, line = horizon_lines([row | {"noise_floor": floor}])
    assert re.split(" {2,}", line)[2:5] == ["0.0172 / 0.00059", "0.00808 / 0.00042", "9.19 / 13"]
