"""S4: the power goes while the log is written to a real file system; what its journal then gives back misses
a second at most."""

import os
import random
import shutil
import subprocess
import sys
from pathlib import Path
from time import monotonic_ns, sleep

import pytest

from twin.live.log.record import read
from twin.live.log.recover import recover_folder

WRITER = """
import sys, time
from twin.live.log.record import Recorder
with Recorder(sys.argv[1]) as recorder:
    for i in range(100000):
        recorder.write("a/@v0/b/pubsub/twin_tick/twin", "shiptwin.Tick", b"x" * 300, time.monotonic_ns())
        time.sleep(0.005)
"""


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


@pytest.fixture
def disk(tmp_path):
    """`mounted(image)` puts an image on a folder; everything is taken away afterwards."""
    folders = []

    def mounted(image):
        folders.append(tmp_path / f"{image.name}.mounted")
        folders[-1].mkdir()
        if (done := run("mount", "-o", "loop", image, folders[-1])).returncode:
            folders.pop()
            pytest.skip(f"this machine lets nobody mount a loop: {done.stderr.strip()}")
        return folders[-1]

    yield mounted
    for folder in reversed(folders):
        run("umount", folder)


@pytest.mark.skipif(
    os.geteuid() != 0 or not shutil.which("mkfs.ext4"),
    reason="mounting an ext4 image needs root and mkfs.ext4",
)
def test_S4_a_power_cut_at_a_random_instant_costs_a_second_at_most(tmp_path: Path, disk) -> None:
    """Test: the image under the mounted disk is copied as it is at five random instants, its journal
    replayed, the log repaired."""
    image = tmp_path / "disk"
    with open(image, "wb") as file:
        file.truncate(32_000_000)
    assert run("mkfs.ext4", "-q", "-F", image).returncode == 0
    writer = subprocess.Popen([sys.executable, "-c", WRITER, str(disk(image) / "logs")])
    dice, cuts = random.Random(4), []
    try:
        sleep(2.0)
        for number in range(5):
            sleep(dice.uniform(0.2, 0.9))
            began_ns = monotonic_ns()
            shutil.copyfile(image, tmp_path / f"cut{number}")
            cuts.append((tmp_path / f"cut{number}", began_ns))
    finally:
        writer.kill()
        writer.wait()
    for copy, began_ns in cuts:
        folder = disk(copy) / "logs"
        recover_folder(folder)
        kept = [m.log_ns for file in folder.glob("*.mcap") for m in read(file)]
        assert kept and (began_ns - max(kept)) * 1e-9 <= 1.0
