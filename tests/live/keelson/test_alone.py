"""One twin for each state folder."""

import errno
import fcntl

import pytest

from twin.errors import TwinError
from twin.live.keelson.alone import alone


def test_a_second_twin_of_the_same_state_folder_is_kept_out_until_the_first_ends(tmp_path):
    with alone(str(tmp_path)), pytest.raises(TwinError, match="another twin"), alone(str(tmp_path)):
        raise AssertionError("both are in")
    with alone(str(tmp_path)):
        pass


def test_what_would_block_inside_is_not_told_as_another_twin(tmp_path):
    """Such as a line on standard error that nobody takes."""
    with pytest.raises(BlockingIOError), alone(str(tmp_path)):
        raise BlockingIOError(errno.EAGAIN, "no room in the pipe")


def test_on_a_disk_without_locks_nobody_is_kept_out(tmp_path, monkeypatch):
    monkeypatch.setattr(fcntl, "flock", lambda *_: (_ for _ in ()).throw(OSError(errno.ENOLCK, "no locks")))
    with alone(str(tmp_path)):
        assert (tmp_path / "twin.lock").exists()
