"""Sides, signs and zeros of actuators, on boats that share no equation with the twin."""

from dataclasses import replace

import numpy as np
import pytest

from bench.small_boats import KINDS, MISTAKES, healthy, sailed, ship_of
from twin.num import num
from twin.physics.ship import load
from twin.recording.checks import run_checks
from twin.recording.checks.actuator_response import actuators
from twin.recording.checks.check_result import doubtful, wrong
from twin.recording.checks.joint_checks import joint_answers
from twin.recording.checks.size import ship_size
from twin.recording.checks.standstill import actuator_zero
from twin.recording.checks.steps import heading_steps
from twin.recording.checks.undo import HEADING
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.checks.wirings import wirings
from twin.recording.voyage import Voyage

SEED = 4242


def answer(voyage, ship):
    return actuators(VoyageView(voyage, ship))


def test_on_healthy_boats_of_every_kind_nothing_is_proved():
    found = healthy(1)
    assert found["voyages"] == len(KINDS) and found["proved"] == [] and found["looks"] == []


@pytest.mark.parametrize(
    ("kind", "what", "plant", "words"), MISTAKES, ids=[f"{m[0]}: {m[1]}" for m in MISTAKES]
)
def test_a_mistake_of_the_wiring_is_named_and_undone(kind, what, plant, words):
    """Expected: proved, named in the first words, and the same mistake once more (its own remedy, but for a
    zero of an angle) gives a voyage with which nothing is wrong."""
    right = sailed(kind, SEED)
    wrong = replace(right, columns=plant(dict(right.columns)))
    found = answer(wrong, ship_of(kind))
    assert found.unusable and f"{words}, that is believed" in found.text
    if "90 deg" not in what:
        assert answer(replace(wrong, columns=plant(dict(wrong.columns))), ship_of(kind)).ok


def test_only_what_turns_all_round_may_be_counted_from_elsewhere():
    """Test: the wirings tried of two outboards, whose angle is a rudder's, of four azimuths, and of both
    beside each other. Expected: of the outboards' angles none but the mirrored one."""
    outboards, azimuths = (ship_of(kind).actuators for kind in ("outboards", "azimuths"))

    def offsets(actuators):
        return {w.text for w in wirings(actuators) if "offset" in w.fix}

    assert offsets(outboards) == set() and "port is positive to port" in " ".join(
        w.text for w in wirings(outboards)
    )
    assert offsets((*outboards, *azimuths)) == {
        text.replace("each that turns", "each that turns all round") for text in offsets(azimuths)
    }
    assert any("each that turns is 180 deg off" in text for text in offsets(azimuths))


def test_a_sway_that_the_yaw_contradicts_proves_no_wiring():
    """Test: a boat of azimuths whose sway alone has the wrong sign. Expected: no mistake of the actuators is
    proved, for their one force turns the boat, too."""
    right = sailed("azimuths", SEED)
    sway = {n: -x if n.startswith("sway") else x for n, x in right.columns.items()}
    assert not answer(replace(right, columns=sway), ship_of("azimuths")).unusable


@pytest.mark.parametrize("kind", ["azimuths", "thrusters"])
def test_how_hard_a_vessel_is_to_turn_says_nothing_of_its_wiring(kind):
    """Test: a ship file whose moment of inertia is a third, and three times, what it was. Expected: the same
    answer, for water that moves along makes every vessel heavier in turning than in speed."""
    right, ship = sailed(kind, SEED), ship_of(kind)
    as_it_is, *others = (answer(right, replace(ship, I_z=k * float(ship.I_z))) for k in (1.0, 1.0 / 3.0, 3.0))
    assert as_it_is.ok and all(c.text == as_it_is.text for c in others)


def test_exchanged_sides_are_told_once_by_the_check_they_belong_to():
    right = sailed("thrusters", SEED)
    plant = next(m[2] for m in MISTAKES if m[:2] == ("thrusters", "sides exchanged"))
    found = run_checks(replace(right, columns=plant(dict(right.columns))), ship_of("thrusters"))
    assert [c.name for c in found if c.unusable] == ["actuators"]


def test_a_stop_at_another_pulse_is_read_from_where_the_boat_lies_still():
    """Test: the record of both thrusters 16 us too high; they stand still at 1516. Expected: zero = 0.04,
    and nothing on the boat whose file has it."""
    right, ship = sailed("thrusters", SEED), ship_of("thrusters")
    ship = replace(ship, actuators=tuple(replace(a, linear=1.0) for a in ship.actuators))
    moved = replace(right, columns={n: x + 16.0 * n.endswith("pwm_us") for n, x in right.columns.items()})
    found = actuator_zero(VoyageView(moved, ship))
    assert not found.ok and "zero = 0.0400 for port, 0.0400 for starboard" in found.text
    mended = ship.with_derivatives(**{"port.zero": 0.04, "starboard.zero": 0.04})
    assert actuator_zero(VoyageView(moved, mended)).ok


