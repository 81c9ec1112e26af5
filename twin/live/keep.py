"""Small files written by a thread of their own, whole or not at all: the loop never waits for the disk."""

import os
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread


class Keeper:
    """`put` a text; the newest one is written aside, synced and renamed."""

    def __init__(self, path: str | Path):
        self.path = Path(path)
        self.failed = ""  # why the last write did not succeed
        self._queue: SimpleQueue[str | None] = SimpleQueue()
        self._thread = Thread(target=self._run, name="keeper", daemon=True)
        self._thread.start()

    def put(self, text: str) -> None:
        """Have this text written next; never waits."""
        self._queue.put(text)

    def close(self, timeout_s: float = 1.0) -> None:
        """Writes what is waiting and stops; gives up waiting after `timeout_s`."""
        self._queue.put(None)
        self._thread.join(timeout_s)

    def _run(self) -> None:
        while (text := self._queue.get()) is not None:
            last = False
            with suppress(Empty):  # only the newest matters
                while (newer := self._queue.get_nowait()) is not None:
                    text = newer
                last = True
            self._write(text)
            if last:
                return

    def _write(self, text: str) -> None:
        aside = self.path.with_name(f".{self.path.name}.part")
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with open(aside, "w", encoding="utf-8") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            os.replace(aside, self.path)
            self.failed = ""
        except OSError as error:
            self.failed = f"{self.path}: learned numbers cannot be kept ({error.strerror})"
