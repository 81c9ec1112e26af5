"""What reference voyages establish of the instruments of a ship of kinematics alone: what each of them shows,
and nothing that only one does."""

from types import SimpleNamespace

import numpy as np
import pytest

import twin
from tests.study.instruments.test_instruments import EVERY, HEADING, KEPT, late, voyage
from tests.thorough import thorough
from twin.physics.effects.sensor_delay import SensorDelay
from twin.physics.ship import load
from twin.study.calibration.own_instruments import established, own_instruments
from twin.study.instruments.corrections import with_numbers
from twin.study.instruments.instrument_estimate import estimate
from twin.study.instruments.instrument_samples import of_voyage
from twin.study.instruments.on_references import (
    KinematicOfVoyage,
    KinematicRecord,
    KinematicUsual,
    on_references,
)

U, V = "surge_velocity_mps", "sway_velocity_mps"


@pytest.fixture(scope="module")
def days(sail):
    """Columns of three reference voyages, twelve minutes of zigzags each, twice a second; nobody writes into
    them."""
    return [{name: sail(720.0, seed=seed)[name][::EVERY] for name in KEPT} for seed in (3, 4, 5)]


@pytest.fixture(scope="module")
def three_seconds(days):
    """What the tanker's references establish with a receiver that smooths over three seconds."""
    return own_instruments([sailed(smoothed(d, 3.0)) for d in days], load("kvlcc2"))


def smoothed(columns, time_s):
    """Course and speed over ground with a first-order lag of this time constant, turned by the compass."""
    psi = np.radians(columns[HEADING])
    earth = (columns[U] + 1j * columns[V]) * np.exp(1j * psi)
    share = 1.0 - np.exp(-np.median(np.diff(columns["time_s"])) / time_s)
    out = earth.copy()
    for k in range(1, out.size):
        out[k] = out[k - 1] + share * (earth[k] - out[k - 1])
    out *= np.exp(-1j * psi)
    return columns | {U: out.real, V: out.imag}


def slow_compass(columns, time_s):
    """A heading that comes so late, and the velocity over ground turned by it."""
    shown = late(columns, HEADING, time_s)
    earth = (columns[U] + 1j * columns[V]) * np.exp(1j * np.radians(columns[HEADING] - shown[HEADING]))
    return shown | {U: earth.real, V: earth.imag}


def asked(*columns, frames=("course", "course", "course")):
    return on_references([of_voyage(voyage(*v)) for v in zip(columns, frames, strict=False)], 100.0)


def sailed(columns):
    """A voyage as a calibration has it, of which all is used."""
    made = voyage(columns, "course")
    return SimpleNamespace(voyage=made, track=SimpleNamespace(name=made.name, t=made.time_s - made.time_s[0]))


def noting(entry):
    """A ship whose file keeps this of its instruments."""
    return SimpleNamespace(name="a tanker", notes={"instruments": entry})


def test_a_receiver_that_smooths_on_every_reference_belongs_to_the_ship(three_seconds):
    found = three_seconds
    effects = {type(e).__name__: e for e in found.ship.effects}
    assert set(found.written) == {"ReceiverSmoothing"} and set(effects) >= {"ReceiverSmoothing"}
    assert effects["ReceiverSmoothing"].time == pytest.approx(3.0, abs=0.3)
    kept = KinematicRecord.of_ship(found.ship)
    assert kept == found.record
    assert all(v.value == pytest.approx(3.0, abs=0.3) for v in kept.numbers["smoothing"].voyages)
    assert found.ship.notes["effects"]["ReceiverSmoothing"]["time"]["sd"] > 0.0


def test_a_healthy_receiver_gives_the_ship_no_effect(days):
    ship = load("kvlcc2")
    found = own_instruments([sailed(d) for d in days], ship)
    assert found.written == {} and found.ship.effects == ship.effects
    assert "smoothing" not in found.record.faults and len(found.record.numbers["smoothing"].voyages) == 3


@thorough
def test_what_the_references_show_no_more_of_than_sound_instruments_from_day_to_day_is_not_the_ships(days):
    """Test: on each reference a compass late by less than sound compasses seem to be on a voyage. Expected: its
    age is kept, far clear of none by its scatter between these voyages alone; no effect of the ship's, and
    `instruments` of the same voyages sees none."""
    ship, slow = load("kvlcc2"), [slow_compass(d, 0.3) for d in days]
    found = own_instruments([sailed(d) for d in slow], ship)
    age = found.record.numbers["heading_delay"]
    assert "heading_delay" in found.record.faults and age.value > 8.0 * age.next_sd
    assert found.written == {} and found.ship.effects == ship.effects
    assert "heading_delay" not in twin.instruments(ship, [voyage(d, "course") for d in slow]).faults


