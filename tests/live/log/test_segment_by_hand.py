"""The recorder's parts one call at a time, without its thread: what is put on the disk when, and what is left when
a call to the system fails."""

import errno
import fcntl
import os

import pytest

from twin.errors import TwinError
from twin.live.log import record, segment
from twin.live.log.logfile import LogFile
from twin.live.log.mcap_read import McapReader
from twin.live.log.record import Recorder
from twin.live.log.segment import Segment, WholeWrites

TYPE = "keelson.TimestampedFloat"


def made(folder, **more):
    return Segment(folder, "twin", 5.0, more.pop("sync", lambda fd: None), record.zstd(), **more)


def descriptors():
    return len(os.listdir("/proc/self/fd"))


def test_everything_added_is_on_the_disk_after_a_sync_and_the_folder_once(tmp_path, monkeypatch):
    synced, folders = [], []
    monkeypatch.setattr(segment, "_sync_folder", folders.append)
    one = made(tmp_path / "deep" / "logs", sync=synced.append)
    assert one.opened_s == 5.0 and one.kept == 0 and one.channels == 0 and not one.broken
    for k in range(3):
        one.add("a/b", TYPE, b"", k, k)
        assert one.kept == k
        one.sync()
        assert one.kept == k + 1 and one.channels == 1
        assert one.size == os.path.getsize(one.path) and len(synced) == k + 1
    assert folders == [one.path.parent]
    one.finish()
    assert len(synced) == 4 and not one.deleted()
    os.unlink(one.path)
    assert one.deleted()
    before = descriptors()
    one.close()
    assert descriptors() == before - 1


def test_the_folder_itself_is_put_on_the_disk_and_given_back(tmp_path, monkeypatch):
    synced, before = [], descriptors()
    monkeypatch.setattr(os, "fsync", lambda fd: synced.append(os.readlink(f"/proc/self/fd/{fd}")))
    segment._sync_folder(tmp_path)
    assert synced == [str(tmp_path)] and descriptors() == before


def test_a_file_whose_head_cannot_be_written_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "write", lambda fd, data: (_ for _ in ()).throw(OSError(errno.ENOSPC, "full")))
    before = descriptors()
    with pytest.raises(OSError, match="full"):
        made(tmp_path)
    monkeypatch.undo()
    assert list(tmp_path.iterdir()) == [] and descriptors() == before


def test_a_disk_without_locks_leaves_neither_an_empty_file_nor_an_open_one(tmp_path, monkeypatch):
    """The recorder tries again each second: what one try left would fill folder and table of files."""
    monkeypatch.setattr(fcntl, "flock", lambda *_: (_ for _ in ()).throw(OSError(errno.ENOLCK, "no locks")))
    before = descriptors()
    with pytest.raises(OSError, match="no locks"):
        made(tmp_path)
    assert list(tmp_path.iterdir()) == [] and descriptors() == before


