"""A recorded voyage at the pace somebody watches it: its speed, and pauses.

Ctrl-Z (SIGTSTP) pauses and goes on; so does the space bar where standard input is a terminal. There + and -
change the speed, q ends the voyage. Nothing waits in a thread: the clock asks while it waits for the next
instant."""

import os
import select
import signal
import sys
import termios
import time
import tty
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from twin.live.clock import LONGEST_SLEEP_S, Instant
from twin.num import as_given

SLICE_S = 0.05  # how soon a key or a signal is heard
SLOWEST, FASTEST = 0.1, 100.0  # times the voyage's own speed
KEYS = "space: pause, +/-: speed, q: end"


class Player:
    """How fast the voyage goes by, and whether it is paused or over."""

    def __init__(self, speed: float = 1.0, say: Callable[[str], None] = lambda text: None):
        self.speed, self.paused, self.over = speed, False, False
        self.say = say

    def pause(self, *_: Any) -> None:
        """Pauses, or goes on."""
        self.paused = not self.paused
        self.say("paused" if self.paused else "goes on")

    def key(self, pressed: str) -> None:
        """What a key means; any other means nothing."""
        if pressed == " ":
            self.pause()
        elif pressed in "+-" and pressed:
            self.speed = min(max(self.speed * (2.0 if pressed == "+" else 0.5), SLOWEST), FASTEST)
            self.say(f"{as_given(self.speed)} times as fast as the voyage")
        elif pressed == "q":
            self.over = True

    def listen(self, seconds: float) -> None:
        """Waits for a key at most so long."""
        if not self._hears:
            time.sleep(seconds)
        elif select.select([sys.stdin], [], [], seconds)[0]:
            pressed = os.read(sys.stdin.fileno(), 1).decode(errors="replace")
            self._hears = bool(pressed)
            self.key(pressed)

    _hears = False

    @contextmanager
    def attended(self) -> Iterator["Player"]:
        """With the signal, and with the keys where there is a terminal in the foreground."""
        before = signal.signal(signal.SIGTSTP, self.pause)
        self._hears = sys.stdin is not None and sys.stdin.isatty() and _in_front()
        kept = termios.tcgetattr(sys.stdin) if self._hears else None
        try:
            if kept:
                tty.setcbreak(sys.stdin)
            yield self
        finally:
            if kept:
                termios.tcsetattr(sys.stdin, termios.TCSADRAIN, kept)
            signal.signal(signal.SIGTSTP, before)


def _in_front() -> bool:
    """Whether keys come here: a process in the background would be stopped when it asks for them."""
    try:
        return os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except OSError:
        return False


class PacedClock:
    """The instants of a log at a player's pace; a hole longer than a minute is jumped over."""

    def __init__(self, times: Iterable[tuple[float, float]], player: Player):
        self._times, self.player = iter(times), player
        self._number = 0
        self._last_s: float | None = None  # of the voyage
        self._due_s = 0.0  # when the last instant was due [s, monotonic]

    def wait(self) -> Instant | None:
        """The voyage's next instant, at the pace asked for; None behind the last, or when it is told to
        end."""
        try:
            time_s, wall_s = next(self._times)
        except StopIteration:
            return None
        if not self._waited(time_s):
            return None
        instant = Instant(self._number, time_s, wall_s)
        self._number += 1
        return instant

    def slack_s(self) -> None:
        """None: a voyage has no deadlines."""
        return None

    def _waited(self, time_s: float) -> bool:
        """Until the instant is due; false when the voyage is over before."""
        player, ahead_s = self.player, time_s - (self._last_s if self._last_s is not None else time_s)
        now_s = time.monotonic()
        first = self._last_s is None or ahead_s > LONGEST_SLEEP_S
        self._last_s = time_s
        left_s = 0.0 if first else ahead_s - (now_s - self._due_s) * player.speed  # of the voyage
        while not player.over and (player.paused or left_s > 0.0):
            player.listen(SLICE_S if player.paused else min(SLICE_S, left_s / player.speed))
            before_s, now_s = now_s, time.monotonic()
            left_s -= 0.0 if player.paused else (now_s - before_s) * player.speed
        late_s = min(max(-left_s / player.speed, 0.0), 1.0)  # made up for, but no long pause is
        self._due_s = now_s - late_s
        return not player.over
