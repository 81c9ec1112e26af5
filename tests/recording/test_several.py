"""Several tables as one voyage: each on its own clock, and nothing of what was found wrong is lost."""

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage


@pytest.fixture
def tables(columns, write_csv, tmp_path):
    """Writes the required columns as a table of the motion and one of the controls; gives their folder."""

    def write(motion=None, controls=None):
        names = ("time_s", "rudder_angle_deg", "propeller_rate_rpm")
        write_csv({n: x for n, x in columns.items() if n not in names[1:]} | (motion or {}), "motion.csv")
        write_csv({n: columns[n] for n in names} | (controls or {}), "controls.csv")
        return tmp_path

    return write


def test_a_late_heading_of_a_joined_table_passes_north_and_no_hole(tables, columns):
    """Test: a heading that is 1 s late, passes north, and lacks half a minute. Expected: one voyage with the
    heading of a second later, and none in the hole."""
    heading = np.mod(355.0 + 0.5 * columns["time_s"], 360.0)
    hole = (columns["time_s"] > 20.0) & (columns["time_s"] < 50.0)
    folder = tables({"heading_true_north_deg": np.where(hole, np.nan, heading)})
    v = read_voyage(folder, parse_map({"columns": {"heading_true_north_deg": {"late_s": 1.0}}}, "m.toml"))
    shown = v["heading_true_north_deg"]
    before = v.time_s < 18.9
    np.testing.assert_allclose(shown[before], np.mod(heading[before] + 0.5, 360.0), atol=1e-6)
    assert np.isnan(shown[(v.time_s > 19.1) & (v.time_s < 50.0)]).all()


def test_what_is_cut_off_or_assumed_of_a_joined_table_is_told(tables, columns):
    """Test: a motion whose last line is torn, and controls whose clock counts milliseconds since 1970. Expected:
    the voyage says both, with the file."""
    since_1970 = 1.7e9 + columns["time_s"]
    folder = tables({"time_s": since_1970}, {"time_s": 1e3 * since_1970})
    with open(folder / "motion.csv", "a") as out:
        out.write("1700000060,1.0")
    meta = read_voyage(folder).meta
    rows = columns["time_s"].size
    assert meta["lost"] == (
        f"motion.csv: line {rows + 2} is cut off at the end of the file and was left out",
    )
    assert any(note.startswith("controls.csv: the time counts milliseconds") for note in meta["notes"])


def test_the_rounded_stamps_of_each_joined_table_are_rebuilt(tables, columns):
    """Test: rows every 0.1 s with stamps in whole seconds. Expected: even stamps again, and a sentence for each
    table."""
    rounded = np.floor(columns["time_s"])
    folder = tables({"time_s": rounded}, {"time_s": rounded})
    v = read_voyage(folder, parse_map({"time": {"column": "time_s", "rebuild": True}}, "m.toml"))
    assert len(v) == rounded.size and np.ptp(np.diff(v.time_s)) < 1e-9
    assert v.time_s == pytest.approx(columns["time_s"], abs=0.1)
    for name in ("motion.csv", "controls.csv"):
        assert any(note.startswith(f"{name}: time stamps rebuilt") for note in v.meta["notes"])


def test_a_joined_table_whose_clock_goes_back_is_refused_with_its_row(tables, columns):
    """Test: the controls' clock is set back by 20 s in the middle. Expected: refused, as a single table is, with
    the file and the line; a clock that goes back in none is taken."""
    time_s = columns["time_s"].copy()
    middle = time_s.size // 2
    time_s[middle:] -= 20.0
    with pytest.raises(DataError, match=rf"controls\.csv: line {middle + 2}: time goes back"):
        read_voyage(tables({}, {"time_s": time_s}))
    assert len(read_voyage(tables({}, {})))
