"""How far ahead what was held out is judged."""

import numpy as np
import pytest

from twin.errors import DataError
from twin.physics.effects import find
from twin.study.update.addition import add


def test_positions_that_come_too_slowly_for_a_horizon_are_judged_where_they_were_read(sailed, make, kvlcc2):
    """Test: a stream, with position and velocity every 25 s. Expected: it is proved 50 s and 100 s ahead, for
    60 s and 120 s; where a position comes every 250 s, one line that says so."""

    def seldom(voyage, wait_s):
        read = np.unique(np.searchsorted(voyage.time_s, np.arange(0.0, voyage.time_s[-1], wait_s)))
        columns = {n: x.copy() for n, x in voyage.columns.items()}
        for name in ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps"):
            columns[name][np.delete(np.arange(voyage.time_s.size), read)] = np.nan
        return sailed(voyage.with_rows(voyage.time_s, columns))

    current = find("Current").absent(kvlcc2).but(north=-0.3, east=0.5)
    fitted, held = (make(current, seed=i, name=f"stream{i}") for i in (0, 1))
    told = add(kvlcc2, [find("Current")], [seldom(fitted, 25.0)], [seldom(held, 25.0)])
    assert told.proof.proved and told.fall.after < 0.1 * told.fall.before
    assert [r["horizon_s"] for r in told.result["horizons"]] == pytest.approx([50.0, 100.0], abs=0.5)
    with pytest.raises(DataError, match="how far off a prediction ends cannot be judged"):
        add(kvlcc2, [find("Current")], [seldom(fitted, 250.0)], [seldom(held, 250.0)])
