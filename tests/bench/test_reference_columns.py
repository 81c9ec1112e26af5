"""Signs, frames and units of every measured column."""

import numpy as np
import pytest

from bench.reference import HULLS, SeaCase, Weather, simulate
from bench.reference.isherwood import table
from bench.reference.sensor_suite import COLUMNS
from bench.reference.trial_legs import RUDDER, Leg

TURN = (Leg(RUDDER, 99, 15),)
WINDY = Weather(8.0, 60.0, 0.0, 0.0, 8.0, 0.0, 0.3, 120.0)


@pytest.fixture(scope="module")
def turning():
    return simulate([SeaCase("usv", TURN, WINDY, heading_deg=30.0, duration_s=30.0, sensors="perfect")])[0]


@pytest.fixture(scope="module")
def measured():
    return simulate([SeaCase("usv", TURN, WINDY, heading_deg=30.0, duration_s=30.0)])[0]


def test_the_columns_are_those_of_the_contract(measured):
    assert list(measured.columns) == COLUMNS and len(COLUMNS) == 23
    assert np.diff(measured.columns["time_s"]) == pytest.approx(0.1)


def test_velocities_over_ground_carry_the_position(turning):
    c, psi = turning.columns, np.radians(np.unwrap(turning.columns["heading_true_north_deg"], period=360))
    u, v = c["surge_velocity_mps"], c["sway_velocity_mps"]
    inner = slice(5, -5)
    north, east = np.gradient(c["north_m"], 0.1), np.gradient(c["east_m"], 0.1)
    assert north[inner] == pytest.approx((u * np.cos(psi) - v * np.sin(psi))[inner], abs=0.02)
    assert east[inner] == pytest.approx((u * np.sin(psi) + v * np.cos(psi))[inner], abs=0.02)
    assert np.gradient(np.degrees(psi), 0.1)[inner] == pytest.approx(c["yaw_rate_degps"][inner], abs=0.3)


def test_a_positive_rudder_turns_her_to_starboard_and_heels_her_out(turning):
    assert turning.columns["rudder_angle_deg"][50] == pytest.approx(15, abs=0.3)
    assert turning.columns["yaw_rate_degps"][-1] > 5
    assert turning.truth["v"][-1] < 0
    calm = simulate([SeaCase("usv", TURN, Weather(), heading_deg=0, duration_s=30.0, sensors="perfect")])[0]
    assert calm.columns["roll_deg"][-1] < -0.3


def test_ground_speed_is_speed_through_water_plus_current(turning):
    c, psi = turning.columns, np.radians(turning.columns["heading_true_north_deg"])
    to = np.radians(30 + 120)
    along = c["surge_velocity_mps"] - c["surge_velocity_through_water_mps"]
    across = c["sway_velocity_mps"] - c["sway_velocity_through_water_mps"]
    assert along == pytest.approx(0.3 * np.cos(to - psi), abs=1e-6)
    assert across == pytest.approx(0.3 * np.sin(to - psi), abs=1e-6)


def test_apparent_wind_is_true_wind_and_her_own(turning):
    c, psi = turning.columns, np.radians(turning.columns["heading_true_north_deg"])
    came = np.radians(c["true_wind_direction_deg"]) - psi
    ahead = c["true_wind_speed_mps"] * np.cos(came) + c["surge_velocity_mps"]
    aside = c["true_wind_speed_mps"] * np.sin(came) + c["sway_velocity_mps"]
    assert c["apparent_wind_speed_mps"] == pytest.approx(np.hypot(ahead, aside), abs=1e-6)
    assert np.cos(np.radians(c["apparent_wind_angle_deg"])) == pytest.approx(
        ahead / np.hypot(ahead, aside), abs=1e-6
    )
    assert c["apparent_wind_angle_deg"][0] > 0  # from starboard, positive


@pytest.mark.parametrize("hull", HULLS)
def test_wind_on_the_starboard_beam_pushes_to_port_and_head_wind_slows(hull):
    weathers = [Weather(10.0, deg, 0.0) for deg in (90.0, 0.0, 180.0)]
    beam, head, astern = simulate(
        [SeaCase(hull, "straight", w, heading_deg=0, duration_s=1.0) for w in weathers]
    )
    assert beam.truth["forces"]["wind"]["Y_N"][0] < 0 and beam.truth["v"][-1] < 0
    assert head.truth["forces"]["wind"]["X_N"][0] < 0 < astern.truth["forces"]["wind"]["X_N"][0]
    cx, cy, _ = table(HULLS[hull])
    assert 0.3 < -cx[0] < 1.4 and 0.5 < cy[9] < 1.3  # the range of Isherwood's ships


def test_waves_from_starboard_drift_her_to_port():
    sea = Weather(wave_height_m=3.0, wave_period_s=8.0, wave_from_deg=90.0)
    voyage = simulate([SeaCase("container", "straight", sea, heading_deg=0, duration_s=120.0)], tick_s=0.4)[0]
    assert voyage.truth["forces"]["waves"]["Y_N"].mean() < 0
    assert np.ptp(voyage.truth["heave"]) > 0.3 and np.ptp(voyage.truth["pitch"]) > 0


def test_noise_has_the_stated_size(measured, turning):
    position, speed, heading, rate, log = HULLS["usv"].noise
    sizes = {"surge_velocity_mps": speed, "heading_true_north_deg": heading, "yaw_rate_degps": rate}
    for name, size in sizes.items():
        late = 1 if name.startswith("surge") else 0
        rest = measured.columns[name][late:] - turning.columns[name][: len(turning.columns[name]) - late]
        rest = rest[np.abs(rest) < 180]
        assert np.nanstd(rest[40:]) == pytest.approx(size, rel=0.25), name
    assert position == 0.02 and log == 0.02


def test_instruments_sample_at_their_own_rates(measured):
    share = {name: 1 - np.isnan(c).mean() for name, c in measured.columns.items()}
    assert share["time_s"] == 1 and share["north_m"] == pytest.approx(0.5, abs=0.03)
    assert share["surge_velocity_through_water_mps"] == pytest.approx(0.2, abs=0.03)
    assert share["true_wind_speed_mps"] == pytest.approx(0.1, abs=0.02)
    assert np.isfinite(measured.columns["wave_height_significant_m"][0]) and share["draught_mean_m"] < 0.01


def test_angles_stay_in_their_ranges(measured):
    for name in ("heading_true_north_deg", "true_wind_direction_deg", "wave_direction_deg"):
        values = measured.columns[name][~np.isnan(measured.columns[name])]
        assert (values >= 0).all() and (values < 360).all()
    assert np.nanmax(np.abs(measured.columns["apparent_wind_angle_deg"])) <= 180
