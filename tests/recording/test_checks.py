"""Each trap is found when it is there, by its own check; nothing is found when none is there."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from twin.physics.ship import load
from twin.recording.checks import CHECKS, run_checks
from twin.recording.checks.water import factor
from twin.recording.raw import Raw
from twin.recording.voyage import Voyage

SURGE, SWAY, HEADING = "surge_velocity_mps", "sway_velocity_mps", "heading_true_north_deg"
RATE, RUDDER, TURNS = "yaw_rate_degps", "rudder_angle_deg", "propeller_rate_rpm"
WIND, WIND_FROM = "true_wind_speed_mps", "true_wind_direction_deg"
AIR, AIR_FROM = "apparent_wind_speed_mps", "apparent_wind_angle_deg"
LOG = "surge_velocity_through_water_mps"
KNOTS = 3600.0 / 1852.0


def voyage(columns):
    columns = {name: np.array(x, float) for name, x in columns.items()}
    time_s = columns.pop("time_s")
    return Voyage.of(Raw(Path("test.csv"), np.arange(2, time_s.size + 2), time_s, columns, {}))


def answers(columns, ship=None):
    return {check.name: check for check in run_checks(voyage(columns), ship)}


def times(name, factor):
    return lambda c: c | {name: c[name] * factor}


def earth_fixed(c):
    w = (c[SURGE] + 1j * c[SWAY]) * np.exp(1j * np.radians(c[HEADING]))
    return c | {SURGE: w.real, SWAY: w.imag}


def through_water(current):
    def plant(c):
        ahead = np.exp(1j * np.radians(c[HEADING]))
        w = (c[SURGE] + 1j * c[SWAY]) - current / ahead
        return c | {SURGE: w.real, SWAY: w.imag}

    return plant


def blank(name, start_s, end_s):
    return lambda c: c | {name: np.where((c["time_s"] > start_s) & (c["time_s"] < end_s), np.nan, c[name])}


def stuck(name, start_s, end_s):
    def plant(c):
        inside = (c["time_s"] > start_s) & (c["time_s"] < end_s)
        return c | {name: np.where(inside, c[name][np.argmax(inside)], c[name])}

    return plant


def spike(name, size):
    def plant(c):
        x = c[name].copy()
        x[[400, 2500]] += size
        return c | {name: x}

    return plant


def without_rows(start_s, end_s):
    return lambda c: {n: x[(c["time_s"] < start_s) | (c["time_s"] > end_s)] for n, x in c.items()}


TRAPS = {
    "earth-fixed velocities called u and v": ("velocity_frame", earth_fixed, "earth-fixed"),
    "knots taken for m/s": ("velocity_frame", lambda c: times(SURGE, KNOTS)(times(SWAY, KNOTS)(c)), "knots"),
    "north and east swapped": (
        "velocity_frame",
        lambda c: c | {"north_m": c["east_m"], "east_m": c["north_m"]},
        "north and east are swapped",
    ),
    "surge and sway swapped": ("velocity_frame", lambda c: c | {SURGE: c[SWAY], SWAY: c[SURGE]}, "swapped"),
    "sway positive to port": ("velocity_frame", times(SWAY, -1.0), "positive to port"),
    "heading in radians": ("velocity_frame", lambda c: c | {HEADING: np.radians(c[HEADING])}, "radians"),
    "heading from east, anticlockwise": (
        "velocity_frame",
        lambda c: c | {HEADING: 90.0 - c[HEADING]},
        "anticlockwise",
    ),
    "magnetic heading, 12 deg off": (
        "velocity_frame",
        lambda c: c | {HEADING: c[HEADING] + 12.0},
        "-12.0 deg off",
    ),
    "speed through water called over ground": (
        "velocity_frame",
        through_water(1.5 - 1.0j),
        "stream of 1.80 m/s",
    ),
    "the same in a weak current": ("velocity_frame", through_water(0.3 - 0.4j), "stream of 0.50 m/s"),
    "time in milliseconds": ("velocity_frame", times("time_s", 1000.0), "milliseconds"),
    "time in minutes": ("velocity_frame", times("time_s", 1.0 / 60.0), "minutes"),
    "yaw rate in rad/s": ("yaw_rate", times(RATE, np.pi / 180.0), "rad/s"),
    "yaw rate in deg/min": ("yaw_rate", times(RATE, 60.0), "deg/min"),
    "yaw rate positive to port": ("yaw_rate", times(RATE, -1.0), "positive to port"),
    "rudder positive to port": ("rudder_sign", times(RUDDER, -1.0), "positive to port"),
    "rudder in radians": ("rudder_unit", times(RUDDER, np.pi / 180.0), "radians"),
    "rpm for 1/s": ("propeller_rate", times(TURNS, 1.0 / 60.0), "1/s"),
    "wind to for wind from": ("wind", lambda c: c | {WIND_FROM: c[WIND_FROM] + 180.0}, "blows to"),
    "wind direction in radians": ("wind", lambda c: c | {WIND_FROM: np.radians(c[WIND_FROM])}, "radians"),
    "apparent angle positive to port": ("wind", times(AIR_FROM, -1.0), "positive to port"),
    "apparent wind taken as true": (
        "wind",
        lambda c: c | {WIND: c[AIR], WIND_FROM: c[AIR_FROM] + c[HEADING]},
        "is the apparent wind",
    ),
    "wind in knots": ("wind", times(AIR, KNOTS), "knots"),
    "speed log in knots": ("speed_log", times(LOG, KNOTS), "kn"),
    "rounded time stamps": ("time_stamps", lambda c: c | {"time_s": np.round(c["time_s"])}, "rounded"),
    "a gap": ("time_gaps", without_rows(300.0, 340.0), "40"),
    "a hole in the heading": ("missing_samples", blank(HEADING, 300.0, 330.0), "has a hole"),
    "a tail without rudder": ("missing_samples", blank(RUDDER, 700.0, 1e9), "ends early"),
    "a tail without wind, held": ("missing_samples", blank(WIND, 700.0, 1e9), "what was read last"),
    "a heading that hangs": ("frozen", stuck(HEADING, 100.0, 160.0), "heading_true_north_deg stays"),
    "a position that hangs": ("frozen", stuck("north_m", 100.0, 130.0), "north_m stays"),
    "a speed that hangs at zero": (
        "frozen",
        lambda c: c | {SURGE: np.where(abs(c["time_s"] - 200) < 60, 0.0, c[SURGE])},
        "surge_velocity_mps stays",
    ),
    "spikes in the heading": ("spikes", spike(HEADING, 25.0), "heading_true_north_deg 2"),
    "a wind sensor that says 655.35": (
        "plausible_values",
        lambda c: c | {WIND: np.where(c["time_s"] > 800, 300.0, c[WIND])},
        "outside",
    ),
}


def test_good_data_passes_every_check_in_silence(sail):
    for seed, (length, speed, noise) in enumerate(
        [(100.0, 7.0, 1.0), (320.0, 8.0, 1.0), (7.0, 1.2, 0.05), (2.0, 1.5, 0.05)]
    ):
        columns = sail(900.0, length, speed, noise, seed)
        assert [c.text for c in answers(columns).values() if not c.ok] == []


@pytest.fixture(scope="module")
def answered(sail):
    return cache(lambda trap: answers(TRAPS[trap][1](sail()))[TRAPS[trap][0]])  # by its own check, once


@pytest.mark.parametrize("trap", TRAPS)
def test_the_trap_is_named(answered, trap):
    found = answered(trap)
    assert not found.ok and TRAPS[trap][2] in found.text, found.text


PROVED = [name for name, (check, _, _) in TRAPS.items() if check in ("velocity_frame", "yaw_rate")]


@pytest.mark.parametrize("trap", PROVED)
def test_a_proved_mistake_makes_the_data_unusable_and_says_what_to_write_in_the_map(answered, trap):
    found = answered(trap)
    assert found.unusable and ("In the map" in found.text or "offset" in found.text)


def test_wrapping_headings_are_no_mistake(sail):
    columns = sail()
    for wrapped in (columns[HEADING], (columns[HEADING] + 180.0) % 360.0 - 180.0):
        assert all(c.ok for c in answers(columns | {HEADING: wrapped}).values())


def test_a_true_wind_that_follows_from_the_apparent_one_is_not_said_to_be_absent(sail):
    columns = {name: x for name, x in sail().items() if name not in (WIND, WIND_FROM)}
    assert WIND not in answers(columns)["missing_samples"].text
    without = {name: x for name, x in columns.items() if name != AIR_FROM}
    assert WIND in answers(without)["missing_samples"].text


def test_an_apparent_wind_alone_proves_nothing(sail):
    assert not answers({n: x for n, x in sail().items() if n not in (WIND, WIND_FROM)})["wind"].informative


def test_velocities_that_are_slopes_of_the_position_prove_nothing(sail):
    found = answers({n: x for n, x in sail().items() if n not in (SURGE, SWAY)})["velocity_frame"]
    assert found.ok and not found.informative and "not independent" in found.text


def test_the_yaw_rate_of_a_constant_heading_cannot_be_told(sail):
    columns = sail()
    t = columns["time_s"]
    straight = {"time_s": t, "north_m": 7.0 * t, "east_m": 0.0 * t, HEADING: 0.0 * t,
        SURGE: 7.0 + 0 * t, SWAY: 0 * t,
                RATE: 0.001 * np.sin(t), RUDDER: 0.01 * np.sin(t), TURNS: 110.0 + 0 * t}  # fmt: skip
    found = answers(straight)
    assert all(c.ok for c in found.values())
    for name in ("yaw_rate", "rudder_sign", "wind", "speed_log", "ship_size"):
        assert found[name].text.startswith("cannot tell")


def test_a_speed_over_ground_that_scatters_does_not_make_a_log_short():
    """Test: a zigzag with a right log in a stream of 0.1 m/s; the speed over ground is the slope of positions
    and scatters by 0.5 m/s.
    Expected: 1.00 and that stream. (With the speed over ground as the cause, k is short and a stream stands
        in for the rest.)"""
    rng, t = np.random.default_rng(5), np.arange(0.0, 2400.0)
    psi, true = 0.8 * np.sin(t / 90.0), 6.0 + 1.2 * np.sin(t / 45.0)
    log = true - 0.1 * np.cos(psi - 1.0) + 0.04 * rng.standard_normal(t.size)
    shown = true + 0.5 * rng.standard_normal(t.size)
    (k, current, _), (short, strong, _) = (factor(shown, log, psi, 1.0, rough) for rough in (True, False))
    assert k == pytest.approx(1.0, abs=0.02) and current == pytest.approx(0.1, abs=0.05)
    assert short < 0.85 and strong > 1.0


def test_five_minutes_are_too_short_and_say_so(sail):
    found = answers(sail(300.0))["duration"]
    assert not found.ok and not found.unusable and "too short" in found.text


def test_the_advance_ratio_of_a_known_ship_proves_the_unit_of_the_turns(sail):
    tanker, columns = load("kvlcc2"), sail(900.0, 320.0, 7.5)
    columns[TURNS] = columns[TURNS] * 0.8
    assert answers(columns, tanker)["propeller_rate"].ok
    found = answers(times(TURNS, 60.0)(columns), tanker)["propeller_rate"]
    assert found.unusable and "60 times too large" in found.text
    found = answers(times(TURNS, 1.0 / 60.0)(columns), tanker)["propeller_rate"]
    assert found.unusable and "1/s" in found.text


def test_another_ships_file_is_noticed(sail):
    boat, tanker = load("usv"), load("kvlcc2")
    columns = sail(900.0, 320.0, 8.0)
    assert answers(columns, tanker)["ship_size"].ok
    assert "too fast" in answers(columns, boat)["ship_size"].text
    assert "no ship turns" in answers(sail(900.0, 7.0, 1.2, 0.05), tanker)["ship_size"].text


def test_a_derived_velocity_is_not_evidence(sail):
    columns = {n: x for n, x in sail().items() if n not in (SURGE, SWAY, RATE)}
    found = answers(columns)
    assert "not independent" in found["velocity_frame"].text and "derived" in found["yaw_rate"].text
    without_place = {n: x for n, x in sail().items() if n not in ("north_m", "east_m")}
    assert answers(earth_fixed(without_place))["velocity_frame"].unusable


def test_every_check_answers_under_its_own_name_with_a_sentence(sail):
    for check, answer in zip(CHECKS, run_checks(voyage(sail(60.0))), strict=True):
        assert answer.name == check.__name__ and len(answer.text) > 10
        assert set(answer.as_json()) == {"check", "ok", "text", "proved", "told"}


def test_a_gap_is_no_sensor_that_hangs(sail):
    """Test: the log shows the same value on both sides of a gap of 40 s. Expected: the gap is named, no
    frozen sensor."""
    columns = sail()
    keep = ((t := columns["time_s"]) < 300.0) | (t > 340.0)
    columns[SURGE] = np.where((t > 299.5) & (t < 340.5), 6.9, columns[SURGE])
    found = answers({n: x[keep] for n, x in columns.items()})
    assert not found["time_gaps"].ok
    assert found["frozen"].ok, found["frozen"].text


def messages(columns, digits):
    """A log with a row for each message: heading and rate twice a second, rudder and engine once, place and
    speed once, stamped as they came."""
    rng, t, rows = np.random.default_rng(3), columns["time_s"], []
    apart = ((HEADING, RATE), (RUDDER,), (TURNS,), ("north_m", "east_m", SURGE, SWAY))
    for i in np.flatnonzero(np.isclose(t % 0.5, 0.0)):
        now = apart if t[i] % 1.0 == 0.0 else apart[:1]
        rows += [(t[i] + rng.uniform(0.0, 0.03), names, i) for names in now]
    rows.sort(key=lambda row: row[0])
    out = {
        name: np.array([columns[name][i] if name in names else np.nan for _, names, i in rows])
        for name in sum(apart, ())
    }
    return out | {"time_s": np.round([stamp for stamp, _, _ in rows], digits)}


@pytest.mark.parametrize("digits", [2, 3])
def test_two_instruments_that_speak_at_one_moment_are_no_stamp_twice(sail, digits):
    """Test: a row for each message, 2 % to a third of the stamps on two rows. Expected: no rounded stamps, no
    gaps."""
    log = messages(sail(300.0), digits)
    assert (np.diff(log["time_s"]) == 0.0).mean() > 0.01
    found = answers(log)
    assert found["time_stamps"].ok and "every 0.5" in found["time_stamps"].text, found["time_stamps"].text
    assert found["time_gaps"].ok, found["time_gaps"].text


def test_a_hole_in_a_log_of_messages_is_found_all_the_same(sail):
    log = messages(sail(300.0), 3)
    keep = (log["time_s"] < 100.0) | (log["time_s"] > 140.0)
    found = answers({name: values[keep] for name, values in log.items()})
    assert not found["time_gaps"].ok and "40" in found["time_gaps"].text
