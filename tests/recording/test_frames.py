"""Positions on the chart, which begins at the first one that can be."""

import numpy as np
import pytest

from twin.recording.frames import chart


@pytest.mark.parametrize("first", [(95.0, 11.0), (57.0, -190.0), (57.0, 400.0), (np.nan, 11.0)])
def test_a_first_fix_that_no_place_has_is_left_out_and_not_the_datum(first):
    latitude, longitude = (np.r_[x, np.full(5, y)] for x, y in zip(first, (57.0, 11.0), strict=True))
    north, east, datum = chart(latitude, longitude)
    assert datum == {"latitude_deg": 57.0, "longitude_deg": 11.0}
    assert np.isnan(north[0]) and np.isnan(east[0])
    assert north[1:] == pytest.approx(0.0) and east[1:] == pytest.approx(0.0)
