"""On the log's path every call to the system fails once, the first, the second, the n-th, as SQLite is tried:
nothing is raised, what is said to be kept is kept, and the next cycle goes on."""

import errno
import os

import pytest

from twin.errors import TwinError
from twin.live.log import segment
from twin.live.log.logfile import LogFile
from twin.live.log.mcap_read import McapReader
from twin.live.log.record import Recorder
from twin.live.log.recover import recover_folder

TYPE = "keelson.TimestampedFloat"
CALLS = ("open", "write", "fdatasync", "fsync", "ftruncate", "lseek", "fstat", "listdir", "close")
CYCLES, EACH = 6, 5


class Failing:
    """Counts one kind of call; the n-th of it, and those that follow for `again` calls, fail."""

    def __init__(self, patch, name, nth, number=errno.EIO, again=1):
        self.count, self.nth, self.last, self.number = 0, nth, nth + again, number
        self._true = getattr(os, name)
        patch.setattr(os, name, self)

    def __call__(self, *arguments, **more):
        self.count += 1
        if self.nth <= self.count < self.last:
            raise OSError(self.number, os.strerror(self.number))
        return self._true(*arguments, **more)


def logged(folder, max_seconds=2.5):
    """Cycles two seconds apart, each with messages of its own, and the end; files change on the way."""
    recorder = Recorder(folder, max_seconds=max_seconds, sync=lambda fd: os.fdatasync(fd))
    for cycle in range(CYCLES):
        for k in range(EACH):
            recorder.write(f"a/{k}", TYPE, b"%d" % (EACH * cycle + k), EACH * cycle + k)
        recorder._cycle(2.0 * cycle)
    recorder._closing = True
    recorder._run()
    return recorder.state


def kept(folder):
    """All messages that can be read, once each, and what the readers find wrong."""
    found, problems = [], []
    for path in sorted(folder.glob("*.mcap")):
        reader = McapReader(path)
        try:
            found += [int(message.data) for message in reader.messages()]
        except TwinError:
            assert reader.problems
        problems += reader.problems
    return found, problems


@pytest.mark.parametrize("again", (1, 3))
@pytest.mark.parametrize("name", CALLS)
def test_S1_S2_whichever_call_of_the_recorder_fails_what_it_says_it_kept_is_kept(
    tmp_path, monkeypatch, name, again
):
    """Expected, for every n until the call is not reached any more: no exception; kept and lost are all that was
    written; the files hold at least what was told as written, each message once and in order, and after the next
    start's repair nothing in them is damaged."""
    tried = 0
    for nth in range(1, 200):
        folder = tmp_path / str(nth)
        with monkeypatch.context() as patch:
            failing = Failing(patch, name, nth, again=again)
            state = logged(folder)
        if failing.count < nth:
            break
        tried += 1
        assert state.written + state.lost == CYCLES * EACH, nth
        recover_folder(folder)
        found, problems = kept(folder)
        assert len(found) >= state.written and found == sorted(set(found)), (nth, state, found)
        assert all("repaired" in problem for problem in problems), (nth, problems)
        assert state.lost <= (again + 1) * EACH, (nth, state)
    else:
        raise AssertionError(f"{name} is called without end")
    assert tried >= (0 if name in ("ftruncate", "lseek") else 1), f"{name} is never called"


@pytest.mark.parametrize("name", ("fsync", "replace"))
def test_a_log_written_in_one_go_is_there_whole_or_not_at_all(tmp_path, monkeypatch, name):
    with monkeypatch.context() as patch, pytest.raises(TwinError, match="Nothing was left behind"):
        Failing(patch, name, 1)
        with LogFile(tmp_path / "a.mcap") as log:
            log.add("a/b", TYPE, b"", 1)
    assert list(tmp_path.iterdir()) == []


def test_a_repair_that_fails_at_any_call_is_done_again_at_the_next_start(tmp_path, monkeypatch):
    """Test: an unfinished log; its repair fails at the n-th call of each kind. Expected: one sentence or nothing is
    said, and the repair after it gives every message."""
    with monkeypatch.context() as patch:
        patch.setattr(segment.Segment, "finish", lambda self: None)
        logged(tmp_path / "cut", max_seconds=1e9)
    (path,) = (tmp_path / "cut").glob("*.mcap")
    whole = path.read_bytes()
    for name in ("fdatasync", "ftruncate"):
        path.write_bytes(whole)
        with monkeypatch.context() as patch:
            Failing(patch, name, 1)
            recover_folder(path.parent)
        recover_folder(path.parent)
        found, problems = kept(path.parent)
        assert found == list(range(CYCLES * EACH)) and all("repaired" in problem for problem in problems)
