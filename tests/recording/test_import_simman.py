"""The measured KVLCC2 runs of SIMMAN 2008 go in through their maps; left in the map, each of their traps is
named.

The files have no licence and stay outside: SHIPTWIN_DATA names the folder that holds `kvlcc2_simman/`.
"""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.thorough import one_of
from twin.physics.ship import load
from twin.recording.checks import run_checks
from twin.recording.map_file import read_map
from twin.recording.mapping import Column
from twin.recording.read import read_voyage

FOLDER = Path(os.environ.get("SHIPTWIN_DATA", "")) / "kvlcc2_simman"
MAPS = Path(__file__).parents[2] / "docs" / "maps"
HSVA, MARIN = read_map(MAPS / "kvlcc2_hsva.toml"), read_map(MAPS / "kvlcc2_marin.toml")
pytestmark = pytest.mark.skipif(
    not ("SHIPTWIN_DATA" in os.environ and FOLDER.is_dir()),
    reason="SHIPTWIN_DATA does not name a folder with kvlcc2_simman/",
)


def files(who):
    return sorted((FOLDER / who).glob("*.dat"))


def with_columns(by, **columns):
    return replace(by, columns=dict(by.columns) | columns)


def test_all_thirteen_runs_go_in_and_pass_in_silence():
    for who, by, ship, count in (
        ("hsva", HSVA, load("kvlcc2_model"), 9),
        ("marin", MARIN, load("kvlcc2"), 4),
    ):
        assert len(files(who)) == count
        for path in files(who):
            assert [c.text for c in run_checks(read_voyage(path, by), ship) if not c.ok] == [], path.name


def test_hsvas_velocities_are_turned_into_the_ships_axes():
    v = read_voyage(files("hsva")[2], HSVA)
    assert v.step_s == pytest.approx(0.05) and v["propeller_rate_rpm"][0] == pytest.approx(613.77)
    w = (v["surge_velocity_mps"] + 1j * v["sway_velocity_mps"]) * np.exp(1j * v.si("heading_true_north_deg"))
    sailed = np.sum((w[1:] + w[:-1]) / 2 * np.diff(v.time_s))
    assert sailed.real == pytest.approx(v["north_m"][-1] - v["north_m"][0], rel=1e-3)


def test_marins_step_is_rebuilt_from_its_rounded_stamps_and_the_position_stays_on_the_files_own():
    for path in files("marin"):
        v = read_voyage(path, MARIN)
        assert v.step_s == pytest.approx(0.13526, abs=2e-5) and np.ptp(np.diff(v.time_s)) < 1e-9
        rounded = read_voyage(path, with_columns(MARIN, north_m=Column(2), east_m=Column(3)))
        for name, within_m in (("north_m", 8.0), ("east_m", 2.5)):  # three digits: 10 m beyond 1 km
            assert np.abs(v[name] - (rounded[name] - rounded[name][0])).max() < within_m


EARTH = {"surge_velocity_mps": Column(5), "sway_velocity_mps": Column(6)}
EARTH_MARIN = {"surge_velocity_mps": Column(6), "sway_velocity_mps": Column(7)}
TRAPS = {
    "hsva: earth-fixed velocities called u and v": (
        "hsva",
        with_columns(HSVA, **EARTH),
        "velocity_frame",
        "earth-fixed",
    ),
    "hsva: 1/s for rpm": ("hsva", with_columns(HSVA, propeller_rate_rpm=Column(10)), "propeller_rate", "1/s"),
    "marin: earth-fixed velocities, without position": (
        "marin",
        with_columns(MARIN, **EARTH_MARIN),
        "velocity_frame",
        "earth-fixed",
    ),
    "marin: earth-fixed velocities, with position": (
        "marin",
        with_columns(MARIN, north_m=Column(2), east_m=Column(3), **EARTH_MARIN),
        "velocity_frame",
        "earth-fixed",
    ),
    "marin: rudder positive to port": (
        "marin",
        with_columns(MARIN, rudder_angle_deg=Column(10)),
        "rudder_sign",
        "to port",
    ),
    "marin: rounded stamps that repeat": (
        "marin",
        replace(MARIN, time=replace(MARIN.time, rebuild=False)),
        "time_stamps",
        "rounded",
    ),
}


@pytest.mark.parametrize("trap", one_of(TRAPS))
def test_the_trap_left_in_the_map_is_named_in_every_file(trap):
    who, by, check, words = TRAPS[trap]
    for path in files(who):
        answers = {c.name: c for c in run_checks(read_voyage(path, by))}
        assert answers[check].unusable and words in answers[check].text, (path.name, answers[check].text)


def test_a_mirrored_rudder_is_proved_where_the_heading_swings_far_enough_to_tell_it_from_a_mirrored_heading():
    """Test: HSVA's rudder positive to port. Expected: proved where the heading swings by more than 15 deg to
    each side; in zigzags of less than 10 deg, where a mirrored heading with its rate of turn explains the same
    within the margin, both explanations are named with their remedies and neither is proved."""
    by = with_columns(HSVA, rudder_angle_deg=Column(9))
    told = {True: 0, False: 0}
    for path in files("hsva"):
        voyage = read_voyage(path, by)
        heading = (voyage["heading_true_north_deg"] + 180.0) % 360.0 - 180.0
        wide = min(-np.nanmin(heading), np.nanmax(heading)) > 15.0
        said = {c.name: c for c in run_checks(voyage)}["rudder_sign"]
        assert said.unusable == wide and not said.ok, (path.name, said.text)
        assert "sign = -1 for rudder_angle_deg" in said.text, (path.name, said.text)
        assert wide or "sign = -1 for heading_true_north_deg" in said.text, (path.name, said.text)
        told[wide] += 1
    assert told == {True: 6, False: 3}


def test_marins_turns_taken_for_1_per_s_are_named_with_the_ship():
    by = with_columns(MARIN, propeller_rate_rpm=Column(11, unit="1/s"))
    for path in files("marin"):
        answers = {c.name: c for c in run_checks(read_voyage(path, by), load("kvlcc2"))}
        assert answers["propeller_rate"].unusable and "60 times too large" in answers["propeller_rate"].text


def test_a_models_file_given_with_the_ship_is_noticed():
    answers = {c.name: c for c in run_checks(read_voyage(files("hsva")[-1], HSVA), load("kvlcc2"))}
    assert not answers["propeller_rate"].ok and "a smaller ship" in answers["propeller_rate"].text
