"""Shocks of one kind on several services at once, each in a folder of its own; what was tried is kept on
file."""

import json
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from bench import bench_output
from bench.endurance.killed_service import ServiceFolder
from bench.endurance.shocks import Keep, Killed, Shocked, clocks, kills, pauses

Tried = Callable[[ServiceFolder, Iterator[int], Keep], tuple[int, int]]
KINDS_OF_SHOCK: dict[str, tuple[Tried, type[Any]]] = {
    "kills": (kills, Killed),
    "pauses": (pauses, Shocked),
    "clocks": (clocks, Shocked),
}


class ShocksKept(NamedTuple):
    """What became of each shock, in their order; and of all runs how many log files were whole (kills) or
    processes ended with 0 when told to, of how many."""

    shocks: list[Any]
    good: int
    ended: int


class ShockFile:
    """One line a shock, and one for each service that came to its end."""

    def __init__(self, folder: Path, kind: str):
        folder.mkdir(exist_ok=True)
        self.path, self.kind, self._lock = folder / f"{kind}.jsonl", kind, threading.Lock()

    def lines(self) -> list[dict[str, Any]]:
        return [json.loads(line) for line in self.path.read_text().splitlines()] if self.path.exists() else []

    def add(self, line: dict[str, Any]) -> None:
        with self._lock, open(self.path, "a") as file:
            file.write(json.dumps(line) + "\n")

    def keep(self, k: int, found: Any) -> None:
        self.add({"k": k, **found._asdict()})
        bench_output.tell(f"{self.kind} {k + 1}: {found}")

    def all_kept(self, count: int) -> ShocksKept:
        shock, lines = KINDS_OF_SHOCK[self.kind][1], self.lines()
        made = {line.pop("k"): shock(**line) for line in lines if "k" in line}
        ends = [line for line in lines if "good" in line]
        shocks = [made[k] for k in sorted(made) if k < count]
        return ShocksKept(shocks, sum(end["good"] for end in ends), sum(end["ended"] for end in ends))


def shocked(kind: str, count: int, at_once: int, hull: str, kept: Path) -> ShocksKept:
    """The shocks 0 to count - 1 that are not on file, then all that are."""
    file = ShockFile(kept, kind)
    done = {line.get("k") for line in file.lines()}
    left = [k for k in range(count) if k not in done]
    numbers, lock = iter(left), threading.Lock()

    def taken() -> Iterator[int]:
        while True:
            with lock:
                k = next(numbers, None)
            if k is None:
                return
            yield k

    def sail() -> None:
        with TemporaryDirectory() as folder:
            place = ServiceFolder(Path(folder), hull)
            try:
                good, ended = KINDS_OF_SHOCK[kind][0](place, taken(), file.keep)
                file.add({"good": good, "ended": ended})
            finally:
                place.close()

    with ThreadPoolExecutor(at_once) as pool:
        for future in [pool.submit(sail) for _ in range(min(at_once, len(left)))]:
            future.result()
    return file.all_kept(count)
