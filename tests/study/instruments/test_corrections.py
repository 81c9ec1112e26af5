"""What was found of the instruments, as a ship file can hold it."""

from types import SimpleNamespace

import pytest

from twin.api.instruments import InstrumentCheck
from twin.errors import SettingsError
from twin.physics.ship import load
from twin.study.instruments.corrections import as_map, corrected
from twin.study.instruments.unknowns import INDEX, UNKNOWNS


def found_of(instead=None, **numbers):
    """Faults that were seen with these numbers, whose standard deviation is a tenth; `instead`: fault -> what may
    be in its place."""
    unknowns = {name: UNKNOWNS[INDEX[name]] for name in numbers}
    instead = instead or {}
    return SimpleNamespace(
        estimates=[
            SimpleNamespace(unknown=unknowns[name], value=value, sd=0.1 * abs(value), seen=True)
            for name, value in numbers.items()
        ],
        faults=tuple(u.fault for u in unknowns.values()),
        instead={u.fault: instead.get(u.fault, ()) for u in unknowns.values()},
        distinct=tuple(u.fault for u in unknowns.values() if u.fault not in instead),
        own=(False,),
        readings=(SimpleNamespace(name="zigzag"),),
    )


def test_a_number_that_no_ship_can_have_is_left_out_and_the_others_are_written():
    """Test: a log 8 % too high, and an antenna 400 m under the keel, as a roll column with the other sign makes it.
    Expected: the log's scale is written with its source, and what was left out is told."""
    ship, left = corrected(load("kvlcc2"), found_of(antenna_above=-400.0, log_scale=0.08))
    (effect,) = (e for e in ship.effects if type(e).__name__ == "SpeedLogScale")
    assert effect.scale == 0.08 and ship.notes["effects"]["SpeedLogScale"]["scale"]["sd"] == 0.008
    assert [e.unknown.name for e in left] == ["antenna_above"]
    assert not any(type(e).__name__ == "AntennaOffset" for e in ship.effects)


def test_an_age_that_no_effect_holds_is_told_as_left_out():
    ship, left = corrected(load("kvlcc2"), found_of(log_delay=1.5))
    assert ship.effects == load("kvlcc2").effects and [e.unknown.name for e in left] == ["log_delay"]


def test_where_no_effect_holds_what_was_seen_there_is_nothing_to_write_and_it_is_said():
    data = {"faults": [{"fault": "log_delay", "or_instead": []}]}
    found = InstrumentCheck(found_of(log_delay=1.5), data=data)
    why = "no effect holds age of the speed through water (1.50 s)"
    assert found.not_written(load("kvlcc2")) == why and found.not_written(None) == ""


@pytest.mark.parametrize("value, kept", [(0.085, True), (0.103, True), (0.11, False)])
def test_what_the_ship_file_has_within_its_own_doubt_and_the_voyages_stays_for_it_may_rest_on_more(
    value, kept
):
    ship, _ = corrected(load("kvlcc2"), found_of(log_scale=0.08))
    again, left = corrected(ship, found_of(log_scale=value))
    (effect,) = (e for e in again.effects if type(e).__name__ == "SpeedLogScale")
    assert effect.scale == (0.08 if kept else value) and not left


UNTOLD = {"log_angle": ("heading_bias",), "log_bias": ("log_scale",)}


def test_a_fault_that_the_voyages_do_not_tell_from_another_is_not_written_into_the_ship_file():
    """Test: a log askew, or in its place a compass that is off; a gyro that surely is. Expected: the gyro alone,
    and the log is not among what no effect could hold."""
    ship, left = corrected(load("kvlcc2"), found_of(UNTOLD, log_angle=-0.08, gyro_bias=0.001))
    added = {type(e).__name__ for e in ship.effects} - {type(e).__name__ for e in load("kvlcc2").effects}
    assert added == {"GyroBias"} and left == []


def test_a_fault_that_the_voyages_do_not_tell_from_another_is_not_taken_off_by_a_map():
    lines = as_map(found_of(UNTOLD, log_bias=0.5, gyro_bias=0.001))
    assert "yaw_rate_degps" in lines and "log" not in lines.split("[columns]")[1]
    with pytest.raises(SettingsError, match="nothing was found that a map can take off"):
        as_map(found_of(UNTOLD, log_bias=0.5))
