"""`twin-bench`: names, help, and one clear line when something is not there."""

import pytest

from bench.cli import BENCHES, main
from twin.errors import SettingsError


def test_without_a_name_it_is_the_budget(capsys):
    with pytest.raises(SystemExit) as end:
        main(["--steps", "x"])
    assert end.value.code == 2
    assert "twin-bench tick" in capsys.readouterr().err


def test_help_names_every_benchmark(capsys):
    with pytest.raises(SystemExit) as end:
        main(["--help"])
    assert end.value.code == 0
    said = capsys.readouterr().out
    assert all(name in said for name in BENCHES)


def test_an_unknown_benchmark_is_a_usage_error(capsys):
    with pytest.raises(SystemExit) as end:
        main(["papr"])
    assert end.value.code == 2
    assert "hidden-effects" in capsys.readouterr().err


def test_an_unknown_hull_is_one_line_that_names_the_known_ones(capsys):
    assert main(["sea", "--hull", "kvlcc3"]) == SettingsError.exit_code
    said = capsys.readouterr().err
    assert "kvlcc2" in said and said.count("\n") == 1


@pytest.mark.parametrize(
    "words",
    [["hidden-effects", "--seeds", "0"], ["stability", "--runs", "-5"], ["adaptation", "--seeds", "two"]],
)
def test_a_count_that_is_none_is_a_usage_error_and_no_hour_of_work(words, capsys):
    with pytest.raises(SystemExit) as end:
        main(words)
    assert end.value.code == 2
    assert f"{words[2]!r} is not a whole number of one or more" in capsys.readouterr().err


def test_a_page_that_could_not_be_written_is_said_before_the_work(tmp_path, capsys):
    assert main(["hidden-effects", "--out", str(tmp_path / "no" / "league.md")]) == 1
    assert (
        "league.md: cannot be written (there is no such folder). Choose another place with --out."
    ) in capsys.readouterr().err
