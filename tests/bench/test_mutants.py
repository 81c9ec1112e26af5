"""Faults planted one at a time: each kind is made, a test that looks notices, one that does not lets it live."""

import json

from bench.mutants import run
from bench.mutants.guarded import GUARDED, Guarded
from bench.mutants.mutate import mutants

SOURCE = '''
LIMIT = 4

def guarded(x, seen):
    """A docstring is no statement."""
    if x < LIMIT and not seen:
        seen.append(max(x, 0))
        return True
    return x is None
'''


def test_each_kind_of_fault_is_made_once_and_alone():
    made = {mutant.change for mutant in mutants(SOURCE)}
    assert {
        "4 -> 8",
        "x < LIMIT -> x <= LIMIT",
        "x < LIMIT -> x >= LIMIT",
        "x < LIMIT and (not seen) -> x < LIMIT or not seen",
        "not seen -> seen",
        "seen.append(max(x, 0)) -> (left out)",
        "max(x, 0) -> min(x, 0)",
        "0 -> 1",
        "True -> False",
        "x is None -> x is not None",
    } == made
    sources = [mutant.source for mutant in mutants(SOURCE)]
    assert len(set(sources)) == len(sources)


def test_a_mutant_is_python_and_says_its_line():
    lines = SOURCE.splitlines()
    for mutant in mutants(SOURCE):
        compile(mutant.source, "mutant", "exec")
        before = mutant.change.partition(" -> ")[0].replace("(not seen)", "not seen")
        assert before in lines[mutant.line - 1]


def test_every_file_that_guards_and_every_test_of_it_is_there():
    for guarded in GUARDED.values():
        assert (run.ROOT / guarded.source).is_file()
        assert all((run.ROOT / test).is_file() for test in guarded.tests)


def test_a_fault_is_noticed_by_a_test_that_looks_and_survives_one_that_does_not(tmp_path, monkeypatch):
    """Test: the text of lagging with its limit turned, under a test of it and under one of the clock; and a
    second run. Expected: noticed, not noticed; the second run tries nothing again."""
    (tmp_path / "test_looks.py").write_text(
        "from twin.live.lagging import Lagging\n"
        "def test_it():\n"
        "    look = Lagging(10.0).look\n"
        "    assert look(0.0, 0) == '' and 'lagging' in look(1.0, 3) and look(90.0, 3) == ''\n"
    )
    (tmp_path / "test_does_not.py").write_text("import twin.live.lagging\ndef test_it(): pass\n")
    for test, noticed in (("test_looks.py", True), ("test_does_not.py", False)):
        guarded = Guarded("twin/live/lagging.py", (str(tmp_path / test),))
        monkeypatch.setitem(run.GUARDED, "lagging", guarded)
        rows = run.of_file("lagging", 3, tmp_path, float("inf"))
        fates = [row.fate for row in rows]
        assert len(rows) == 3 and (run.KILLED in fates) is noticed
        kept = next(tmp_path.glob("lagging-*.json"))
        assert sorted(json.loads(kept.read_text()).values()) == sorted(fates)
        monkeypatch.setattr(run, "tried", None)
        assert run.of_file("lagging", 3, tmp_path, float("inf")) == rows
        monkeypatch.undo()
        kept.unlink()
