"""Faults of a known size in the readings of a voyage."""

from dataclasses import replace

import numpy as np
import pytest

from bench.real import planted_faults as real_faults
from bench.real.kvlcc2 import BASINS, MAPS
from bench.real.planted_faults import (
    FAULTS,
    PlantedReadings,
    answer,
    antenna_elsewhere,
    early_rudder,
    in_a_stream,
    late_receiver,
    turned_compass,
)
from tests.thorough import thorough
from twin.commands.story import SHIP
from twin.physics.effects import find
from twin.physics.ship import load
from twin.recording.voyage import Voyage

U, R = 7.0, 0.005  # speed [m/s] and yaw rate [rad/s] of a ship that turns


@pytest.fixture
def voyage():
    t = np.arange(0.0, 600.0, 1.0)
    psi = R * t
    columns = {
        "north_m": U / R * np.sin(psi),
        "east_m": U / R * (1.0 - np.cos(psi)),
        "heading_true_north_deg": np.degrees(psi),
        "surge_velocity_mps": np.full_like(t, U),
        "sway_velocity_mps": np.zeros_like(t),
        "yaw_rate_degps": np.full_like(t, np.degrees(R)),
        "rudder_angle_deg": 10.0 * np.sin(0.02 * t),
        "propeller_rate_rpm": np.full_like(t, 100.0),
    }
    return Voyage("a turn", t, columns)


def moves_as_it_says(v):
    """Place and velocity over ground of a voyage whose compass is right must agree."""
    q = PlantedReadings.of(v)
    assert np.gradient(q.x, v.time_s)[2:-2] == pytest.approx(q.north[2:-2], abs=2e-3)
    assert np.gradient(q.y, v.time_s)[2:-2] == pytest.approx(q.east[2:-2], abs=2e-3)


def test_the_readings_of_a_voyage_come_back_as_they_were(voyage):
    back = PlantedReadings.of(voyage).into(voyage)
    for name, values in voyage.columns.items():
        assert back[name] == pytest.approx(values, abs=1e-9)


def test_place_and_velocity_still_belong_together_behind_an_antenna_a_stream_and_a_delay(voyage):
    for v in (voyage, antenna_elsewhere(voyage, 40.0), in_a_stream(voyage, 0.5, -0.3)):
        moves_as_it_says(v)
    late = late_receiver(voyage, 5.0)
    assert late["north_m"] == pytest.approx(voyage["north_m"][: len(late)]) and late[
        "heading_true_north_deg"
    ][0] == pytest.approx(np.degrees(R * 5))


def test_a_turned_compass_moves_the_ship_nowhere_and_makes_her_drift(voyage):
    v = turned_compass(voyage, 0.05)
    assert v["north_m"] == pytest.approx(voyage["north_m"])
    assert v["sway_velocity_mps"] == pytest.approx(-U * np.sin(0.05)) and v[
        "surge_velocity_mps"
    ] == pytest.approx(U * np.cos(0.05))


def with_wind(v, speed, came):
    """The voyage in a wind of `speed` [m/s] from `came` [deg], read about the ship and worked out on board."""
    q = PlantedReadings.of(v)
    about = (-speed * np.exp(1j * np.radians(came)) - q.north - 1j * q.east) * np.exp(-1j * q.psi)
    wind = {
        "true_wind_speed_mps": np.full(len(v), speed),
        "true_wind_direction_deg": np.full(len(v), came),
        "apparent_wind_speed_mps": np.abs(about),
        "apparent_wind_angle_deg": np.degrees(np.angle(-about)),
    }
    return replace(v, columns=dict(v.columns) | wind)


def test_a_wind_that_is_worked_out_on_board_turns_with_the_compass_and_the_wind_about_the_ship_does_not(
    voyage,
):
    """Expected: as the effect that is named of it has it, but for the ship's own part in the wind; heading, speed
    over ground and the wind about the ship, all as shown, make the true wind that is shown."""
    windy = with_wind(voyage, 40.0, 300.0)
    v = turned_compass(windy, 0.05)
    turned = v["true_wind_direction_deg"] - 300.0
    assert turned == pytest.approx(np.degrees(0.05), abs=np.degrees(0.05 * U / 40.0))
    for name in ("apparent_wind_speed_mps", "apparent_wind_angle_deg"):
        assert v[name] is windy[name]
    again = with_wind(v, v["true_wind_speed_mps"], v["true_wind_direction_deg"])
    assert again["apparent_wind_speed_mps"] == pytest.approx(windy["apparent_wind_speed_mps"])
    assert again["apparent_wind_angle_deg"] == pytest.approx(windy["apparent_wind_angle_deg"])


def test_a_true_wind_stays_known_where_the_speed_over_ground_is_not(voyage):
    windy = with_wind(voyage, 40.0, 300.0)
    hole = windy["surge_velocity_mps"].copy()
    hole[5:9] = np.nan
    v = turned_compass(replace(windy, columns=dict(windy.columns) | {"surge_velocity_mps": hole}), 0.05)
    assert v["true_wind_direction_deg"][5:9] == pytest.approx(300.0 + np.degrees(0.05))
    assert v["true_wind_speed_mps"][5:9] == pytest.approx(40.0)


def test_a_rudder_that_comes_later_was_recorded_earlier(voyage):
    assert early_rudder(voyage, 7.0)["rudder_angle_deg"][:500] == pytest.approx(
        voyage["rudder_angle_deg"][7:507]
    )


def test_each_basin_has_its_map_of_columns():
    for basin in BASINS:
        assert (MAPS / f"kvlcc2_{basin.folder}.toml").is_file()


def test_every_fault_has_a_name_in_the_catalogue_and_changes_the_readings(voyage):
    for fault in FAULTS:
        assert all(find(name) for name in fault.effects)
        put = fault.put(voyage, 320.0, 7.97)
        assert (put is voyage) == (not fault.effects)
    assert len({fault.words for fault in FAULTS}) == len(FAULTS)


@thorough
def test_the_table_says_what_was_put_and_what_was_named():
    ship = load(SHIP)
    from twin.commands.story import TUESDAY
    from twin.recording.read import read_voyage

    gyro = next(f for f in FAULTS if f.effects == ("GyroBias",))
    row = answer(gyro, [read_voyage(TUESDAY)], ship)
    line = real_faults.table([row]).splitlines()[-1]
    assert gyro.words in line and "GyroBias" in row["missing"] and f"`{row['verdict']}`" in line
