"""Faults planted one at a time: each kind is made, a test that looks notices, one that does not lets it live."""

import json

from bench.mutants import run
from bench.mutants.guarded import GUARDED, PARTS, Guarded
from bench.mutants.mutate import mutants
from bench.mutants.reach import Reached, reached, reaching
from tests.thorough import thorough

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
        assert all(run.python_files(test) and (run.ROOT / test).exists() for test in guarded.tests)


@thorough
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
        assert sorted(json.loads(kept.read_text())["fates"].values()) == sorted(fates)
        monkeypatch.setattr(run, "tried", None)
        assert run.of_file("lagging", 3, tmp_path, float("inf")) == rows
        monkeypatch.undo()
        kept.unlink()


def test_what_a_test_has_noticed_stays_noticed_and_the_rest_is_shown_to_new_tests(tmp_path, monkeypatch):
    """Test: three faults on file, one of them noticed; then a test more. Expected: only the other two are tried."""
    (tmp_path / "test_one.py").write_text("def test_it(): pass\n")
    monkeypatch.setitem(
        run.GUARDED, "lagging", Guarded("twin/live/lagging.py", (str(tmp_path / "test_one.py"),))
    )
    shown = []
    monkeypatch.setattr(run, "tried", lambda path, source, tests, limit_s: shown.append(1) or run.SURVIVED)
    run.of_file("lagging", 3, tmp_path, float("inf"))
    assert len(shown) == 1 + 3
    kept = next(tmp_path.glob("lagging-*.json"))
    table = json.loads(kept.read_text())
    table["fates"][next(iter(table["fates"]))] = run.KILLED
    kept.write_text(json.dumps(table))
    (tmp_path / "test_one.py").write_text("def test_it(): assert True\n")
    rows = run.of_file("lagging", 3, tmp_path, float("inf"))
    assert len(shown) == 4 + 1 + 2 and [row.fate for row in rows].count(run.KILLED) == 1


def test_a_draw_is_the_same_each_time_and_of_all_files_together():
    names = ["lagging", "clock"]
    drawn = run.drawn_of(names, 30)
    assert drawn == run.drawn_of(names, 30) and sum(map(len, drawn.values())) == 30
    assert all(numbers == sorted(set(numbers)) and numbers for numbers in drawn.values())


def test_a_fault_is_shown_to_the_tests_that_reach_its_line_then_its_function_the_quickest_first():
    source = "A = 1\n\ndef f():\n    x = 1\n    return x\n\ndef g():\n    return 2\n"
    found = [
        Reached("t::slow", 9.0, {"f.py": [4, 5]}),
        Reached("t::quick", 1.0, {"f.py": [4, 5]}),
        Reached("t::half", 0.5, {"f.py": [4]}),
        Reached("t::other", 0.1, {"f.py": [8]}),
        Reached("t::elsewhere", 0.1, {"g.py": [5]}),
    ]
    assert reaching(found, "f.py", source, 5, 100.0) == ["t::quick", "t::slow", "t::half"]
    assert reaching(found, "f.py", source, 5, 9.9) == ["t::quick", "t::half"]
    assert reaching(found, "f.py", source, 5, 0.0) == ["t::quick"]
    assert reaching(found, "f.py", source, 8, 100.0) == ["t::other"]
    assert reaching(found, "f.py", source, 1, 100.0) == ["t::other", "t::half", "t::quick", "t::slow"]


def test_the_lines_that_a_test_reaches_are_watched_in_threads_too_and_kept(tmp_path):
    (tmp_path / "watched.py").write_text("def f():\n    return 1\n\ndef g():\n    return 2\n")
    (tmp_path / "test_it.py").write_text(
        "from threading import Thread\nimport watched\n"
        "def test_f(): assert watched.f() == 1\n"
        "def test_g():\n    t = Thread(target=watched.g)\n    t.start()\n    t.join()\n"
        "def test_fails(): assert watched.f() == 2\n"
        "def test_nothing(): pass\n"
    )
    kept = tmp_path / "kept.json"
    found = reached(tmp_path, ["watched.py"], ["test_it.py"], kept)
    assert [(test.test, test.lines) for test in found] == [
        ("test_it.py::test_f", {"watched.py": [1, 2]}),
        ("test_it.py::test_g", {"watched.py": [4, 5]}),
    ]
    assert reached(tmp_path, [], [], kept) == found


def test_shares_are_by_part_and_of_all():
    rows = [
        run.TriedMutant("twin/live/guard.py", 1, "", fate) for fate in (run.KILLED, run.HUNG, run.SURVIVED)
    ]
    rows.append(run.TriedMutant("twin/live/clock.py", 1, "", run.KILLED))
    shares = run.shares(rows)
    assert list(shares)[-1] == "all" and {part: (s.k, s.n) for part, s in shares.items()} == {
        "guard": (2, 3), "others": (1, 1), "all": (3, 4),
    }  # fmt: skip
    assert "| guard | 3 | 2 of 3, 67% (" in run.page(rows)
    assert set(PARTS) == {guarded.part for guarded in GUARDED.values()} - {""}
