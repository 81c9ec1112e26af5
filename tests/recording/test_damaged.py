"""Damaged files: every verb that reads one says which seconds of it are lost, in words, in JSON and on the
page; none is silent."""

import gzip
import json
import shutil
import struct
from pathlib import Path

import pytest

from tests.thorough import thorough
from twin.cli import main
from twin.commands.story import MONDAY, SHIP
from twin.errors import DataError
from twin.live.log.played import PlayedLog
from twin.live.log.recover import recover
from twin.recording.checks import losses, of_voyages
from twin.recording.read import read_voyage
from twin.recording.write import write_voyage

CHUNK = 6


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "monday.mcap"
    write_voyage(read_voyage(MONDAY), path)
    return path


def chunks(data):
    """(place, length) of every chunk's content."""
    at = 8
    while at < len(data) - 8:
        opcode, length = struct.unpack_from("<BQ", data, at)
        if opcode == CHUNK:
            yield at + 9, length
        at += 9 + length


def cut(path: Path, share: float = 0.5) -> None:
    """As a copy that was interrupted."""
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])


def rot(path: Path, which: int) -> None:
    """One bit of a chunk is another."""
    data = bytearray(path.read_bytes())
    at, length = list(chunks(data))[which]
    data[at + length // 2] ^= 1
    path.write_bytes(bytes(data))


def crash(path: Path) -> None:
    """Cut off, and finished by the service's next start."""
    cut(path, 0.4)
    assert "repaired" in recover(path)


def said(path):
    """What the check of the file says, "" when nothing."""
    entry = next(c for c in of_voyages([read_voyage(path)]) if c["check"] == "whole_file")
    return "" if entry["ok"] else entry["text"]


def test_a_whole_file_is_said_to_be_whole(whole):
    assert said(whole) == "" and said(MONDAY) == ""


def test_a_copy_that_broke_off_tells_how_many_seconds_are_lost(whole, tmp_path):
    """Expected: the seconds that are there and those that are lost make the voyage, however it is cut."""
    for share in (0.3, 0.5, 0.8):
        path = Path(shutil.copy(whole, tmp_path / f"{share}.mcap"))
        cut(path, share)
        left = read_voyage(path).duration_s
        assert 0.0 < left < 1800.0
        assert f"{1800.0 - left:.4g} s are lost, from {left:.6g} s to the end at 1800 s" in said(path)


def test_a_chunk_whose_checksum_does_not_fit_is_named_with_its_seconds(whole, tmp_path):
    parts = len(list(chunks(whole.read_bytes())))
    assert parts > 3
    for which in (0, parts // 2, parts - 1):
        path = Path(shutil.copy(whole, tmp_path / f"{which}.mcap"))
        rot(path, which)
        words = said(path)
        assert "damaged" in words and " s are lost, from " in words, words
        t = read_voyage(path).time_s
        if 0 < which < parts - 1:
            gone = max(t[1:] - t[:-1])
            assert f"{gone:.4g} s are lost" in words


def test_a_log_that_was_repaired_after_a_crash_says_so_for_good(whole, tmp_path):
    """Expected: also when it is read, imported and read again."""
    path = Path(shutil.copy(whole, tmp_path / "crashed.mcap"))
    crash(path)
    left = read_voyage(path).duration_s
    assert "repaired" in said(path) and f"from {left:.6g} s" in said(path)
    assert recover(path) == "", "it is whole now"
    write_voyage(read_voyage(path), tmp_path / "again.mcap")
    assert "repaired" in said(tmp_path / "again.mcap")


def test_a_torn_last_line_of_a_table_is_damage(write_csv, columns):
    path = write_csv(columns)
    assert said(path) == ""
    path.write_text(path.read_text()[:-20])
    assert "cut off" in said(path)


def test_a_message_that_cannot_be_decoded_is_damage(whole, tmp_path):
    from twin.live.log.logfile import LogFile, read

    with LogFile(tmp_path / "odd.mcap") as log:
        for i, m in enumerate(read(whole)):
            log.add(m.topic, m.type_name, b"\xff\xff" if i == 50 else m.data, m.log_ns)
    assert "1 left out: shiptwin.Row that cannot be decoded" in said(tmp_path / "odd.mcap")
    played = PlayedLog(tmp_path / "odd.mcap", 1.0)
    assert sum(1 for _ in played.batches()) > 1000 and any(
        "cannot be decoded" in note for note in played.notes
    )


@pytest.mark.parametrize("harm", [cut, lambda path: rot(path, 2), crash], ids=["cut", "rotten", "crashed"])
def test_import_and_a_played_log_say_what_is_lost(whole, tmp_path, capsys, harm):
    path, answer = Path(shutil.copy(whole, tmp_path / "v.mcap")), tmp_path / "a.json"
    harm(path)
    assert main(["import", str(path), "-o", str(tmp_path / "o.mcap"), "--json", str(answer)]) == 0
    assert "whole_file: " in capsys.readouterr().out
    assert not next(c for c in json.loads(answer.read_text())["data_checks"] if c["check"] == "whole_file")[
        "ok"
    ]
    played = PlayedLog(path, 1.0)
    assert sum(1 for _ in played.batches()) > 500 and any("lost" in note for note in played.notes)


@thorough
def test_compare_and_replay_say_it_in_words_in_json_and_on_the_page(whole, tmp_path, capsys):
    path, answer, page = (
        Path(shutil.copy(whole, tmp_path / "v.mcap")),
        tmp_path / "a.json",
        tmp_path / "p.html",
    )
    cut(path)
    assert (
        main(["compare", str(path), "--ship", str(SHIP), "--json", str(answer), "--report", str(page)]) == 0
    )
    assert "whole_file: " in capsys.readouterr().out
    entry = next(c for c in json.loads(answer.read_text())["data_checks"] if c["check"] == "whole_file")
    assert not entry["ok"] and " s are lost, from " in entry["text"]
    assert entry["text"].split(":")[0] in page.read_text(), "the page has it too"
    assert main(["replay", str(path), "--json", str(answer)]) == 0
    assert " s are lost, from " in capsys.readouterr().out
    assert any("are lost, from " in note for note in json.loads(answer.read_text())["notes"])


def test_losses_are_one_line_a_voyage():
    entries = [
        {"check": "whole_file", "ok": False, "text": "cut", "voyage": "v"},
        {"check": "wind", "ok": False, "text": "x"},
        {"check": "time_gaps", "ok": True, "text": "none", "voyage": "v"},
    ]
    assert losses(entries) == ["lost  v: cut"]


@thorough
def test_diagnose_says_it_too(whole, tmp_path, capsys):
    path, answer = Path(shutil.copy(whole, tmp_path / "v.mcap")), tmp_path / "a.json"
    cut(path, 0.7)
    assert main(["diagnose", str(path), "--ship", str(SHIP), "--json", str(answer)]) == 0
    assert "are lost, from " in capsys.readouterr().out
    assert not next(c for c in json.loads(answer.read_text())["data_checks"] if c["check"] == "whole_file")[
        "ok"
    ]


@pytest.mark.parametrize("harm", ["a byte of the middle", "cut off", "no gzip at all"])
def test_a_packed_table_that_is_damaged_is_one_line(tmp_path, columns, write_csv, harm):
    """Found by the fuzzer: a zlib.error of a damaged .gz."""
    packed = bytearray(gzip.compress(write_csv(columns).read_bytes(), mtime=0))
    if harm == "a byte of the middle":
        for at in range(len(packed) // 2, len(packed) // 2 + 40):
            packed[at] ^= 0xFF
    path = tmp_path / "v.csv.gz"
    path.write_bytes(
        packed[: len(packed) // 2] if harm == "cut off" else b"x" * 50 if "no" in harm else packed
    )
    with pytest.raises(DataError) as refused:
        read_voyage(path)
    assert "Copy it again" in str(refused.value) and "\n" not in str(refused.value)