def test_a_rest_too_short_to_tell_is_told_with_how_long_it_must_be():
    """Test: a boat of thrusters, without and with the seconds in which it lies still. Expected: they tell its
    stop; without them nothing does, and how long and how still is said."""
    right, ship = sailed("thrusters", SEED), ship_of("thrusters")
    assert actuator_zero(VoyageView(right, ship)).informative
    later = right.time_s > 12.0
    cut = right.with_rows(right.time_s[later], {n: x[later] for n, x in right.columns.items()})
    found = actuator_zero(VoyageView(cut, ship))
    assert found.ok and not found.informative
    least = max(8.0, 10.0 * ship.L_pp / ship.U_0) / 0.75
    assert f"for {least:.0f} s" in found.text and f"below {num(0.05 * ship.U_0, 2)} m/s" in found.text


def test_without_a_ship_file_with_actuators_it_says_what_it_needs():
    found = answer(sailed("thrusters", SEED), None)
    assert found.ok and not found.informative and "--ship" in found.text


def test_a_voyage_recorded_of_other_controls_than_the_ship_file_has_is_told(sail):
    """Test: a boat's voyage without one thruster, a ship's voyage of rudder and shaft with the boat's file, and
    the boat's with a ship's. Expected: a look that names what is missing and what was recorded; of a voyage
    without any control nothing."""
    right, boat = sailed("thrusters", SEED), ship_of("thrusters")
    one = replace(right, columns={n: x for n, x in right.columns.items() if n != "port.pwm_us"})
    found = answer(one, boat)
    assert not found.ok and not found.unusable
    assert "not recorded: port.pwm_us;" in found.text and "Recorded: starboard.pwm_us" in found.text
    ship_voyage = Voyage("s", (columns := sail(200.0)).pop("time_s"), columns)
    found = answer(ship_voyage, boat)
    assert not found.ok and "Recorded: rudder_angle_deg, propeller_rate_rpm" in found.text
    assert not answer(right, load("kvlcc2")).ok and answer(ship_voyage, load("kvlcc2")).ok
    none = replace(one, columns={n: x for n, x in one.columns.items() if n != "starboard.pwm_us"})
    assert answer(none, boat).ok and not answer(none, boat).informative


def test_what_hangs_proves_nothing_of_the_wiring():
    """Test: a check that proves a wiring, beside one that says which channel stands still. Expected: a heading
    that stands still makes it a doubt that says so; a position does not."""
    view = VoyageView(sailed("thrusters", SEED), ship_of("thrusters"))

    def told(channel):
        def frozen(_):
            return doubtful("frozen", f"{channel} stays 40 from 0 to 200 s.")

        def actuators(_):
            return wrong("actuators", "sides exchanged.")

        return joint_answers(view, (heading_steps, frozen, actuators))[-1]

    assert not told(HEADING).unusable and "it rests on a channel that stands still" in told(HEADING).text
    assert told("north_m").unusable


def test_a_vessel_of_thrusters_may_turn_on_the_spot(sail):
    """Test: one voyage, asked with a ship file of rudder and shaft, and with one that has thrusters at its
    sides. Expected: too tight a turn for the first, nothing against the second."""
    tanker, columns = load("kvlcc2"), sail(900.0, 7.0, 1.2, 0.05)
    turns = Voyage("v", columns.pop("time_s"), columns)
    tug = replace(tanker, actuators=ship_of("thrusters").actuators)
    assert not ship_size(VoyageView(turns, tanker)).ok
    assert ship_size(VoyageView(turns, tug)).ok


@pytest.mark.parametrize("knots, fits", [(22.0, True), (40.0, False)])
def test_a_planing_boat_is_no_other_ship_for_going_as_fast_as_its_file_says(knots, fits):
    """Test: a boat of 12 m with a service speed of 20 knots in its ship file, which is a Froude number of 0.95.
    Expected: a voyage at 22 knots is its own; at 40 knots it may be another ship's."""
    boat = replace(ship_of("thrusters"), L_pp=12.0, U_0=10.3)
    t = np.arange(0.0, 600.0)
    ahead = np.full(t.size, 0.5144 * knots)
    straight = {"surge_velocity_mps": ahead, "sway_velocity_mps": 0.0 * t, "yaw_rate_degps": 0.0 * t}
    assert ship_size(VoyageView(Voyage("v", t, straight), boat)).ok == fits
