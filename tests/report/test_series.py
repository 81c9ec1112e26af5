"""What the page's lines are made of: the model runs on where an instrument is slower than the grid."""

import numpy as np
import pytest

import twin
from tests.live.actuators import SIDES, craft
from tests.report.boat import straight_with_a_turn
from twin.physics.model import Model
from twin.report.page import content
from twin.report.series import stitched
from twin.study.track.track import track

LONGEST_S = 120.0


def placed_every(voyage, samples):
    """The voyage of whose positions only one in so many was read."""
    seldom = np.arange(voyage.time_s.size) % samples == 0
    places = {n: np.where(seldom, voyage.columns[n], np.nan) for n in ("north_m", "east_m")}
    return voyage.with_rows(voyage.time_s, dict(voyage.columns) | places)


@pytest.mark.parametrize("samples", (3, 5, 16))
def test_the_models_line_runs_on_between_seldom_positions(make, kvlcc2, samples):
    """Test: positions each 4, 6 or 20 s, everything else each 1.25 s. Expected: a line at every step; a beginning waits for
    the next position."""
    seldom = track(placed_every(make(seconds=700.0), samples), kvlcc2)
    line, begun = stitched(seldom, Model.of(kvlcc2), LONGEST_S)
    assert begun.size == 6
    assert np.isfinite(line).all(1).sum() > len(line) - samples * begun.size


def test_the_models_line_ends_where_a_control_is_unknown_and_begins_anew_after_it(make, kvlcc2):
    """Test: the rudder unread for 200 s. Expected: no line from there to the next beginning, and one after it."""
    made = make(seconds=900.0)
    lost = (made.time_s > 300.0) & (made.time_s < 500.0)
    columns = {"rudder_angle_deg": np.where(lost, np.nan, made.columns["rudder_angle_deg"])}
    holed = track(made.with_rows(made.time_s, dict(made.columns) | columns), kvlcc2)
    line, begun = stitched(holed, Model.of(kvlcc2), LONGEST_S)
    there, after = np.isfinite(line[:, 0]), holed.t[begun[holed.whole[begun] & (holed.t[begun] > 400.0)]][0]
    unknown = holed.t[~holed.whole]
    assert not there[~holed.whole].any()
    assert there[(holed.t > 0.0) & (holed.t < unknown[0])].all()
    assert not there[(holed.t > unknown[-1]) & (holed.t <= after)].any() and there[holed.t > after].all()


def test_the_heat_strip_of_seldom_positions_has_the_errors_60_s_ahead(make, kvlcc2):
    """Test: positions each 20 s, of which 60 s ahead is the only one that is predicted. Expected: every channel."""
    voyage = placed_every(make(seconds=700.0), 16)
    (drawn,) = content("compare", {"verdict": ""}, [track(voyage, kvlcc2)], Model.of(kvlcc2))["voyages"]
    assert len(drawn["heat"]["rows"]) == len(drawn["channels"]) == 8


def test_the_controls_of_actuators_are_drawn_behind_those_of_every_ship(tmp_path):
    """Test: a boat of two thrusters with a wave height. Expected: the waves, and each thruster's pulse width."""
    boat, voyage = craft(*SIDES), twin.read_voyage(straight_with_a_turn(tmp_path / "v.csv", 1))
    columns = {n: x for n, x in voyage.columns.items() if n not in ("rudder_angle_deg", "propeller_rate_rpm")}
    pulse = 1650.0 + 2.0 * voyage["rudder_angle_deg"]
    columns = {"port.pwm_us": pulse, "starboard.pwm_us": 3300.0 - pulse} | columns
    made = voyage.with_rows(voyage.time_s, columns)
    (drawn,) = content("compare", {"verdict": ""}, [track(made, boat)], Model.of(boat), voyages=[made])[
        "voyages"
    ]
    names = [c["name"] for c in drawn["inputs"]]
    assert names == ["wave_height_significant_m", "port.pwm_us", "starboard.pwm_us"]
