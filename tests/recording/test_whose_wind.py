"""Of which wind a column is, when its name says so in a short form or leaves it to the column beside it."""

import tomllib
from datetime import datetime, timedelta

import numpy as np
import pytest

from twin.recording.checks import run_checks
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.recording.suggest_map import suggestion

T = np.arange(300.0)
PSI = 45.0 + 30.0 * np.sin(T / 20.0)
APPARENT = ("apparent_wind_speed_mps", "apparent_wind_angle_deg")
TRUE = ("true_wind_speed_mps", "true_wind_direction_deg")


def written(path, speed, angle):
    """A short voyage with a wind of 20 kn and 30 degrees in columns of these names."""
    rows = [
        "Time,North (m),East (m),Heading (deg),Rudder (deg),RPM," + ",".join(n for n in (speed, angle) if n)
    ]
    begin = datetime(2026, 3, 10, 8)
    for t, psi in zip(T, PSI, strict=True):
        cells = [
            f"{(begin + timedelta(seconds=t)).isoformat()}",
            f"{4 * t:.2f}",
            f"{3 * t:.2f}",
            f"{psi:.2f}",
        ]
        rows.append(
            ",".join([*cells, "2.0", f"{100 + t / 100:.2f}", "20.0", "30.0"][: len(rows[0].split(","))])
        )
    path.write_text("\n".join(rows) + "\n")
    return path


@pytest.mark.parametrize(
    ("speed", "angle", "channels", "asked"),
    [
        ("App. wind speed (kn)", "App. wind angle (deg)", APPARENT, 0),
        ("Wind speed (kn)", "Wind angle (deg)", APPARENT, 1),
        ("Apparent wind speed (kn)", "Wind direction (deg)", APPARENT, 1),
        ("Wind speed (kn)", "Rel. wind direction (deg)", APPARENT, 1),
        ("Wind speed (kn)", "Wind direction (deg)", TRUE, 0),
        ("TWS (kn)", "TWD (deg)", TRUE, 0),
    ],
)
def test_a_speed_and_an_angle_are_of_one_wind(tmp_path, speed, angle, channels, asked):
    """Expected: both halves of one wind, so that it is read; a person is asked where only the other half said."""
    text = suggestion([written(tmp_path / "log.csv", speed, angle)], {})
    columns = tomllib.loads(text)["columns"]
    assert {n for n in columns if "wind" in n} == {*channels}
    assert text.count("as the other column of the wind is. CONFIRM") == asked


def test_a_wind_that_says_true_is_not_made_apparent(tmp_path):
    """Test: a true wind's speed beside an angle off the bow. Expected: each stays what its name says."""
    text = suggestion([written(tmp_path / "log.csv", "True wind speed (kn)", "Wind angle (deg)")], {})
    columns = tomllib.loads(text)["columns"]
    assert {n for n in columns if "wind" in n} == {TRUE[0], APPARENT[1]}


def test_half_a_wind_is_said_to_be_half(tmp_path):
    """Test: the speed of one wind and the angle of the other. Expected: the check names what is lacking, and
    does not say that no wind was recorded."""
    path = written(tmp_path / "log.csv", "A", "B")
    halves = {TRUE[0]: {"column": "A", "unit": "kn"}, APPARENT[1]: {"column": "B"}}
    own = tomllib.loads(suggestion([path], {}))
    own["columns"] |= halves
    check = next(c for c in run_checks(read_voyage([path], parse_map(own, "by hand"))) if c.name == "wind")
    assert f"{TRUE[0]} was recorded without {TRUE[1]}" in check.text
    assert "no wind was recorded" not in check.text
