"""Files that are there whole or not at all."""

import errno
import os
import stat
from argparse import Namespace

import pytest

from tests import command_lines
from twin import whole
from twin.cli import main
from twin.commands.story import SHIP
from twin.errors import SettingsError, TwinError


def test_what_was_there_is_replaced_and_nothing_else_stays(tmp_path):
    (tmp_path / "x.toml").write_text("old")
    whole.write(tmp_path / "x.toml", "new\n")
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("x.toml", "new\n")]


def test_bytes_that_do_not_fit_on_the_disk_leave_the_old_file_and_nothing_beside_it(tmp_path, monkeypatch):
    def full(_):
        raise OSError(errno.ENOSPC, "No space left on device")

    whole.write_bytes(tmp_path / "x.onnx", b"\x00old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(TwinError, match="No space left on device"):
        whole.write_bytes(tmp_path / "x.onnx", b"\x00new")
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("x.onnx", b"\x00old")]


def test_a_pipe_is_written_into_and_no_file_takes_its_place(tmp_path):
    """As root, `-o /dev/null` put a file in the place of the device."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    whole.write(pipe, "new\n")
    assert stat.S_ISFIFO(os.stat(pipe).st_mode) and os.read(reader, 100) == b"new\n"
    os.close(reader)
    assert [p.name for p in tmp_path.iterdir()] == ["pipe"]


def test_an_answer_may_go_into_a_pipe_whose_folder_nobody_may_write_to(tmp_path, monkeypatch):
    """Test: `--json /dev/fd/63` and `/dev/stdout`, by one who is not root. Expected: promised; a new file beside it
    is not, nor a pipe that may not be written to."""
    os.mkfifo(tmp_path / "pipe")
    rights = {str(tmp_path): False, str(tmp_path / "pipe"): True}
    monkeypatch.setattr(os, "access", lambda path, _: rights[str(path)])
    whole.promised(Namespace(json=str(tmp_path / "pipe")))
    with pytest.raises(TwinError, match="its folder may not be written to"):
        whole.promised(Namespace(json=str(tmp_path / "new.json")))
    rights[str(tmp_path / "pipe")] = False
    with pytest.raises(TwinError, match="it may not be written to"):
        whole.promised(Namespace(json=str(tmp_path / "pipe")))


@pytest.mark.parametrize("where", ["none/x.toml", "folder"])
def test_where_it_cannot_be_written_nothing_is_left_behind(tmp_path, where):
    """Test: a folder that is not there, and a folder in the file's own place. Expected: one line, exit code
    1."""
    (tmp_path / "folder").mkdir()
    with pytest.raises(TwinError, match=r"cannot be written .* --json") as failure:
        whole.write(tmp_path / where, "new\n", "--json")
    assert failure.value.exit_code == 1 and [p.name for p in tmp_path.iterdir()] == ["folder"]


@pytest.mark.parametrize(
    "words",
    [
        ["init", "Alma", "--length-pp-m", "180", "--beam-m", "30", "--draught-m", "10.5", "-o", "mine.toml"],
        ["add", "Wind", "--ship", "mine.toml", "--voyage", "v.mcap", "-o", "mine.toml"],
        ["remove", "Wind", "--ship", "mine.toml", "-o", "./mine.toml"],
        ["calibrate", "v.mcap", "--ship", "mine.toml", "-o", "mine.toml"],
        ["tube", "v.mcap", "--ship", "mine.toml", "-o", "mine.toml"],
    ],
    ids=lambda words: words[0],
)
def test_a_ship_file_is_not_written_over_without_being_asked_to(words, tmp_path, monkeypatch, capsys):
    """Test: -o names the calibrated ship file that is there. Expected: exit code 5, one line, before any
    work; the file as it was."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_bytes(SHIP.read_bytes())
    assert main(words) == 5
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "mine.toml" in said and "--force" in said
    assert (tmp_path / "mine.toml").read_bytes() == SHIP.read_bytes()


def test_force_writes_over_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_bytes(SHIP.read_bytes())
    assert main(command_lines.init("Alma", "-o", "mine.toml", "--force")) == 0
    assert b"Alma" in (tmp_path / "mine.toml").read_bytes()


READ_TOO = [
    (["instruments", "v.mcap", "--ship", "mine.toml", "-o", "v.mcap"], "-o v.mcap"),
    (["instruments", "v.mcap", "--ship", "mine.toml", "-o", "mine.toml"], "-o mine.toml"),
    (["instruments", "v.mcap", "--map", "m.toml", "-o", "m.toml"], "-o m.toml"),
    (["import", "v.mcap", "-o", "v.mcap"], "-o v.mcap"),
    (["import", "v.mcap", "--map", "m.toml", "-o", "w.mcap", "--report", "m.toml"], "--report m.toml"),
    (["compare", "v.mcap", "--ship", "mine.toml", "--json", "v.mcap"], "--json v.mcap"),
    (
        ["compare", "v.mcap", "--ship", "mine.toml", "--residual", "r.onnx", "--json", "r.json"],
        "--json r.json",
    ),
    (
        ["diagnose", "w.mcap", "--ship", "mine.toml", "--reference", "v.mcap", "--report", "v.mcap"],
        "--report v",
    ),
    (["calibrate", "v.mcap", "--ship", "mine.toml", "--force", "-o", "v.mcap"], "-o v.mcap"),
    (["tube", "v.mcap", "--ship", "mine.toml", "--config", "m.toml", "-o", "m.toml"], "-o m.toml"),
    (["history", "mine.toml", "--json", "mine.toml"], "--json mine.toml"),
    (["replay", "v.mcap", "-o", "./v.mcap"], "-o ./v.mcap"),
    (["train", "v.mcap", "--ship", "mine.toml", "-o", "r.onnx", "--json", "r.json"], "--json r.json"),
    (["compare", "v.mcap", "--ship", "mine.toml", "--json", "new", "--report", "./new"], "--report ./new"),
    (["add", "Wind", "--ship", "kvlcc2", "--voyage", "w", "-o", "new", "--json", "new"], "--json new"),
]


@pytest.mark.parametrize(("words", "said"), READ_TOO, ids=lambda x: x[0] if isinstance(x, list) else x)
def test_what_is_read_or_written_already_is_not_written_over(words, said, tmp_path, monkeypatch, capsys):
    """Test: an output is a voyage, the ship, a map, a learned residual's manifest, or another output. Expected: exit
    code 5 and one line before any work; every file as it was."""
    monkeypatch.chdir(tmp_path)
    for name in ("v.mcap", "mine.toml", "m.toml", "r.onnx", "r.json"):
        (tmp_path / name).write_text(name)
    assert main(words) == 5
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and said in error and "Choose another name" in error
    assert {p.name: p.read_text() for p in tmp_path.iterdir()} == {
        name: name for name in ("v.mcap", "mine.toml", "m.toml", "r.onnx", "r.json")
    }


def test_both_answers_may_go_to_one_device():
    whole.promised(Namespace(json=os.devnull, report=os.devnull, ship="kvlcc2", output=None))


def test_a_bench_may_have_paths_and_a_number_of_voyages(tmp_path):
    out = tmp_path / "m.json"
    whole.promised(Namespace(json=out, report=tmp_path / "m.html", voyages=3))
    with pytest.raises(SettingsError, match="would be written there, too"):
        whole.promised(Namespace(json=out, report=out, voyages=3))
