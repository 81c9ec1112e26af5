"""The `next:` line of a diagnosis: what an owner can type or sail."""

import json
import shlex
from argparse import Namespace

import pytest

from twin.cli import main
from twin.commands.next_command import (
    after_compare,
    after_diagnose,
    after_import,
    after_instruments,
    after_map,
)
from twin.commands.story import MONDAY, SHIP
from twin.commands.typed_again import command_of
from twin.physics.ship import load, save


def asked(verdict, lasting=(), manoeuvre=None):
    """What a diagnosis holds of that."""
    sail = {"manoeuvre": manoeuvre} if manoeuvre else None
    return {
        "verdict": verdict,
        "answer": {"lasting": list(lasting)},
        "next_manoeuvre": sail,
        "calibrated": True,
        "calibrated_on": [],
    }


def instruments_of(voyages, ship, output, **more):
    """What was asked of `twin instruments`."""
    none = {"map": None, "source": [], "velocity_by": None}
    return Namespace(voyages=voyages, ship=ship, output=output, **(none | more))


@pytest.mark.parametrize("verdict", ["undecided", "unknown"])
@pytest.mark.parametrize("manoeuvre", [None, "zigzag 10/10"])
def test_a_voyage_that_cannot_tell_alone_is_asked_with_others(verdict, manoeuvre):
    """Expected: to ask it with another one, beside the manoeuvre, and not where three were asked already."""
    still_open = asked(verdict, manoeuvre=manoeuvre)
    said = after_diagnose(["a.mcap"], "ship.toml", still_open)
    assert "twin diagnose a.mcap OTHER-DAY.mcap --ship ship.toml: voyages together tell more" in said
    assert ("sail zigzag 10/10" in said) == (manoeuvre is not None)
    assert "OTHER-DAY" not in after_diagnose(["a.mcap", "b.mcap", "c.mcap"], "ship.toml", still_open)


def test_what_was_named_is_added_and_where_nothing_is_missing_the_next_voyage_is_asked():
    named = asked("missing", ["HullFouling"])
    assert after_diagnose(["a.mcap"], "s.toml", named).startswith("twin add HullFouling --ship s.toml")
    healthy = after_diagnose(["a.mcap"], "s.toml", asked("nothing_missing"))
    assert healthy.startswith("twin diagnose OTHER-DAY.mcap --ship s.toml") and "twin calibrate" in healthy
    reference = asked("nothing_missing") | {"calibrated_on": ["a"]}
    assert "calibrate" not in after_diagnose(["a.mcap"], "s.toml", reference)


def test_every_next_command_takes_a_file_name_as_one_word_whatever_stands_in_it():
    """Test: names with a space and with what a shell would run. Expected: a shell reads back the names."""
    ship, voyage = "MV Alma.toml", "monday $(reboot).mcap"
    for verdict, lasting in (("missing", ["HullFouling"]), ("moments", ())):
        assert {voyage, ship} <= set(shlex.split(after_diagnose([voyage], ship, asked(verdict, lasting))))
    args = Namespace(typed=["add", "Wind", "--ship", ship, "--voyage", voyage, "-o", "b.toml"])
    asking = instruments_of([voyage], ship, None)
    of_sensors = {"horizons": [{"noise_floor": {"of": "sensors"}}]}
    for said in (
        after_compare([voyage], ship, of_sensors),
        after_instruments(asking, True, True),
        after_instruments(asking, True, False),
        after_instruments(asking, False, False),
        command_of(args),
    ):
        assert {voyage, ship} <= set(shlex.split(said))
    assert voyage in shlex.split(after_import(voyage, None))
    assert {voyage, ship} <= set(shlex.split(after_map([voyage], ship)))


def test_a_ship_that_was_never_calibrated_is_calibrated_first(tmp_path):
    save(load("kvlcc2"), tmp_path / "ship.toml")
    first = asked("unknown") | {"calibrated": False}
    assert "twin calibrate ref-1.mcap" in after_diagnose(["a.mcap"], str(tmp_path / "ship.toml"), first)


@pytest.mark.parametrize("ship, output", [("s.toml", "b.toml"), ("s.toml", None), (None, "map.toml")])
def test_after_a_fault_that_is_not_told_from_another_no_file_is_named_that_was_not_written(ship, output):
    """Expected: the same voyage with one of another day, and a ship file to be written; once a fault is told, a
    comparison with the file that has it, where one was written."""
    asking = instruments_of(["a.mcap"], ship, output)
    to = f"--ship {ship or 'SHIP.toml'} -o {(ship and output) or 'corrected.toml'}"
    assert after_instruments(asking, True, False) == f"twin instruments a.mcap OTHER-DAY.mcap {to}"
    written = ship and output
    compared, corrected = "twin compare a.mcap --ship b.toml", f"twin instruments a.mcap {to}"
    assert after_instruments(asking, True, True) == (compared if written else corrected)


def test_the_command_of_a_result_is_what_was_typed_less_where_the_answer_goes(tmp_path):
    typed = ["diagnose", "a.mcap", "--ship", "s.toml", "--reference", "b c.mcap", "--identifiability"]
    for more in (["--json", "-"], ["--json=x.json", "--report", "r.html"], ["--rep", "r.html"]):
        assert command_of(Namespace(typed=[*typed, *more])) == shlex.join(["twin", *typed])
        assert command_of(Namespace(typed=[typed[0], *more, *typed[1:]])) == shlex.join(["twin", *typed])


def test_the_command_in_an_answer_gives_that_answer(tmp_path):
    words = ["compare", str(MONDAY), "--ship", str(SHIP), "--horizon", "30"]
    assert main([*words, "--json", str(tmp_path / "a.json")]) == 0
    answer = json.loads((tmp_path / "a.json").read_text())
    assert shlex.split(answer["command"]) == ["twin", *words]


def test_the_next_command_repeats_what_the_answer_rests_on():
    """Expected: the reference voyages of a diagnosis; the map, the instruments and the frame of a check of
    instruments."""
    for verdict in ("undecided", "nothing_missing"):
        said = after_diagnose(["a.mcap"], "s.toml", asked(verdict), "ref 1.mcap", "ref-2.mcap")
        assert "--ship s.toml --reference 'ref 1.mcap' ref-2.mcap" in said
    more = {"map": "m.toml", "source": ["gnss", "heading=gyro"], "velocity_by": "course"}
    said = after_instruments(instruments_of(["a.csv"], "s.toml", None, **more), True, False)
    assert "--map m.toml --source gnss --source heading=gyro --velocity-by course" in said