def test_a_write_that_fails_is_cut_back_and_forgotten_or_said_to_be_broken(tmp_path, monkeypatch):
    """Test: half of a piece is written, then the disk is full. Expected: the file is as before; what waited is
    forgotten by `give_up`; where it cannot be cut back either it is broken."""
    one, write = made(tmp_path), os.write
    one.add("a/b", TYPE, b"x" * 50, 1, 1)
    one.sync()
    size = one.size
    calls = []

    def half(fd, data):
        calls.append(len(data))
        if len(calls) > 1:
            raise OSError(errno.ENOSPC, "full")
        return write(fd, data[: len(data) // 2])

    monkeypatch.setattr(os, "write", half)
    one.add("a/b", TYPE, b"y" * 50, 2, 2)
    with pytest.raises(OSError, match="full"):
        one.sync()
    assert len(calls) == 2 and calls[1] == calls[0] - calls[0] // 2
    monkeypatch.undo()
    assert one.size == size == os.path.getsize(one.path) and not one.broken
    one.give_up()
    one.add("a/b", TYPE, b"z" * 50, 3, 3)
    one.sync()
    one.finish()
    one.close()
    assert [m.data[:1] for m in McapReader(one.path).messages()] == [b"x", b"z"]
    assert McapReader(one.path).problems == []

    one = made(tmp_path)
    calls.clear()
    monkeypatch.setattr(os, "write", half)
    monkeypatch.setattr(os, "ftruncate", lambda fd, size: (_ for _ in ()).throw(OSError(errno.EIO, "gone")))
    one.add("a/b", TYPE, b"y" * 50, 2, 2)
    with pytest.raises(OSError, match="full"):
        one.sync()
    assert one.broken


def test_pieces_are_written_to_their_end(tmp_path, monkeypatch):
    fd = os.open(tmp_path / "x", os.O_RDWR | os.O_CREAT)
    write = os.write
    monkeypatch.setattr(os, "write", lambda fd, data: write(fd, data[:3]))
    one = WholeWrites(fd)
    one.put(b"0123456789")
    one.put(b"ab")
    assert one.size == 12 and os.pread(fd, 20, 0) == b"0123456789ab" and not one.broken
    os.close(fd)


def filled(recorder, count, topics=1):
    for k in range(count):
        recorder.write(f"a/{k % topics}", TYPE, b"", k)


def test_a_cycle_writes_what_waits_counts_it_and_tries_again_after_a_second(tmp_path, monkeypatch):
    """Test: the disk fails at 10 s and is well from then on. Expected: the loss is counted and said till the next
    try at 11 s; nothing is tried before."""
    recorder = Recorder(tmp_path, sync=lambda fd: None)
    filled(recorder, 3)
    recorder._cycle(9.0)
    assert recorder.state[:2] == (True, "") and recorder.state.written == 3 and recorder.state.lost == 0
    with monkeypatch.context() as patch:
        patch.setattr(Segment, "sync", lambda self: (_ for _ in ()).throw(OSError(errno.EIO, "bad sector")))
        filled(recorder, 2)
        recorder._cycle(10.0)
    state = recorder.state
    assert not state.ok and "bad sector" in state.alarm and "the log resumes by itself" in state.alarm
    assert (state.written, state.lost) == (3, 2)
    filled(recorder, 1)
    recorder._cycle(10.9)
    assert recorder.state.lost == 3 and not recorder.state.ok
    filled(recorder, 4)
    recorder._cycle(11.0)
    assert recorder.state.ok and (recorder.state.written, recorder.state.lost) == (7, 3)


def test_what_waits_at_the_end_is_written_though_the_disk_failed_a_moment_ago(tmp_path):
    recorder = Recorder(tmp_path, sync=lambda fd: None)
    recorder._retry_at = 1e18
    filled(recorder, 3)
    recorder._closing = True
    recorder._run()
    assert recorder.state.written == 3
    (path,) = tmp_path.glob("*.mcap")
    assert len(list(McapReader(path).messages())) == 3 and McapReader(path).problems == []


def test_a_file_that_cannot_be_cut_back_is_left_and_a_new_one_begun(tmp_path):
    recorder = Recorder(tmp_path, sync=lambda fd: None)
    filled(recorder, 2)
    recorder._cycle(1.0)
    first = recorder._segment
    recorder._fail("why", 2.0)
    assert recorder._segment is first
    first._file.broken = True
    recorder._fail("why", 3.0)
    assert recorder._segment is None and recorder._retry_at == 4.0
    filled(recorder, 2)
    recorder._cycle(4.0)
    assert recorder._segment.path != first.path and recorder.state.written == 4


def test_a_new_file_begins_with_its_size_its_age_or_its_number_of_topics(tmp_path, monkeypatch):
    monkeypatch.setattr(record, "MAX_CHANNELS", 3)
    recorder = Recorder(tmp_path, max_seconds=100.0, sync=lambda fd: None)
    filled(recorder, 2, topics=2)
    recorder._cycle(0.0)
    first = recorder._segment
    recorder._cycle(99.9)
    assert recorder._segment is first
    recorder._cycle(100.0)
    assert recorder._segment is not first
    filled(recorder, 8, topics=8)
    recorder._cycle(101.0)
    assert recorder.state.written == 10 and recorder._segment.channels <= 3
    recorder._closing = True
    recorder._run()
    files = sorted(tmp_path.glob("*.mcap"))
    topics = [{m.topic for m in McapReader(path).messages()} for path in files if path.stat().st_size > 0]
    assert max(map(len, topics)) <= 3 and sum(map(len, topics)) == 10
    recorder = Recorder(tmp_path / "by_size", max_bytes=1, sync=lambda fd: None)
    for now_s in (0.0, 1.0):
        filled(recorder, 1)
        recorder._cycle(now_s)
    assert len(list((tmp_path / "by_size").glob("*.mcap"))) == 2


def test_a_log_written_in_one_go_gives_its_file_back_also_when_it_fails(tmp_path):
    before = descriptors()
    with LogFile(tmp_path / "a.mcap") as log:
        log.add("a/b", TYPE, b"", 1)
    assert descriptors() == before and [p.name for p in tmp_path.iterdir()] == ["a.mcap"]
    with pytest.raises(KeyError), LogFile(tmp_path / "b.mcap") as log:
        raise KeyError
    assert descriptors() == before and [p.name for p in tmp_path.iterdir()] == ["a.mcap"]


def test_a_log_takes_the_place_of_a_file_and_of_nothing_else(tmp_path):
    """Expected: a device, a pipe or a folder of that name is named, and stays what it is."""
    pipe = tmp_path / "pipe.mcap"
    os.mkfifo(pipe)
    (tmp_path / "folder.mcap").mkdir()
    for place in (pipe, tmp_path / "folder.mcap"):
        with pytest.raises(TwinError, match="is no file"), LogFile(place) as log:
            log.add("a", TYPE, b"", 1)
    assert pipe.is_fifo() and sorted(p.name for p in tmp_path.iterdir()) == ["folder.mcap", "pipe.mcap"]
