"""The first residual's voyages on their grid: the force that a ship's core leaves over."""

import numpy as np
import pytest

from export.first import COLUMNS, read
from twin.live.keelson.messages import Row
from twin.live.log.logfile import LogFile
from twin.physics.ship import load


def test_a_shaft_that_starts_at_once_is_no_angle_that_wraps(tmp_path):
    """Test: a boat on a straight course through north whose shaft goes from stop to 1200 rpm between two samples.
    Expected: the network's propeller input before and after is n D_P/U_0, and its heading turns nowhere."""
    ship, path = load("usv"), tmp_path / "start.mcap"
    with LogFile(path) as log:
        for k in range(1200):
            values = dict.fromkeys(COLUMNS.values(), 0.0) | {
                "propeller_rate_rpm": 1200.0 * (k >= 600),
                "heading_true_north_deg": (359.5 + 0.001 * k) % 360.0,
                "surge_velocity_mps": 1.0,
            }
            row = Row(time_s=0.1 * k, **values)
            log.add("voyage", "shiptwin.Row", row.SerializeToString(), round(k * 1e8))
    run = read(path, ship)
    shaft = run.zeta[:, 4] * ship.U_0 / ship.D_P * 60.0
    assert shaft[5:50] == pytest.approx(0.0) and shaft[70:110] == pytest.approx(1200.0, rel=1e-6)
    assert np.isfinite(run.d).all()
