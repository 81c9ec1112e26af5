"""A table through a map: its clock from columns of any kind; a model's file becomes the ship's, whatever its
position and velocity are written in."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage

SCALE = 25.0


def as_ship(path, scale=SCALE):
    return read_voyage(path, parse_map({"scale": {"froude": scale}}, "m.toml"))


def test_a_model_with_a_receiver_and_a_course_over_ground_becomes_a_ship(sailed, write_csv):
    """Test: latitude and longitude, speed and course over ground, once as they are and once of a model of 1 to
    25. Expected: ways 25 times and velocities five times as long, derived ones too, and the datum where it
    was."""
    place = {
        "time_s": sailed["t"],
        "latitude_deg": sailed["latitude"],
        "longitude_deg": sailed["longitude"],
        "heading_true_north_deg": sailed["psi"],
        "rudder_angle_deg": sailed["rudder"],
        "propeller_rate_rpm": sailed["rpm"],
    }
    course = {"speed_over_ground_mps": sailed["sog"], "course_over_ground_deg": sailed["psi"] + 10.0}
    for columns in (place, place | course):
        model, ship = (as_ship(write_csv(columns, digits=17), by) for by in (1.0, SCALE))
        for name in ("north_m", "east_m"):
            np.testing.assert_allclose(ship[name], SCALE * model[name], atol=1e-6)
        assert ship.meta["datum"] == model.meta["datum"]
    for name in ("surge_velocity_mps", "sway_velocity_mps"):
        np.testing.assert_allclose(ship[name], 5.0 * model[name], rtol=1e-9)
    assert ship["sway_velocity_mps"][0] == pytest.approx(5.0 * 6.0 * np.sin(np.radians(10.0)))


@pytest.fixture
def parquet(columns, tmp_path):
    """Writes the required columns as Parquet, with `day` and `clock` in place of the time; gives its path."""

    def write(day, clock):
        pa, kept = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
        motion = {n: pa.array(x) for n, x in columns.items() if n != "time_s"}
        kept.write_table(
            pa.table({"day": pa.array(day), "clock": pa.array(clock)} | motion), tmp_path / "v.parquet"
        )
        return tmp_path / "v.parquet"

    return write


START = datetime(2026, 11, 25, 23, 59, 30, tzinfo=UTC)


@pytest.mark.parametrize(
    ("time", "clock"),
    [
        ({"format": "%d.%m.%Y %H:%M:%S.%f"}, "%H:%M:%S.%f"),
        ({"format": "%m/%d/%y %I:%M:%S.%f%p"}, "%I:%M:%S.%f%p"),
        ({"unit": "iso"}, "%H:%M:%S.%f"),
    ],
)
def test_a_moment_beside_a_time_of_day_as_text_is_its_day(parquet, columns, time, clock):
    """Test: a day that is kept as a moment, and the time of day as text; midnight passes. Expected: one clock."""
    stamps = [START + timedelta(seconds=float(t)) for t in columns["time_s"]]
    path = parquet([s.replace(hour=7) for s in stamps], [s.strftime(clock) for s in stamps])
    v = read_voyage(path, parse_map({"time": {"column": ["day", "clock"], **time}}, "m.toml"))
    np.testing.assert_allclose(v.time_s, columns["time_s"], atol=1e-5)
    assert v.meta["start_time_utc"] == "2026-11-25T23:59:30Z"


@pytest.mark.parametrize(("day", "form"), [(20261125, "%Y%m%d %H:%M:%S"), (START, "%d.%m.%Y at %H:%M:%S")])
def test_a_time_of_a_number_and_a_text_that_do_not_fit_is_refused_by_their_names(
    parquet, columns, refused, day, form
):
    path = parquet([day] * columns["time_s"].size, ["12:30:05"] * columns["time_s"].size)
    by = parse_map({"time": {"column": ["day", "clock"], "format": form}}, "m.toml")
    refused(path, "'day'", "'clock'", "as text", by=by)


def test_year_to_second_in_columns_of_numbers_are_one_clock_by_their_format(tmp_path, columns):
    """Test: a packed table that keeps year, month, day, hour, minute and second as numbers of their own. Expected:
    the moments that they are, over midnight, and not their sum."""
    import pandas as pd

    stamps = [START + timedelta(seconds=round(float(t))) for t in columns["time_s"]]
    parts = ("year", "month", "day", "hour", "minute", "second")
    table = {name: [getattr(s, name) for s in stamps] for name in parts}
    rest = {n: x for n, x in columns.items() if n != "time_s"}
    keep = [k for k, s in enumerate(stamps) if k == 0 or s > stamps[k - 1]]
    pd.DataFrame(table | rest).iloc[keep].to_parquet(path := tmp_path / "parts.parquet")
    by = parse_map({"time": {"column": list(parts), "format": "%Y %m %d %H %M %S"}}, "m.toml")
    v = read_voyage(path, by)
    assert v.meta["start_time_utc"] == "2026-11-25T23:59:30Z"
    np.testing.assert_allclose(v.time_s, [(stamps[k] - START).total_seconds() for k in keep], atol=1e-6)
    holed = pd.DataFrame(table | rest).iloc[keep].astype({"minute": float})
    holed.iloc[20, holed.columns.get_loc("minute")] = np.nan
    holed.to_parquet(path)
    beside = read_voyage(path, by)
    assert beside.meta["start_time_utc"] == v.meta["start_time_utc"] and len(beside) == len(v) - 1
