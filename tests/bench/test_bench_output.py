"""What a benchmark answers with: a page, JSON, and one clear line when neither can be written."""

import argparse
import json

import pytest

from bench import bench_output
from twin.errors import TwinError


def parsed(*typed, option="--out"):
    parser = argparse.ArgumentParser()
    bench_output.add_arguments(parser, option)
    return parser.parse_args(typed)


def test_standard_output_is_left_to_the_json_that_was_asked_for_there(capsys):
    bench_output.give(parsed("--json", "-"), {"a": 1}, "# Page")
    said = capsys.readouterr()
    assert json.loads(said.out) == {"a": 1} and said.err == "# Page\n"


def test_the_page_that_is_written_may_hold_more_than_is_printed(tmp_path, capsys):
    bench_output.give(parsed("--out", f"{tmp_path / 'a.md'}"), {}, "# Page\n", "\npictures\n")
    assert (tmp_path / "a.md").read_text() == "# Page\n\npictures\n" and capsys.readouterr().out == "# Page\n"


def test_a_page_that_cannot_be_written_names_its_option(tmp_path):
    with pytest.raises(TwinError, match="--results"):
        bench_output.give(
            parsed("--results", f"{tmp_path / 'none' / 'a.md'}", option="--results"), {}, "# Page"
        )


def test_what_a_page_says_by_hand_stays_when_it_is_made_again(tmp_path):
    page = tmp_path / "a.md"
    page.write_text("# Old\n\n## What it says\n\nIn words.\n")
    assert bench_output.kept(page) == "\n## What it says\n\nIn words.\n"
    assert bench_output.kept(tmp_path / "none.md") == bench_output.kept(None) == ""
