"""A latitude that is a longitude: named with its cure where it could be one, refused where it cannot."""

import numpy as np
import pytest

from twin.errors import DataError
from twin.live.signals.geodesy import datum, from_chart
from twin.recording.checks import run_checks
from twin.recording.read import read_voyage
from twin.studio.remedies import remedies_of

MOTION = ("surge_velocity_mps", "sway_velocity_mps", "yaw_rate_degps", "heading_true_north_deg")
CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm")


@pytest.fixture
def table(sail, tmp_path):
    """A file of one voyage, begun at a place, with a column of each name."""

    def write(latitude_deg, longitude_deg, first="latitude_deg", second="longitude_deg"):
        columns = sail()
        here = datum(latitude_deg, longitude_deg)
        at = [from_chart(here, n, e) for n, e in zip(columns["north_m"], columns["east_m"], strict=True)]
        lat, lon = np.transpose(at)
        names = ["time_s", first, second, *MOTION, *CONTROLS]
        rows = np.column_stack([columns["time_s"], lat, lon, *(columns[n] for n in (*MOTION, *CONTROLS))])
        path = tmp_path / "bridge.csv"
        path.write_text(
            ",".join(names) + "\n" + "".join(",".join(f"{x:.9g}" for x in r) + "\n" for r in rows)
        )
        return path

    return write


EXCHANGED = ("longitude_deg", "latitude_deg")


@pytest.mark.parametrize("place", [(59.4, 10.6), (-33.8, -70.5), (4.0, 52.0)])
def test_an_exchanged_latitude_is_named_and_its_columns_are_swapped(table, place):
    """Test: the map calls the longitude latitude. Expected: one proof, the cure of its button, and a healthy
    voyage without the mistake."""
    checks = run_checks(read_voyage(table(*place, *EXCHANGED)))
    wrong = [c for c in checks if c.unusable]
    assert [c.name for c in wrong] == ["velocity_frame"]
    assert "latitude and longitude are exchanged" in wrong[0].text
    assert "that is believed" in wrong[0].text
    (remedy,) = remedies_of(wrong[0], ["latitude_deg", "longitude_deg"])
    assert remedy["edit"] == {"swap": [["latitude_deg", "longitude_deg"]]}
    assert not [c for c in run_checks(read_voyage(table(*place))) if c.unusable]


def test_a_latitude_beyond_ninety_degrees_is_refused_in_a_sentence(table):
    path = table(-33.8, 151.2, *EXCHANGED)
    with pytest.raises(DataError, match="no latitude is beyond 90 deg: latitude and longitude are") as e:
        read_voyage(path)
    assert str(path) in str(e.value) and "151.198" in str(e.value)
