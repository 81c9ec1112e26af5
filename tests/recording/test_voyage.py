"""A voyage says what it has, what it lacks, and resamples without inventing."""

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.voyage import Voyage

T = np.arange(0.0, 100.0, 0.1)


def voyage(**columns: np.ndarray) -> Voyage:
    return Voyage("test", T, columns)


def test_what_is_absent_is_said_to_be_absent():
    v = voyage(north_m=T, east_m=np.full_like(T, np.nan))
    assert v.has("north_m") and not v.has("north_m", "east_m")
    assert "east_m" in v.absent() and "north_m" not in v.absent()
    assert np.isnan(v["roll_deg"]).all()


def test_an_unknown_channel_names_the_nearest():
    with pytest.raises(DataError, match="Did you mean 'heading_true_north_deg'"):
        voyage(heading_true_deg=T)
    with pytest.raises(DataError, match="Did you mean 'roll_deg'"):
        voyage()["rol_deg"]


def test_a_ramp_stays_a_ramp_on_coarser_and_finer_grids():
    v = voyage(north_m=8.0 * T)
    for step in (0.025, 0.1, 0.25, 1.0, 7.0):
        g = v.on_grid(step)
        np.testing.assert_allclose(g["north_m"], 8.0 * g.time_s, atol=1e-9)
        assert g.time_s[1] - g.time_s[0] == pytest.approx(step)


def test_downsampling_averages_the_noise():
    rng = np.random.default_rng(1)
    g = voyage(roll_deg=rng.normal(size=T.size)).on_grid(1.0)
    assert np.std(g["roll_deg"][1:-1]) == pytest.approx(10**-0.5, rel=0.25)


def test_a_heading_through_north_is_averaged_along_the_circle():
    v = voyage(heading_true_north_deg=np.mod(359.0 + 0.5 * T, 360.0))
    g = v.on_grid(1.0)["heading_true_north_deg"]
    np.testing.assert_allclose(np.mod(g - 359.0 + 180.0, 360.0) - 180.0, 0.5 * np.arange(g.size), atol=1e-9)
    assert g.min() >= 0.0 and g.max() < 360.0


def test_short_gaps_are_bridged_and_long_gaps_stay_empty():
    x = 8.0 * T
    x[(T > 20.0) & (T < 23.0)] = np.nan
    x[(T > 50.0) & (T < 70.0)] = np.nan
    g = voyage(north_m=x).on_grid(0.5)
    bridged, empty = (g.time_s > 20) & (g.time_s < 23), (g.time_s > 50.5) & (g.time_s < 69.5)
    np.testing.assert_allclose(g["north_m"][bridged], 8.0 * g.time_s[bridged], atol=1e-9)
    assert np.isnan(g["north_m"][empty]).all()
    assert np.isnan(voyage(north_m=x).on_grid(0.5, max_gap_s=1.0)["north_m"][bridged][1:-1]).all()


def test_a_nan_tail_is_not_filled():
    x = np.where(T < 60.0, T, np.nan)
    g = voyage(north_m=x).on_grid(1.0)
    assert np.isnan(g["north_m"][g.time_s > 60.0]).all() and np.isfinite(g["north_m"][g.time_s < 59.5]).all()


def test_a_wave_height_reported_once_holds_for_the_whole_voyage():
    x = np.full_like(T, np.nan)
    x[500] = 2.5
    g = voyage(wave_height_significant_m=x).on_grid(1.0)
    np.testing.assert_array_equal(g["wave_height_significant_m"], 2.5)


def test_si_is_radians_without_jumps_and_turns_per_second():
    v = voyage(heading_true_north_deg=np.mod(350.0 + T, 360.0), propeller_rate_rpm=np.full_like(T, 90.0))
    np.testing.assert_allclose(v.si("heading_true_north_deg"), np.radians(350.0 + T))
    np.testing.assert_allclose(v.si("propeller_rate_rpm"), 1.5)


def test_between_keeps_the_clock_and_the_right_samples():
    v = voyage(north_m=T).between(10.0, 20.0)
    assert len(v) == 100 and v.time_s[0] == pytest.approx(10.0) and v.duration_s == pytest.approx(9.9)


def table_of(columns, **times):
    pandas = pytest.importorskip("pandas")
    return pandas.DataFrame({**times, **{n: x for n, x in columns.items() if n != "time_s"}})


def test_a_table_with_moments_for_time_keeps_them_whatever_its_index(columns):
    """Test: rows every 0.1 s with `time_utc`, once as moments and once as text, and row numbers for an index.
    Expected: a voyage of a minute, and when it began."""
    pandas = pytest.importorskip("pandas")
    moments = pandas.Timestamp("2026-11-25T12:00Z") + pandas.to_timedelta(columns["time_s"], unit="s")
    for stamps in (moments, moments.astype(str)):
        v = Voyage.from_dataframe(table_of(columns, time_utc=stamps))
        np.testing.assert_allclose(v.time_s, columns["time_s"], atol=1e-6)
        assert v.meta["start_time_utc"] == "2026-11-25T12:00:00Z"


def test_a_table_may_have_any_name_and_is_called_by_it(columns):
    table = table_of(columns, time_s=columns["time_s"])
    v = Voyage.from_dataframe(table, "alma/june 3")
    assert v.name == "alma/june 3" and v.meta["source"] == "alma/june 3"
    with pytest.raises(DataError, match=r"^alma/june 3: .*rudder_angle_deg"):
        Voyage.from_dataframe(table.drop(columns="rudder_angle_deg"), "alma/june 3")
