"""Positions from velocities, velocities from positions or from course and speed, and what is derived is no reading."""

import numpy as np
import pytest

from twin.physics.effects import find
from twin.physics.ship import load
from twin.recording.map_file import parse_map
from twin.recording.mapping import GROUND
from twin.recording.read import read_voyage
from twin.study.track.track import READINGS, track


def test_latitude_and_longitude_become_north_and_east_across_the_antimeridian(columns, write_csv):
    t = columns["time_s"]
    longitude = 179.9995 + 7.0 * t / 111_000.0
    longitude = np.where(longitude > 180.0, longitude - 360.0, longitude)
    placed = {n: x for n, x in columns.items() if n not in ("north_m", "east_m")}
    v = read_voyage(
        write_csv(placed | {"latitude_deg": 0.001 + 0 * t, "longitude_deg": longitude}, digits=14)
    )
    np.testing.assert_allclose(v["east_m"], 7.0 * t * 111_319.5 / 111_000.0, atol=0.02)
    np.testing.assert_allclose(v["north_m"], 0.0, atol=0.01)
    assert v.meta["datum"]["longitude_deg"] == pytest.approx(179.9995)


def test_a_voyage_in_degrees_may_be_of_any_length_and_wild_fixes_bend_no_track(columns, write_csv):
    """Test: 600 km east along 60 deg north, two fixes a degree off. Expected: the length by the radius of the
    parallel; no place blanked but the wild ones; north off by no more than the meridians turn in what the chart
    reaches, 368 m and the places of which it takes the median."""
    t = columns["time_s"]
    radius = (
        6378137.0 / np.sqrt(1.0 - 0.00669437999 * np.sin(np.radians(60.0)) ** 2) * np.cos(np.radians(60.0))
    )
    way = np.linspace(0.0, 600e3, t.size)
    latitude, longitude = 60.0 + 0.0 * t, 11.0 + np.degrees(way / radius)
    wild = [t.size // 2, t.size // 2 + 1]
    latitude[wild] += 1.0
    placed = {n: x for n, x in columns.items() if n not in ("north_m", "east_m")}
    v = read_voyage(write_csv(placed | {"latitude_deg": latitude, "longitude_deg": longitude}, digits=14))
    good = np.setdiff1d(np.arange(t.size), wild)
    assert np.isfinite(v["east_m"][good]).all()
    np.testing.assert_allclose(v["east_m"][good], way[good], atol=3.0)
    turns = (368.0 + 3.0 * way[1]) * np.tan(np.radians(60.0)) / 6378137.0
    np.testing.assert_allclose(v["north_m"][good], 0.0, atol=turns * 600e3)


def test_velocities_alone_are_integrated_and_positions_alone_are_differentiated(sail, write_csv, required):
    full = sail(120.0, noise=0.0)
    velocities = {n: full[n] for n in required if n not in ("north_m", "east_m")}
    v = read_voyage(write_csv(velocities))
    assert set(v.meta["derived"]) == {"north_m", "east_m"}
    np.testing.assert_allclose(v["east_m"], full["east_m"], atol=0.05)
    positions = {n: full[n] for n in required if "velocity" not in n and "rate_degps" not in n}
    v = read_voyage(write_csv(positions))
    assert set(v.meta["derived"]) == {"surge_velocity_mps", "sway_velocity_mps", "yaw_rate_degps"}
    np.testing.assert_allclose(v["surge_velocity_mps"], full["surge_velocity_mps"], atol=0.05)
    np.testing.assert_allclose(v["sway_velocity_mps"][20:-20], full["sway_velocity_mps"][20:-20], atol=0.05)
    np.testing.assert_allclose(v["yaw_rate_degps"][20:-20], full["yaw_rate_degps"][20:-20], atol=0.1)


@pytest.mark.parametrize("positions", ["alone", "beside velocities"])
def test_a_row_for_each_instrument_gives_the_same_motion(sail, write_csv, tmp_path, positions):
    """An export of messages: time, course and heading never stand in one row."""
    full = {n: x[::10] for n, x in sail(120.0, noise=0.0).items()}
    psi = np.radians(full["heading_true_north_deg"])
    over_ground = (full["surge_velocity_mps"] + 1j * full["sway_velocity_mps"]) * np.exp(1j * psi)
    columns = {
        n: full[n]
        for n in ("north_m", "east_m", "heading_true_north_deg", "rudder_angle_deg", "propeller_rate_rpm")
    }
    if positions != "alone":
        columns |= {"SOG": np.abs(over_ground), "COG": np.mod(np.degrees(np.angle(over_ground)), 360.0)}
    rows = np.full((full["time_s"].size, len(columns), 1 + len(columns)), np.nan)
    for j, x in enumerate(columns.values()):
        rows[:, j, 0], rows[:, j, 1 + j] = full["time_s"] + 0.05 * j, x
    path = write_csv(
        dict(zip(("time_s", *columns), rows.reshape(-1, 1 + len(columns)).T, strict=True)), digits=12
    )
    course = {
        "surge_velocity_mps": {"column": "SOG", "frame": "course"},
        "sway_velocity_mps": {"column": "COG", "frame": "course"},
    }
    own = {n: n for n in columns if n not in ("SOG", "COG")}
    v = read_voyage(
        path, parse_map({"columns": own | (course if positions != "alone" else {})}, "m.toml")
    ).on_grid(1.0)
    for name, size in (("surge_velocity_mps", 0.15), ("sway_velocity_mps", 0.25)):
        assert np.isfinite(v[name]).sum() > 110
        np.testing.assert_allclose(v[name][5:-5], full[name][5 : len(v) - 5], atol=size)


def test_a_derived_rate_is_no_second_reading(sail, write_csv, required):
    """Test: positions and headings alone. Expected: velocities and yaw rate are shown, but the study does not
    take them for instruments of their own, and no effect of a gyro is judged."""
    full = sail(400.0)
    v = read_voyage(
        write_csv({n: full[n] for n in required if "velocity" not in n and "rate_degps" not in n})
    )
    t = track(v, load("container"))
    there = np.isfinite(t.measured).any(0)
    assert [n for n, seen in zip(READINGS, there, strict=True) if seen] == ["x", "y", "psi"]
    assert {"u", "v", "r"} <= t.missing() and set(find("GyroBias").needs) <= t.missing()
    np.testing.assert_allclose(np.median(t.state[:, 3]), np.median(full["surge_velocity_mps"]), rtol=0.02)


@pytest.mark.parametrize("frame", ["course", "earth"])
def test_velocities_over_ground_by_course_or_by_north_and_east_need_no_map(columns, write_csv, frame):
    psi, u, v = (
        np.radians(columns["heading_true_north_deg"]),
        columns["surge_velocity_mps"],
        columns["sway_velocity_mps"],
    )
    north, east = u * np.cos(psi) - v * np.sin(psi), u * np.sin(psi) + v * np.cos(psi)
    ground = {
        "earth": (north, east),
        "course": (np.hypot(north, east), np.degrees(np.arctan2(east, north)) % 360.0),
    }[frame]
    others = {n: x for n, x in columns.items() if "surge" not in n and "sway" not in n}
    voyage = read_voyage(write_csv(others | dict(zip(GROUND[frame], ground, strict=True))))
    np.testing.assert_allclose(voyage["surge_velocity_mps"], u, atol=1e-6)
    np.testing.assert_allclose(voyage["sway_velocity_mps"], v, atol=1e-6)
    beside = read_voyage(write_csv(columns | dict(zip(GROUND[frame], ground, strict=True))))
    assert ("is not used (what is read as velocity over ground: surge_velocity_mps and") in " ".join(
        beside.meta["notes"]
    )
    np.testing.assert_allclose(beside["surge_velocity_mps"], u)
