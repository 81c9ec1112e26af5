"""Small files kept by their own thread, and words to the service manager."""

import socket

from twin.live.keep import Keeper
from twin.live.notify import Notifier


def test_the_newest_text_is_kept_whole(tmp_path):
    path = tmp_path / "folder" / "numbers.json"
    keeper = Keeper(path)
    for k in range(100):
        keeper.put(str(k) * 1000)
    keeper.close(5.0)
    assert path.read_text() == "99" * 1000 and [p.name for p in path.parent.iterdir()] == ["numbers.json"]


def test_a_folder_that_cannot_be_written_is_said_and_does_no_harm(tmp_path):
    (tmp_path / "file").write_text("")
    keeper = Keeper(tmp_path / "file" / "numbers.json")
    keeper.put("1")
    keeper.close(5.0)
    assert "cannot be kept" in keeper.failed


def test_without_a_service_manager_nobody_is_told():
    Notifier("").ready("all well")


def test_the_service_manager_hears_ready_alive_and_status(tmp_path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(tmp_path / "s"))
        manager.settimeout(5.0)
        notifier = Notifier(str(tmp_path / "s"))
        notifier.ready("all\nwell")
        notifier.alive()
        notifier.status("x" * 1000)
        heard = [manager.recv(2000).decode() for _ in range(3)]
    assert heard[:2] == ["READY=1\nSTATUS=all well", "WATCHDOG=1"] and len(heard[2]) < 450


def test_a_manager_that_went_away_does_no_harm(tmp_path):
    notifier = Notifier(str(tmp_path / "gone"))
    notifier.alive()
