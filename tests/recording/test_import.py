"""`twin import` end to end: good files go in, wrong ones are refused with what to do."""

import argparse
import json

import numpy as np
import pytest

from tests import command_lines
from twin.cli import main
from twin.commands import import_ as verb
from twin.errors import DataError, SettingsError, UsageError
from twin.recording.import_voyage import how_often, import_voyage
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage


def run(*words):
    parser = argparse.ArgumentParser()
    verb.add_arguments(parser)
    return verb.run(parser.parse_args([str(w) for w in words]))


def test_a_check_that_cannot_tell_is_not_marked_ok(sail, write_csv, tmp_path, capsys):
    columns = {name: values for name, values in sail().items() if "wind" not in name}
    assert run(write_csv(columns), "--every-check", "-o", tmp_path / "v.mcap") == 0
    said = [line.split() for line in capsys.readouterr().out.splitlines()]
    marks = {words[1].rstrip(":"): words[0] for words in said if words and words[0] in ("ok", "?", "look")}
    assert marks["wind"] == "?" and marks["time_stamps"] == "ok"


def test_the_reference_voyage_of_a_new_ship_is_for_her_calibration(sail, write_csv, tmp_path, capsys):
    ship, out = tmp_path / "alma.toml", tmp_path / "v.mcap"
    assert main(command_lines.init("MV Alma", "-o", ship)) == 0
    assert (
        run(
            write_csv(sail()),
            "--ship",
            ship,
            "--accept",
            "propeller_rate",
            "--accept",
            "ship_size",
            "-o",
            out,
        )
        == 0
    )
    said = capsys.readouterr().out
    assert (
        f"twin calibrate ref-1.mcap ref-2.mcap ... --ship {ship}"
    ) in said and "twin diagnose LATER.mcap" in said


def test_a_good_file_goes_in_and_the_next_command_is_named(sail, write_csv, tmp_path, capsys):
    out, page = tmp_path / "v.mcap", tmp_path / "v.json"
    assert run(write_csv(sail()), "-o", out, "--json", page) == 0
    said = capsys.readouterr().out
    assert f"next: twin compare {out} --ship SHIP.toml" in said and "WRONG" not in said
    result = json.loads(page.read_text())
    assert result["schema_version"] == 1 and result["rows"] == 9000 and result["output"] == str(out)
    assert all({"check", "ok", "text"} <= set(c) and c["ok"] for c in result["data_checks"])
    assert "water_depth_m" in result["absent"] and "north_m" in result["columns"]
    np.testing.assert_allclose(read_voyage(out)["north_m"][5000], sail()["north_m"][5000])


def test_json_on_standard_output_stands_alone(sail, write_csv, tmp_path, capsys):
    run(write_csv(sail(120.0)), "-o", tmp_path / "v.mcap", "--json", "-")
    assert json.loads(capsys.readouterr().out)["voyage"] == "voyage"


def test_a_proved_mistake_is_refused_and_nothing_is_written(sail, write_csv, tmp_path):
    columns = sail()
    columns["rudder_angle_deg"] = -columns["rudder_angle_deg"]
    path, out = write_csv(columns), tmp_path / "v.mcap"
    with pytest.raises(
        DataError,
        match=r"sign = -1 for rudder_angle_deg.*into a map .*--accept "
        r"rudder_sign",
    ) as caught:
        run(path, "-o", out)
    assert "\n" not in str(caught.value) and caught.value.exit_code == 4
    assert [p.name for p in tmp_path.iterdir()] == ["voyage.csv"]
    assert run(path, "-o", out, "--accept", "rudder_sign") == 0 and out.exists()


def test_a_doubt_is_printed_but_does_not_refuse(sail, write_csv, tmp_path, capsys):
    assert run(write_csv(sail(200.0)), "-o", tmp_path / "v.mcap") == 0
    assert "look     duration: 199.9 s" in capsys.readouterr().out


def test_the_ship_is_remembered_and_lets_the_checks_say_more(sail, write_csv, tmp_path, capsys):
    run(write_csv(sail(900.0, 320.0, 8.0)), "-o", tmp_path / "v.mcap", "--ship", "kvlcc2", "--every-check")
    assert "advance ratio J" in capsys.readouterr().out
    assert read_voyage(tmp_path / "v.mcap").meta["ship"] == "KVLCC2"


def test_wrong_words_on_the_command_line(sail, write_csv, tmp_path):
    path = write_csv(sail(60.0))
    with pytest.raises(SettingsError, match="Did you mean 'rudder_sign'"):
        run(path, "-o", tmp_path / "v.mcap", "--accept", "rudder_sing")
    with pytest.raises(SettingsError, match="cannot be read"):
        run(path, "-o", tmp_path / "v.mcap", "--map", tmp_path / "none.toml")


def test_a_folder_that_cannot_be_written_leaves_nothing(sail, write_csv, tmp_path):
    with pytest.raises(Exception, match="cannot be written"):
        run(write_csv(sail(60.0)), "-o", tmp_path / "no" / "v.mcap")


def test_the_example_map_of_the_page_reads_its_example_file(tmp_path):
    """docs/import.md shows a file and its map; they fit."""
    from pathlib import Path

    page = (Path(__file__).parents[2] / "docs" / "import.md").read_text()
    blocks = [b.partition("\n") for b in page.split("```")[1::2]]
    table = next(body for kind, _, body in blocks if kind == "text")
    by = next(body for kind, _, body in blocks if kind == "toml")
    lines = table.strip().splitlines()
    head, row = lines[:3], lines[3].split(";")
    rows = [";".join([row[0], f"08:30:{k // 2:02d},{5 * (k % 2)}", *row[2:]]) for k in range(40)]
    (tmp_path / "bridge.csv").write_text("\n".join([*head, *rows]) + "\n")
    (tmp_path / "bridge.toml").write_text(by)
    found = import_voyage(tmp_path / "bridge.csv", tmp_path / "bridge.toml")
    assert len(found.voyage) == 40 and found.voyage.step_s == pytest.approx(0.5)
    assert found.voyage["surge_velocity_mps"][0] == pytest.approx(6.2, abs=0.2)


def test_of_a_log_with_a_row_for_each_sentence_it_is_said_how_often_a_heading_came():
    """Test: five sentences a second, a heading in one of them; and a table. Expected: every second; every 0.5 s."""
    t = np.arange(0.0, 60.0, 0.2)
    heading = np.where(np.arange(t.size) % 5 == 0, 90.0, np.nan)
    assert how_often(Voyage("log", t, {"heading_true_north_deg": heading}, {})) == "a heading every 1 s"
    table = Voyage("table", t * 2.5, {"heading_true_north_deg": np.full(t.size, 90.0)}, {})
    assert how_often(table) == "a sample every 0.5 s"


@pytest.mark.parametrize("words", [("--json", "-"), ("--report", "r.html"), ("--accept", "wind")])
def test_a_map_is_proposed_alone(sail, write_csv, words):
    with pytest.raises(UsageError, match="--suggest-map writes a map and imports nothing"):
        run(write_csv(sail(60.0)), "--suggest-map", *words)
