"""What chance, leeway and a boat without way on show is no proof of a mistake."""

from pathlib import Path

import numpy as np
import pytest

from twin.recording.checks import run_checks
from twin.recording.checks.rudder import best_gain
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.raw import Raw
from twin.recording.voyage import Voyage

HEADING, RUDDER = "heading_true_north_deg", "rudder_angle_deg"


def voyage(time_s, **columns):
    full = {"propeller_rate_rpm": np.full(time_s.size, 900.0)} | columns
    return Voyage.of(Raw(Path("boat.csv"), np.arange(2, time_s.size + 2), time_s, full, {}))


def answers(of):
    return {c.name: c for c in run_checks(of)}


def straight(seed):
    """A boat on one course for a quarter of an hour: its rudder and its rate of turn are noise."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 900.0, 0.5)
    noise = {n: rng.standard_normal(t.size) for n in ("psi", "u", "v", "r")}
    way = np.cumsum(np.full(t.size, 0.75 * np.exp(1j * np.radians(40.0))))
    north, east, rudder, turns = rng.standard_normal((4, t.size))
    return voyage(
        t,
        north_m=way.real + 0.3 * north,
        east_m=way.imag + 0.3 * east,
        propeller_rate_rpm=900.0 + turns,
        surge_velocity_mps=1.5 + 0.01 * noise["u"],
        sway_velocity_mps=0.02 * noise["v"],
        yaw_rate_degps=0.15 * noise["r"],
        **{HEADING: 40.0 + 0.2 * noise["psi"], RUDDER: 0.05 * rudder},
    )


@pytest.mark.parametrize("seed", [286, 339])
def test_a_rudder_that_agrees_with_the_turning_by_chance_explains_none_of_it(seed):
    """Test: of 400 such voyages the two on which windows of 80 s gave half of the turning to the rudder."""
    assert best_gain(VoyageView(straight(seed), None)) == (0.0, 0.0)


@pytest.mark.parametrize("seed", [7, 9, 22, 24])
def test_a_boat_without_way_on_that_lies_in_the_waves_has_no_compass_that_jumps(seed):
    """Test: for a minute the boat lies in the waves, its velocity turns about at once and its heading by a few
    degrees a second."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 900.0)
    lies = (t > 500.0) & (t < 560.0)
    psi = np.cumsum(np.where(lies, 8.0 * np.sin(t / 3.0), 0.5 * np.sin(t / 25.0)))
    w = 1.2 * np.exp(1j * np.radians(psi))
    w[lies] = 0.3 * np.exp(1j * np.cumsum(0.7 * rng.standard_normal(lies.sum())))
    way = np.cumsum(w)
    boat = Voyage.of(
        Raw(
            Path("boat.csv"),
            np.arange(2, t.size + 2),
            t,
            {
                "north_m": way.real,
                "east_m": way.imag,
                "surge_velocity_mps": (w * np.exp(-1j * np.radians(psi))).real,
                "sway_velocity_mps": (w * np.exp(-1j * np.radians(psi))).imag,
                HEADING: psi % 360.0,
                RUDDER: 5.0 * np.sin(t / 25.0),
                "propeller_rate_rpm": np.full(t.size, 900.0),
            },
            {},
        )
    )
    assert not answers(boat)["heading_steps"].unusable


@pytest.mark.parametrize("turns, proved", [(False, False), (True, True)])
def test_earth_fixed_velocities_without_a_position_are_proved_by_a_turn_and_not_by_leeway(turns, proved):
    """Test: heading 338 deg and 28 deg of leeway to starboard make a course of 6 deg, which is what velocities
    to the north and east would look like; and velocities to the north and east of a ship that turns."""
    t = np.arange(0.0, 900.0)
    psi = 338.0 + (60.0 * np.sin(t / 60.0) if turns else 0.5 * np.sin(t / 20.0))
    ahead = np.exp(1j * np.radians(psi if turns else np.full(t.size, -28.0)))
    boat = voyage(
        t,
        surge_velocity_mps=1.2 * ahead.real,
        sway_velocity_mps=1.2 * ahead.imag,
        **{HEADING: psi % 360.0, RUDDER: 5.0 * np.cos(t / 60.0)},
    )
    answer = answers(boat)["velocity_frame"]
    assert "earth-fixed" in answer.text and not answer.ok
    assert answer.unusable is proved


@pytest.mark.parametrize("leaps_deg, proved", [(0.0, False), (40.0, True)])
def test_a_turn_of_which_a_sample_is_missing_is_no_compass_that_jumps(leaps_deg, proved):
    """Test: a boat in a zigzag, its course behind its heading as it slides, one sample in 17 missing; and
    the same boat with a compass that jumps where a sample is missing. Expected: only the jump is one."""
    t = np.arange(0.0, 900.0)
    psi = 20.0 + 10.0 * np.sin(2.0 * np.pi * t / 13.0)
    course = 20.0 + 5.0 * np.sin(2.0 * np.pi * t / 13.0 - 1.0)
    over_ground = 10.0 * np.exp(1j * np.radians(course))
    way, there = np.cumsum(over_ground), t % 17.0 != 5.0
    shown = psi + leaps_deg * (t > 497.0)
    ahead = over_ground * np.exp(-1j * np.radians(shown))
    boat = voyage(
        t[there],
        north_m=way.real[there],
        east_m=way.imag[there],
        surge_velocity_mps=ahead.real[there],
        sway_velocity_mps=ahead.imag[there],
        **{HEADING: shown[there], RUDDER: 9.0 * np.sign(np.cos(2.0 * np.pi * t / 13.0))[there]},
    )
    assert answers(boat)["heading_steps"].unusable == proved
