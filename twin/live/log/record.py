"""The log: a thread that writes MCAP files and never holds up the loop.

`Recorder.write` only puts a message in a queue. The thread writes a chunk each `PERIOD_S`, or when
`MAX_WAITING` messages wait, and calls fdatasync, so a kill or a power cut loses at most half a second. When
the disk is full, read-only or gone, the log stops, says so in words and counts what it could not keep; the
twin goes on, and the log resumes by itself."""

import os
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread
from typing import NamedTuple

from twin.live.log.logfile import LogFile, read, read_rows
from twin.live.log.mcap_write import zstd
from twin.live.log.quota import Quota, trim
from twin.live.log.recover import recover_folder
from twin.live.log.segment import Segment

__all__ = ["LogFile", "LogState", "Recorder", "read", "read_rows"]

PERIOD_S = 0.25  # between two writes: half of what may be lost
RETRY_S = 1.0  # between two tries on a disk that fails
NOTICE_S = 10.0  # how long a loss that is over is still said
TRIM_S = 10.0  # between two looks at what the folder takes
TRIMMED_S = 60.0  # how long it is said that old files were deleted
NO_LIMITS = Quota()
MAX_WAITING = 256  # messages that wait no longer: a flood must not pile up in memory
QUEUE = 4096  # messages the loop may be ahead of the disk (4 s at 50 Hz with 20 sensors); the oldest go first
MAX_CHANNELS = 4096  # topics in one file: the format ends at 65 535, and each waits in memory for the index
Item = tuple[str, str, bytes, int, int]  # topic, type name, payload, log and publish time [ns since 1970]


class LogState(NamedTuple):
    """How the log fares: the alarm in words ("" when there is none), where it writes, what it counted."""

    ok: bool
    alarm: str
    path: str
    written: int
    dropped: int  # the queue was full: the disk is too slow
    lost: int  # the disk would not take them


class Recorder:
    """Logs into `folder` as numbered files; starts even when the folder cannot be written."""

    def __init__(
        self,
        folder: str | Path,
        name: str = "twin",
        max_bytes: int = 256 * 1024 * 1024,
        max_seconds: float = 900.0,
        sync: Callable[[int], None] = os.fdatasync,
        quota: Quota = NO_LIMITS,
    ):
        self.folder, self.name = Path(folder), name
        self.monotonic: Callable[[], float] = time.monotonic  # by which a file grows old [s]
        self.max_bytes, self.max_seconds = max_bytes, max_seconds
        self.quota, self._trim_at = quota, 0.0
        self.repaired: list[str] = []
        self.about: dict[str, str] = {}  # stands at the head of every file
        self._sync = sync
        self._compress = zstd()
        self._queue: deque[Item] = deque(maxlen=QUEUE)
        self._closing = False
        self._wake = Event()
        self._thread = Thread(target=self._run, name="recorder", daemon=True)
        self._segment: Segment | None = None
        self._retry_at = 0.0
        self._alarm = ""
        self._notice, self._notice_until = "", 0.0
        self._taken = self._closed = 0  # messages out of the queue, messages in finished files
        self._written = self._dropped = self._lost = 0

    def __enter__(self) -> "Recorder":
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def start(self) -> None:
        """Repairs what a crash left in the folder (see `repaired`) and starts the thread."""
        self.repaired = recover_folder(self.folder, self.name)
        self._thread.start()

    def write(
        self, topic: str, type_name: str, payload: bytes, log_ns: int, publish_ns: int | None = None
    ) -> None:
        """Queues one message (no envelope); never waits. Times are nanoseconds since 1970."""
        if len(self._queue) == QUEUE:
            self._dropped += 1
            self._say(f"log: the disk at {self.folder} is too slow, messages are dropped")
        self._queue.append((topic, type_name, payload, log_ns, log_ns if publish_ns is None else publish_ns))
        if len(self._queue) == MAX_WAITING:
            self._wake.set()

    @property
    def state(self) -> LogState:
        """How the log is: its file, its alarm and its counts."""
        path = str(self._segment.path) if self._segment else ""
        alarm = self._alarm or (self._notice if self.monotonic() < self._notice_until else "")
        return LogState(not self._alarm, alarm, path, self._written, self._dropped, self._lost)

    def close(self, timeout_s: float = 2.0) -> LogState:
        """Writes what is queued, finishes the file and stops; gives up waiting after `timeout_s`."""
        self._closing = True
        self._wake.set()
        if self._thread.is_alive():
            self._thread.join(timeout_s)
        return self.state

    def _say(self, notice: str, seconds: float = NOTICE_S) -> None:
        """Something went wrong and the log goes on: said for a while."""
        self._notice, self._notice_until = notice, self.monotonic() + seconds

    def _run(self) -> None:
        while not self._closing:
            self._wake.wait(PERIOD_S)
            self._wake.clear()
            self._cycle(self.monotonic())
        self._retry_at = 0.0
        self._cycle(self.monotonic())
        with suppress(OSError):  # then the next start finishes it
            self._close_segment(finish=True)

    def _cycle(self, now_s: float) -> None:
        """Writes everything that is queued, as one chunk or more, and syncs."""
        batch = [self._queue.popleft() for _ in range(len(self._queue))]
        self._taken += len(batch)
        if now_s >= self._retry_at:
            try:
                self._write(batch, now_s)
                self._alarm = ""
            except OSError as failure:
                self._fail(failure.strerror or str(failure), now_s)
            except Exception as failure:  # a message no log can hold: say so, never die in silence
                self._fail(f"{type(failure).__name__}: {failure}", now_s)
        self._written = self._closed + (self._segment.kept if self._segment else 0)
        self._lost = self._taken - self._written

    def _write(self, batch: list[Item], now_s: float) -> None:
        self._make_room(now_s)
        segment = self._current(now_s)
        for item in batch:
            if segment.channels >= MAX_CHANNELS:
                segment.sync()
                segment = self._current(now_s)
            segment.add(*item)
        segment.sync()

    def _make_room(self, now_s: float) -> None:
        """Deletes the oldest files when the folder takes more than it may; OSError when the disk is too full
        even then."""
        if self.quota == NO_LIMITS or now_s < self._trim_at or not self.folder.is_dir():
            return
        if said := trim(self.folder, self.name, self.quota, self._segment.path if self._segment else None):
            self._say(said, TRIMMED_S)
        self._trim_at = now_s + TRIM_S

    def _current(self, now_s: float) -> Segment:
        """The file to write to: the one in use, or the next when that is old, full or deleted."""
        segment = self._segment
        if segment and segment.deleted():
            self._close_segment(finish=False)
            self._say(f"log: a file in {self.folder} was deleted while being written, a new one is begun")
        elif segment and (
            segment.size >= self.max_bytes
            or segment.channels >= MAX_CHANNELS
            or now_s - segment.opened_s >= self.max_seconds
        ):
            self._close_segment(finish=True)
        if self._segment is None:
            self._segment = Segment(self.folder, self.name, now_s, self._sync, self._compress, self.about)
        return self._segment

    def _close_segment(self, finish: bool) -> None:
        segment, self._segment = self._segment, None
        if segment is None:
            return
        try:
            if finish:
                segment.finish()
        finally:
            self._closed += 0 if segment.deleted() else segment.kept
            segment.close()

    def _fail(self, why: str, now_s: float) -> None:
        self._retry_at = now_s + RETRY_S
        if self._segment:
            self._segment.give_up()
            if self._segment.broken:
                self._close_segment(finish=False)
        self._alarm = (
            f"log stopped: {self.folder}: {why}. Free or remount the disk: the log resumes by "
            "itself, the twin goes on without it"
        )
