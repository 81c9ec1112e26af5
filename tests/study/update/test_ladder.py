"""`twin remove` and `twin history`: what was added can be taken out, and the ladder remembers both."""

import json

import pytest

from twin.physics.effects import find
from twin.physics.ship import load, save
from twin.study.update.addition import add
from twin.study.update.ladder import ladder, terminal_lines


@pytest.fixture
def better(sailed, make, kvlcc2, tmp_path):
    """A ship file with a current that was added to it."""
    current = find("Current").absent(kvlcc2).but(east=0.5)
    save(add(kvlcc2, [find("Current")], [sailed(make(current))]).ship, tmp_path / "better.toml")
    return tmp_path / "better.toml"


def test_the_ladder_shows_the_fall_and_where_it_was_judged(better):
    text = "\n".join(terminal_lines(load(better)))
    assert "+ Current" in text and "120 s" in text and "last third" in text


def test_remove_undoes_add_and_history_keeps_both_steps(verb, better, tmp_path, kvlcc2):
    out = tmp_path / "again.toml"
    assert verb("remove", "Current", "--ship", better, "-o", out) == 0
    again = load(out)
    assert (
        again.effects == ()
        and again.derivatives == kvlcc2.derivatives
        and "Current" not in again.notes.get("effects", {})
    )
    assert [sorted(set(s) & {"added", "removed"}) for s in ladder(again)] == [["added"], ["removed"]]


def test_an_effect_that_is_not_in_the_ship_is_exit_code_5(verb, better, tmp_path, capsys):
    assert verb("remove", "Curent", "--ship", better, "-o", tmp_path / "x.toml") == 5
    assert "Did you mean 'Current'?" in capsys.readouterr().err and not (tmp_path / "x.toml").exists()


def test_adding_twice_makes_a_ladder_of_two_steps(sailed, make, better):
    ship = load(better)
    fouled = make(*ship.effects, find("HullFouling").absent(ship).but(extra=0.5), seed=2)
    again = add(ship, [find("HullFouling")], [sailed(fouled)]).ship
    assert [s["added"] for s in ladder(again)] == [["Current"], ["HullFouling"]]
    assert [type(e).__name__ for e in again.effects] == ["Current", "HullFouling"]


def test_history_speaks_json(verb, better, capsys):
    assert verb("history", better, "--json", "-") == 0
    result = json.loads(capsys.readouterr().out)
    assert result["schema_version"] == 1 and result["effects"] == ["Current"] and len(result["history"]) == 1


def test_a_ship_without_history_says_so(kvlcc2):
    assert "nothing was added" in terminal_lines(kvlcc2)[0]