@thorough
def test_what_only_one_reference_shows_is_not_the_ships(days):
    found = asked(smoothed(days[0], 3.0), *days[1:])
    assert found.record.numbers["smoothing"].between > 0.5
    assert established(found) == []


@pytest.mark.parametrize("voyages", [1, 2])
def test_fewer_than_three_references_establish_nothing(days, voyages):
    found = asked(*(smoothed(d, 3.0) for d in days[:voyages]))
    assert "smoothing" in found.record.faults and established(found) == []


@thorough
def test_what_the_ship_file_has_already_is_refined_and_never_there_twice(days, three_seconds):
    again = own_instruments([sailed(smoothed(d, 2.0)) for d in days], three_seconds.ship).ship
    (only,) = (e for e in again.effects if type(e).__name__ == "ReceiverSmoothing")
    assert only.time == pytest.approx(2.0, abs=0.3)


@thorough
def test_a_slow_compass_on_every_reference_belongs_to_the_ship(days):
    found = own_instruments([sailed(late(d, HEADING, 2.0)) for d in days], load("kvlcc2"))
    (lag,) = (e for e in found.ship.effects if type(e).__name__ == "HeadingLag")
    assert lag.lag == pytest.approx(2.0, abs=0.3) and lag.turned == lag.lag


def test_a_late_receiver_turns_its_velocity_by_todays_compass_or_by_its_own():
    told = {"gnss_delay": (0.5, 0.1)}
    for own, turned in ((False, 0.5), (True, 0.0)):
        ship = with_numbers(load("kvlcc2"), told, own, ["calm"])
        assert SensorDelay(delay=0.5, turned=turned) in ship.effects


def test_the_distance_of_each_reference_is_from_what_the_others_foretell():
    usual = KinematicUsual(
        1.0,
        0.1,
        0.0,
        tuple(KinematicOfVoyage(n, x, 0.1, 0.0) for n, x in zip("abc", (1.0, 1.0, 1.5), strict=True)),
    )
    assert usual.distances[2] == pytest.approx(0.5 / np.sqrt(0.1**2 + 0.1**2 / 2))
    assert usual.distances[0] == pytest.approx(0.25 / np.sqrt(0.1**2 + 0.1**2 / 2))


@pytest.mark.parametrize("seconds, clock", [(0.0, "heading_delay"), (2.0, "rate_delay")])
def test_the_clock_of_the_references_holds_until_another_instrument_is_clearly_earlier(days, seconds, clock):
    """Test: position, heading and rate of turn alone; ages counted from the heading, as on the references.
    Expected: where the heading is now late, from the rate of turn: from the heading it would be early, which
    nothing is, and the late heading would show nowhere."""
    columns = {n: x for n, x in late(days[0], HEADING, seconds).items() if n not in (U, V)}
    found = estimate([of_voyage(voyage(columns))], 100.0, clock="heading_delay")
    assert found.clock == clock
    if seconds:
        assert found.of("heading_delay").value == pytest.approx(seconds, abs=0.1)
        assert "heading_delay" in found.faults


def test_counted_from_the_other_instrument_an_age_is_what_the_first_was_earlier_by():
    told = tuple(KinematicOfVoyage(n, x, 0.1, 0.0) for n, x in zip("ab", (0.2, 0.4), strict=True))
    usual = KinematicUsual(0.3, 0.1, 0.05, told)
    before = KinematicRecord(
        "heading_delay", (), False, {"rate_delay": usual, "log_delay": usual, "A": usual}
    )
    after = before.counted_from("rate_delay")
    assert after.clock == "rate_delay" and set(after.numbers) == {"heading_delay", "A"}
    assert (
        after.numbers["heading_delay"].value == -0.3
        and after.numbers["heading_delay"].next_sd == usual.next_sd
    )
    assert [v.value for v in after.numbers["heading_delay"].voyages] == [-0.2, -0.4]
    assert after.numbers["A"] == usual and before.counted_from("heading_delay") is before
    assert before.counted_from("gnss_delay") is before  # of it the references told nothing


@thorough
@pytest.mark.parametrize(
    ("frames", "velocity_by"),
    [(("course",) * 3, "compass"), (("body",) * 3, "receiver"), (("course", "body", "course"), "")],
)
def test_the_record_says_what_turned_the_velocity_where_all_references_agree(days, frames, velocity_by):
    record = asked(*days, frames=frames).record
    assert record.velocity_by == velocity_by
    assert KinematicRecord.of_ship(noting(record.entry())) == record


@thorough
def test_a_record_from_before_says_nothing_of_it(days):
    entry = asked(*days).record.entry()
    before = KinematicRecord.of_ship(noting({k: v for k, v in entry.items() if k != "velocity_by"}))
    assert before.velocity_by == ""
