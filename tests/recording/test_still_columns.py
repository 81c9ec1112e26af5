"""Of several columns that make one channel, one that never changes is asked about."""

import pytest

from twin.errors import DataError
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage

BOTH_SHAFTS = parse_map(
    {
        "time": {"column": "t"},
        "columns": {
            "north_m": "n", "east_m": "e", "heading_true_north_deg": "h", "rudder_angle_deg": "d",
            "propeller_rate_rpm": {"column": ["port", "stbd"], "factors": [0.5, 0.5]},
        },
    },
    "both shafts",
)  # fmt: skip


def table(folder, starboard):
    """Two minutes of two shafts, of which the starboard one shows this."""
    rows = [f"{t},{2.0 * t},0,0,0,{60 + t % 7},{starboard.format(rpm=60 + t % 7)}\n" for t in range(120)]
    path = folder / "v.csv"
    path.write_text("t,n,e,h,d,port,stbd\n" + "".join(rows))
    return path


@pytest.mark.parametrize("starboard, asked", [("0.0", True), ("{rpm}", False)])
def test_a_dead_shaft_sensor_in_a_mean_of_two_is_asked_about(tmp_path, starboard, asked):
    """Test: the mean of two shafts, of which one shows nothing all voyage; and both alike. Expected: the note
    names channel and column; of two shafts that both turn there is none."""
    notes = read_voyage(table(tmp_path, starboard), BOTH_SHAFTS).meta["notes"]
    assert any("propeller_rate_rpm: stbd is the same number in every row" in n for n in notes) == asked


def test_of_two_shafts_of_which_one_is_empty_that_one_is_named(tmp_path):
    with pytest.raises(
        DataError, match="propeller_rate_rpm: stbd is empty, and so is its sum with the others"
    ):
        read_voyage(table(tmp_path, ""), BOTH_SHAFTS)
