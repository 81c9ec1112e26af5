"""The service as `twin run` opens it, in a folder of its own, with a sea that speaks to it. Each tick is told
over a pipe besides, so that it is known what a killed process had done."""

import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from twin.errors import TwinError
from twin.live.demonstration import free_port

SERVE = """
import os, sys, traceback
from twin.live import service
from twin.live.signals import config
def on_tick(tick):
    {hook}
code = 1
try:
    code = service.serve(config.load(sys.argv[1]), on_tick=on_tick)
except BaseException:
    traceback.print_exc()
finally:
    sys.stderr.flush()
    os._exit(code)
"""  # a process that serves with a hook at each tick, and always ends
TELL = """word = f"{tick.index} {tick.time_s!r} {int(tick.certificate.inside)} {tick.overruns} {tick.mode}"
    os.write(1, f"{word}|{'; '.join(tick.reasons)}\\n".encode())"""


PRIORITY = 20  # SCHED_FIFO, as deploy/shiptwin.service gives it; without the right the twin says so and runs


class Said(NamedTuple):
    """What one tick told over the pipe; `time_s` monotonic, of all processes alike."""

    index: int
    time_s: float
    inside: bool
    overruns: int
    mode: str
    reasons: str


class ServiceFolder:
    """A folder with settings, logs and state; the sea sails until `close`."""

    def __init__(self, folder: Path, hull: str, rate_hz: float = 10.0):
        self.folder, self.logs = folder, folder / "logs"
        self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        self.config = folder / "twin.toml"
        self.config.write_text(
            f"[ship]\nfile = {json.dumps(hull)}\n[loop]\nrate_hz = {rate_hz}\npriority = {PRIORITY}\n"
            f"lock_memory = false\n[bus]\nlisten = {json.dumps(self.endpoint)}\n"
            f"[log]\nfolder = {json.dumps(str(self.logs))}\n"
            f"[state]\nfolder = {json.dumps(str(folder / 'state'))}\n"
        )
        sea = [sys.executable, "-m", "bench.cli", "sea", "--hull", hull, "--connect", self.endpoint]
        silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.sea = subprocess.Popen([*sea, "--after", "60"], **silent)
        self.on_time = True
        try:  # its instruments speak on time, however busy the machine is
            os.sched_setscheduler(self.sea.pid, os.SCHED_FIFO, os.sched_param(PRIORITY))
        except PermissionError:
            self.on_time = False

    def start(self, **environment: str) -> "Running":
        return Running(self, environment)

    def close(self) -> None:
        self.sea.kill()
        self.sea.wait()


class Running:
    """One process of the service."""

    def __init__(self, place: ServiceFolder, environment: dict[str, str]):
        self.began_s = time.monotonic()
        self.errors = open(place.folder / "errors", "a+")  # noqa: SIM115  (closed with the process)
        self.process = subprocess.Popen(
            [sys.executable, "-c", SERVE.format(hook=TELL), str(place.config)],
            stdout=subprocess.PIPE,
            stderr=self.errors,
            env=os.environ | environment,
        )
        self._rest, self.last = b"", Said(-1, 0.0, False, 0, "", "")
        assert self.process.stdout
        os.set_blocking(self.process.stdout.fileno(), False)

    def heard(self, seconds: float) -> Iterator[Said]:
        """What it says within so long; ends when the process does."""
        assert self.process.stdout
        ends = time.monotonic() + seconds
        while time.monotonic() < ends:
            alive = self.process.poll() is None
            if piece := self.process.stdout.read(1 << 16):
                *lines, self._rest = (self._rest + piece).split(b"\n")
                for line in lines:
                    self.last = said_of(line.decode())
                    yield self.last
            elif not alive:
                return
            else:
                time.sleep(0.01)

    def until(self, wanted: Callable[[Said], bool], seconds: float) -> float | None:
        """Seconds until a tick of which `wanted(said)`; None when there is none in time."""
        began = time.monotonic()
        return next((time.monotonic() - began for said in self.heard(seconds) if wanted(said)), None)

    def tell(self, number: int) -> None:
        os.kill(self.process.pid, number)

    def kill(self) -> Said:
        """kill -9; the last tick that it had told."""
        self.process.kill()
        self.process.wait()
        for _ in self.heard(1.0):
            pass
        self.errors.close()
        return self.last

    def stop(self) -> int:
        """SIGTERM; the exit code."""
        if self.process.poll() is None:
            self.tell(signal.SIGTERM)
        try:
            return self.process.wait(20.0)
        except subprocess.TimeoutExpired:
            self.kill()
            return -9


def said_of(line: str) -> Said:
    head, _, reasons = line.partition("|")
    index, time_s, inside, overruns, mode = head.split(" ", 4)
    return Said(int(index), float(time_s), inside == "1", int(overruns), mode, reasons)


class Shift:
    """The wall clock of a process that is started with `environment`, set by `to(seconds)`."""

    def __init__(self, folder: Path):
        compiler = shutil.which("cc") or shutil.which("gcc")
        if not compiler:
            raise TwinError("a C compiler is needed to set one process's clock. Install gcc, or --clocks 0.")
        source, library = Path(__file__).with_name("clock_shift.c"), folder / "clock_shift.so"
        subprocess.run([compiler, "-O1", "-shared", "-fPIC", "-o", library, source], check=True)
        self._file = folder / "shift_ns"
        self.to(0.0)
        self.environment = {"LD_PRELOAD": str(library), "SHIFT_NS_FILE": str(self._file)}

    def to(self, seconds: float) -> None:
        data = struct.pack("<q", round(seconds * 1e9))
        if not self._file.exists():
            self._file.write_bytes(data)
        with open(self._file, "r+b") as file:
            file.write(data)
