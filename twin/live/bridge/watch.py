"""Looks on: takes what a feed gives, keeps what a single tick does not hold, and makes the frames that all
viewers get."""

import json
import time
from collections import deque
from collections.abc import Callable
from threading import Condition
from typing import Any

from twin.live.bridge.alarms import Alarms
from twin.live.bridge.feed import About, BridgeFeed
from twin.live.bridge.scene import SILENT_S, Ahead, largest_of, scene

RATE_HZ = 10.0
TRAIL_S, TRAIL_POINTS = 5.0, 120  # between two points of the way behind, and how many


class BridgeWatch:
    """`step` each tenth of a second; `frame` is the newest picture, `trail` the way behind."""

    def __init__(self, feed: BridgeFeed, fallback: About | None = None):
        self.feed, self.fallback = feed, fallback or About()
        self.alarms = Alarms()
        self.frame: dict[str, Any] = {}
        self.number = 0
        self.trail: deque[tuple[float, float]] = deque(maxlen=TRAIL_POINTS)
        self.trail_number = 0
        self._changed = Condition()
        self._tick: Any = None
        self._ahead: Ahead | None = None
        self._heard_s: float | None = None
        self._began_s: float | None = None
        self._trail_s = -TRAIL_S
        self._largest = (0.0, 0.0)
        self._text = ""

    def step(self, now_s: float) -> dict[str, Any]:
        """Takes what came in, and makes the next frame."""
        self._began_s = now_s if self._began_s is None else self._began_s
        for tick in self.feed.poll(now_s):
            self._take(tick, now_s)
        with self._changed:
            self.frame = self._made(now_s)
            self._text = json.dumps(self.frame, allow_nan=False, separators=(",", ":"))
            self.number += 1
            self._changed.notify_all()
        return self.frame

    def run(self, wanted: Callable[[], bool]) -> None:
        """Ten steps a second by absolute deadlines while it is wanted; what was missed is not made up."""
        due_s = time.monotonic()
        while wanted():
            self.step(time.monotonic())
            due_s = max(due_s + 1.0 / RATE_HZ, time.monotonic())
            time.sleep(max(due_s - time.monotonic(), 0.0))

    def newer(self, number: int, wait_s: float) -> tuple[int, str] | None:
        """The number and text of a frame that comes after `number`; None when none comes in that time."""
        with self._changed:
            self._changed.wait_for(lambda: self.number > number, wait_s)
            return (self.number, self._text) if self.number > number else None

    def acknowledge(self, key: str) -> bool:
        """Acknowledge an alarm by its key; whether there is such an alarm."""
        with self._changed:
            return self.alarms.acknowledge(key)

    def _take(self, tick: Any, now_s: float) -> None:
        if self._tick is not None and tick.time_s < self._tick.time_s:
            self._ahead, self._trail_s = None, -TRAIL_S  # another voyage, or a twin that began anew
            self.trail.clear()
        self._tick, self._heard_s = tick, now_s
        if tick.predictions and tick.estimate.HasField("north_m"):
            self._ahead = Ahead(tick, tick.time_s)
        self._largest = largest_of(tick, self._largest)
        with self._changed:
            self.alarms.observe(tick.reasons, now_s, tick.wall_s)
        if tick.estimate.HasField("north_m") and abs(tick.time_s - self._trail_s) >= TRAIL_S:
            self.trail.append((round(tick.estimate.north_m, 1), round(tick.estimate.east_m, 1)))
            self._trail_s, self.trail_number = tick.time_s, self.trail_number + 1

    def _made(self, now_s: float) -> dict[str, Any]:
        since_s = self._heard_s if self._heard_s is not None else self._began_s
        silent_s = now_s - since_s if since_s is not None else 0.0
        feed = {
            "name": self.feed.name,
            "over": self.feed.over,
            "heard": self._tick is not None,
            "silent_s": round(silent_s, 1),
            "silent": silent_s > SILENT_S or self._tick is None,
        }
        if self._tick is None:
            return {"feed": feed, "ship": self.about._asdict(), "alarms": []}
        since_s = silent_s if feed["silent"] else 0.0
        picture = scene(self._tick, self.about, self._ahead, self._largest, since_s)
        return {"feed": feed, **picture, "alarms": self.alarms.listed()}

    @property
    def about(self) -> About:
        """Who speaks, with the size from the ship file where the twin does not say it."""
        said, file = self.feed.about, self.fallback
        return said._replace(
            ship=said.ship or file.ship,
            length_m=said.length_m or file.length_m,
            beam_m=said.beam_m or file.beam_m,
        )
