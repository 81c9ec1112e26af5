"""`twin tube`: from voyages to the [tube] of a ship file, which the loop then says."""

import json
import shutil

import pytest

import twin
from tests.report.boat import straight_with_a_turn
from twin import cli
from twin.api.json_key import unknown_paths
from twin.api.json_keys import KEYS
from twin.errors import DataError
from twin.live.log_replay import replay
from twin.live.signals.config import Settings
from twin.study.reference.derivatives import noted
from twin.study.reference.sailed import read_all, samples_hash


@pytest.fixture(scope="module")
def voyages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("voyages")
    return [straight_with_a_turn(folder / f"v{seed}.csv", seed) for seed in (1, 2)]


@pytest.fixture(scope="module")
def found(voyages, tmp_path_factory):
    """What the command wrote: its JSON and its ship file."""
    folder = tmp_path_factory.mktemp("ship")
    told, ship, own = folder / "told.json", folder / "boat.toml", folder / "own.toml"
    twin.Ship.load("usv").save(own)
    own.write_text("# ours since 2019\n" + own.read_text())
    command = ["tube", *voyages, "--ship", str(own), "-o", str(ship), "--json", str(told)]
    assert cli.main(command) == 0
    return json.loads(told.read_text()), ship


def test_the_command_writes_a_tube_and_says_what_so_few_voyages_can_promise(found):
    result, _ = found
    assert unknown_paths(KEYS["tube"], result) == []
    rows = {row["horizon_s"]: row for row in result["horizons"]}
    assert rows[10.0]["voyages"] == 2 and rows[10.0]["level"] == pytest.approx(2.0 / 3.0)
    assert 0.0 < rows[10.0]["place_m"] < 10.0
    few, *others = result["doubts"]
    assert "67 % at best" in few and any("120 s" in text for text in others)
    assert any("one sea" in text for text in others)


def test_the_ship_file_with_its_tube_is_the_same_ship(found):
    _, path = found
    made, before = twin.Ship.load(path), twin.Ship.load("usv")
    assert made.derivatives == before.derivatives and made.L_pp == before.L_pp
    assert set(made.notes) - set(before.notes) == {"tube"}
    assert path.read_text().startswith("# ours since 2019\n")


def test_a_replay_with_the_tube_says_how_it_was_kept(found, voyages, tmp_path):
    """Test: a voyage of the calibration itself. Expected: every error within the greatest of all; what was
    promised, its width and the voyages it rests on in the summary."""
    _, ship = found
    log = tmp_path / "v.mcap"
    assert cli.main(["import", voyages[0], "-o", str(log)]) == 0
    summary = replay(log, Settings({"ship.file": str(ship)}))
    row = next(c for c in summary.tube if c.horizon_s == 10.0)
    assert row.voyages == 2 and row.level == pytest.approx(2.0 / 3.0) and row.judged > 5
    assert row.place_inside > 0.9 and row.heading_inside > 0.9
    assert row.place_score_m >= row.place_radius_m > 0.0
    assert replay(log, Settings({"ship.file": "usv"})).tube == []


def test_a_voyage_given_twice_is_refused(voyages):
    with pytest.raises(DataError, match="same voyage"):
        twin.tube(twin.Ship.load("usv"), twin.read_voyages([voyages[0], voyages[0]]))


def test_a_voyage_of_the_calibration_is_known_by_what_is_in_it_whatever_it_is_called(voyages, tmp_path):
    """Test: a ship that was calibrated on the file v1, or in Python on its samples; a copy of that under another name
    beside another voyage of the name v1. Expected: the copy is told, and not its namesake."""
    copy, namesake = tmp_path / "copy.csv", tmp_path / "v1.csv"
    shutil.copy(voyages[0], copy)
    shutil.copy(voyages[1], namesake)
    usv, (known,) = twin.Ship.load("usv"), read_all(voyages[:1], twin.Ship.load("usv"))
    by_file, by_samples = (
        noted(usv, "structural", {"voyages": [{"name": "v1", "sha256": sha256}]})
        for sha256 in (known.sha256, samples_hash(known.voyage))
    )
    own, told = tmp_path / "own.toml", tmp_path / "told.json"
    by_file.save(own)
    command = ["tube", str(copy), str(namesake), "--ship", str(own), "-o", str(tmp_path / "boat.toml")]
    assert cli.main([*command, "--json", str(told)]) == 0
    in_python = twin.tube(by_samples, twin.read_voyages([copy, namesake])).warnings
    for doubts in (json.loads(told.read_text())["doubts"], in_python):
        (again,) = (text for text in doubts if "was calibrated to" in text)
        assert again.startswith("The model was calibrated to copy: ")


def test_voyages_without_a_steady_stretch_are_one_line_and_no_file(tmp_path, capsys):
    path = tmp_path / "short.csv"
    straight_with_a_turn(path, 3)
    path.write_text("\n".join(path.read_text().splitlines()[:150]) + "\n")  # 15 s
    out = tmp_path / "boat.toml"
    assert cli.main(["tube", str(path), "--ship", "usv", "-o", str(out)]) == DataError.exit_code
    *_, complaint = capsys.readouterr().err.strip().splitlines()
    assert "DataError" in complaint and "steady stretches" in complaint and not out.exists()
