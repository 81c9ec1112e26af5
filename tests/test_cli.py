"""`twin`: whatever is wrong, one line that says what to do, and the exit code that means it."""

import os
import subprocess
import sys

import pytest

from twin import cli
from twin.errors import DataError


def said(capsys):
    lines = capsys.readouterr().err.strip().splitlines()
    assert len(lines) == 1, lines
    return lines[0]


@pytest.mark.parametrize("package, extra", [("scipy", "shiptwin[study]"), ("torch", "shiptwin[train]")])
def test_a_package_that_is_not_installed_is_named_with_the_extra_that_brings_it(
    package, extra, monkeypatch, capsys
):
    verb = cli.Verb(package, "needs it", "twin needy")
    monkeypatch.setitem(cli.VERBS, "needy", verb)
    monkeypatch.setitem(sys.modules, package, None)
    assert cli.main(["needy"]) == 1
    assert extra in said(capsys)


def test_a_verb_that_an_installation_lacks_is_named(monkeypatch, capsys):
    monkeypatch.setitem(cli.VERBS, "needy", cli.Verb("twin.study.nowhere", "is not there", "twin needy"))
    assert cli.main(["needy"]) == 1
    assert "twin.study.nowhere" in said(capsys)


def test_a_bug_is_not_taken_for_a_package_that_is_missing(monkeypatch, tmp_path):
    """Expected: a module that imports what does not exist says so with its traceback."""
    (tmp_path / "buggy_verb.py").write_text("import no_such_thing_at_all")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setitem(cli.VERBS, "needy", cli.Verb("buggy_verb", "has a bug", "twin needy"))
    with pytest.raises(ModuleNotFoundError):
        cli.main(["needy"])


def test_an_unknown_verb_is_a_usage_error():
    with pytest.raises(SystemExit) as end:
        cli.main(["repaly"])
    assert end.value.code == 2


@pytest.mark.parametrize("verb", [["import", "-o", "out.mcap"], ["replay"], ["compare", "--ship", "usv"]])
def test_a_folder_or_nothing_where_a_file_should_be_is_one_line(verb, tmp_path, capsys, monkeypatch):
    """Expected: after words on progress one line with the path, exit code 4, and nothing written."""
    monkeypatch.chdir(tmp_path)
    for path in (tmp_path, tmp_path / "none.csv"):
        assert cli.main([verb[0], str(path), *verb[1:]]) == DataError.exit_code
        *progress, complaint = capsys.readouterr().err.strip().splitlines()
        assert str(path) in complaint and complaint.startswith("DataError") and len(progress) <= 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("wish, threads", [(None, 1), ("2", 2)])
def test_matrices_are_not_shared_between_threads_unless_the_owner_wishes(wish, threads):
    """A diagnosis beside other work took 47 s of two cores' time with threads and 13 s without."""
    code = (
        "from twin import cli; cli.main(['effects', 'Wind']); import os; "
        "print(os.environ['OPENBLAS_NUM_THREADS'])"
    )
    env = {k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"} | (
        {"OPENBLAS_NUM_THREADS": wish} if wish else {}
    )
    told = subprocess.run(
        [sys.executable, "-c", code], env=env, capture_output=True, text=True, check=True
    ).stdout
    assert told.splitlines()[-1] == str(threads)


@pytest.mark.parametrize("words", [["-o", "no/x.toml"], ["-o", "."], ["-o", "x.toml", "--json", "no/x.json"]])
def test_what_cannot_be_written_is_said_before_the_work_is_done(words, tmp_path, monkeypatch, capsys):
    """Test: the voyage is not there either. Expected: the place of the answer is asked about first."""
    monkeypatch.chdir(tmp_path)
    assert cli.main(["calibrate", "nowhere.mcap", "--ship", "kvlcc2", *words]) == 1
    assert f"Choose another place with {words[-2]}." in said(capsys)
