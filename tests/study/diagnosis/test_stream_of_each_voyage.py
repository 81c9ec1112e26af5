"""Voyages that are asked together were sailed on days of their own: each has its own stream."""

import numpy as np
import pytest

from tests.thorough import thorough
from twin.errors import DataError
from twin.physics.effects.current import Current
from twin.physics.effects.rudder_offset import RudderOffset
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.effect_diagnosis import diagnose

DAYS = ((0.5, -0.2), (-0.4, 0.3))  # [m/s] to north and east


@pytest.fixture(scope="module")
def sailed(make):
    """Two voyages of one file name on days of these streams, beside what else is wrong."""

    def both(*effects):
        days = (Current(north=north, east=east) for north, east in DAYS)
        return [make(day, *effects, seed=i, seconds=900.0) for i, day in enumerate(days)]

    return both


@thorough
def test_a_healthy_ship_on_two_days_lacks_nothing_but_each_days_stream(sailed, kvlcc2):
    said = diagnose(sailed(), kvlcc2).result
    assert (said["verdict"], said["missing"]) == ("missing", ["Current"])
    numbers = {p["name"]: p for p in said["candidates"][0]["parameters"]}
    for i, day in enumerate(DAYS, start=1):
        for axis, true in zip(("north", "east"), day, strict=True):
            told = numbers[f"{axis} of made ({i})"]
            assert told["low95"] < true < told["high95"] and told["high95"] - told["low95"] < 0.3
    assert said["path"]["error_without"] < 1.5 * said["path"]["error_floor"]


@thorough
def test_what_is_wrong_with_the_ship_is_one_number_on_both_days(sailed, kvlcc2):
    said = diagnose(sailed(RudderOffset(offset=0.05)), kvlcc2).result
    assert "RudderOffset" in said["missing"]
    (offset,) = next(c for c in said["candidates"] if c["effect"] == "RudderOffset")["parameters"]
    assert offset["name"] == "offset" and offset["low95"] < 0.05 < offset["high95"]


def test_a_days_stream_moves_nothing_on_another_day(sailed, kvlcc2):
    case = assemble(sailed(), kvlcc2)
    own = {u.label: i for i, u in enumerate(case.effects) if u.owner == "Current"}
    assert list(own) == [f"Current.{axis} of made ({i})" for i in (1, 2) for axis in ("north", "east")]
    column = {u.label: i for i, u in enumerate(case.unknowns)}
    for label in own:
        acts = [bool(np.abs(line.R[:, :, column[label]]).max() > 0.0) for line in case.lines]
        assert acts == [label.endswith("(1)"), label.endswith("(2)")]
    first = case.at([own["Current.north of made (1)"]], np.full(len(case.effects), 0.5), case.tracks[0])
    other = case.at([own["Current.north of made (1)"]], np.full(len(case.effects), 0.5), case.tracks[1])
    assert any(type(e) is Current for e in first.effects) and not any(
        type(e) is Current for e in other.effects
    )


def test_a_voyage_by_itself_keeps_the_plain_names(sailed, kvlcc2):
    case = assemble(sailed()[:1], kvlcc2)
    assert [u.label for u in case.effects if u.owner == "Current"] == ["Current.north", "Current.east"]


def test_a_voyage_that_is_given_twice_is_refused(sailed, kvlcc2):
    first = sailed()[0]
    copied = first.with_rows(first.time_s.copy(), {k: x.copy() for k, x in first.columns.items()})
    with pytest.raises(DataError, match="Give each voyage once"):
        assemble([first, copied], kvlcc2)


def test_a_reference_voyage_that_is_asked_about_or_given_twice_is_refused(
    sailed, kvlcc2, on_disk, verb, capsys
):
    """Its fault would be in what is known as healthy. By Python as by the command, in one line."""
    first, other = sailed()[:2]
    says = "reference voyage made: is the same voyage as made. Give each voyage once."
    with pytest.raises(DataError, match=says):
        assemble([first], kvlcc2, [other, first])
    with pytest.raises(DataError, match=says.replace("as made", "as reference voyage made")):
        assemble([first], kvlcc2, [other, other])
    path = on_disk(first)
    assert verb("diagnose", path, "--ship", "kvlcc2", "--reference", path) == 4
    (line,) = [x for x in capsys.readouterr().err.splitlines() if "same voyage" in x]
    assert says in line
