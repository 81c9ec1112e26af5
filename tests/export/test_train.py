"""`twin train` on the command line: what it refuses before any work."""

from tests.live.actuators import PODS, craft
from twin.cli import main


def test_a_file_that_is_no_manifest_is_not_written_over_by_one(tmp_path, capsys):
    """Test: monday.json is there, and monday.onnx is not. Expected: one line before any work; the file as it was."""
    (tmp_path / "monday.json").write_text("mine")
    assert main(["train", "v.mcap", "--ship", "kvlcc2", "-o", str(tmp_path / "monday.onnx")]) == 1
    assert "monday.json, which is there" in capsys.readouterr().err
    assert (tmp_path / "monday.json").read_text() == "mine"


def test_a_ship_with_actuators_is_refused_before_anything_is_read(tmp_path, capsys):
    craft(*PODS).save(tmp_path / "boat.toml")
    words = ["train", "v.mcap", "--ship", str(tmp_path / "boat.toml"), "-o", str(tmp_path / "r.onnx")]
    assert main(words) == 5
    assert "lists [[actuators]]" in capsys.readouterr().err
