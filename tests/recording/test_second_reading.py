"""A velocity that software took of the recorded positions is no second reading of the motion."""

import numpy as np
import pytest

from twin.physics.ship import load
from twin.recording.import_voyage import import_voyage
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.recording.write import write_voyage
from twin.study.instruments.instrument_lines import turned_by
from twin.study.instruments.instrument_samples import of_voyage
from twin.study.track.track import READINGS, track

VELOCITY = ("surge_velocity_mps", "sway_velocity_mps")


def line_through(x: np.ndarray, half: int, step_s: float) -> np.ndarray:
    """The slope of the line through 2 half + 1 samples, as a camera system takes it; NaN at the ends."""
    weights = np.arange(-half, half + 1) / (step_s * np.sum(np.arange(-half, half + 1) ** 2))
    out = np.full(x.size, np.nan)
    out[half:-half] = np.convolve(x, weights[::-1], "valid")
    return out


@pytest.fixture(name="camera")
def camera_fixture(sail):
    """A function: the voyage of a ship whose velocities come out of its positions, in the ship's axes."""

    def make(half: int = 12, sign: float = 1.0):
        columns = sail(300.0)
        t, psi = columns["time_s"], np.radians(columns["heading_true_north_deg"])
        slope = [line_through(columns[name], half, t[1] - t[0]) for name in ("north_m", "east_m")]
        ahead = (slope[0] + 1j * slope[1]) * np.exp(-1j * psi)
        return columns | {VELOCITY[0]: ahead.real, VELOCITY[1]: sign * ahead.imag}

    return make


@pytest.mark.parametrize("half", [4, 12, 40])
def test_a_slope_of_the_recorded_position_is_no_second_reading(camera, write_csv, half, tmp_path):
    """Test: velocities that are slopes over 0.8 to 8 s of positions that scatter by 0.3 m, rounded to a mm/s.
    Expected: said to be derived, in the file as imported too; the track has position and no velocity."""
    columns = camera(half)
    columns |= {name: np.round(columns[name], 3) for name in VELOCITY}
    v = read_voyage(write_csv(columns))
    assert set(VELOCITY) <= set(v.meta["derived"])
    write_voyage(v, tmp_path / "again.mcap")
    again = read_voyage(tmp_path / "again.mcap")
    assert set(VELOCITY) <= set(again.meta["derived"])
    seen = dict(zip(READINGS, track(again, load("container")).measured.T, strict=True))
    assert np.isfinite(seen["x"]).any() and not np.isfinite(seen["u"]).any()


def test_where_the_velocity_is_no_reading_none_turned_it_by_its_own_attitude(camera, write_csv, sail):
    """Else the age of the position is asked of the ship's drift alone, which cannot tell it."""
    slope, measured = (of_voyage(read_voyage(write_csv(columns))) for columns in (camera(), sail(300.0)))
    assert slope.own is None and measured.own is True
    assert "no velocity over ground was measured" in turned_by(slope, False)
    assert "turned by an attitude of the receiver" in turned_by(measured, True)


def test_velocities_to_north_and_east_that_are_slopes_are_known_too(camera, write_csv, tmp_path):
    columns = camera()
    psi = np.radians(columns["heading_true_north_deg"])
    earth = (columns.pop(VELOCITY[0]) + 1j * columns.pop(VELOCITY[1])) * np.exp(1j * psi)
    path = write_csv(columns | {"velocity_north_mps": earth.real, "velocity_east_mps": earth.imag})
    assert set(VELOCITY) <= set(read_voyage(path).meta["derived"])


@pytest.mark.parametrize("noise", [0.0, 0.02, 1.0])
def test_a_velocity_that_was_measured_stays_a_reading(sail, write_csv, noise):
    """However quiet or rough the receiver is: none, 1 mm/s or 5 cm/s beside none, 6 mm or 0.3 m."""
    assert not read_voyage(write_csv(sail(300.0, noise=noise))).meta["derived"]


@pytest.mark.parametrize("ahead", [0.0, 0.5, 1.0])
def test_a_position_that_was_summed_from_the_velocity_leaves_it_a_reading(sail, write_csv, ahead):
    """Dead reckoning: every position is the one before and the velocity times the step, that at its beginning, at
    its end or the mean of both; the velocity is the instrument."""
    columns = sail(300.0)
    t, psi = columns["time_s"], np.radians(columns["heading_true_north_deg"])
    w = (columns[VELOCITY[0]] + 1j * columns[VELOCITY[1]]) * np.exp(1j * psi)
    place = np.r_[0.0, np.cumsum(((1.0 - ahead) * w[:-1] + ahead * w[1:]) * np.diff(t))]
    v = read_voyage(write_csv(columns | {"north_m": place.real, "east_m": place.imag}))
    assert set(VELOCITY).isdisjoint(v.meta["derived"])


def test_a_slope_with_a_mistake_in_it_is_refused_as_ever(camera, write_csv):
    """A slope whose second axis points to port is no slope of the position, so that the check still has both."""
    found = import_voyage(write_csv(camera(sign=-1.0)))
    assert [c.name for c in found.checks if c.unusable] == ["velocity_frame"]


def test_a_slope_in_another_unit_is_refused_as_ever(camera, write_csv):
    columns = camera()
    columns |= {name: columns[name] / 0.514444 for name in VELOCITY}
    found = import_voyage(write_csv(columns))
    assert [c.name for c in found.checks if c.unusable] == ["velocity_frame"]


def test_a_map_that_reads_the_unit_right_finds_the_slope(camera, write_csv):
    columns = camera()
    columns |= {name: columns[name] / 0.514444 for name in VELOCITY}
    by = parse_map({"columns": {name: {"unit": "kn"} for name in VELOCITY}}, "map.toml")
    assert set(VELOCITY) <= set(read_voyage(write_csv(columns), by).meta["derived"])
