"""Has an instrument stopped measuring? The same value again and again, with fresh stamps, while the ship
moves.

Two kinds of evidence. A channel with noise hardly ever repeats a value: if its usual change is far above its
grain (the smallest change it ever showed) and it repeats for `patience_s`, it is frozen. A channel with
coarse steps may repeat; it is frozen when the ship's own motion says that it should have moved by several
grains.
"""

from math import inf

NOISY = 20.0  # the usual change of a noisy channel, in grains
RARE = 0.05  # share of changes that come after a repeat, above which repeats are nothing unusual
MOVED = 5.0  # how many grains it should have moved


class Frozen:
    """The memory of one channel; `repeats(...)` is asked for each good sample."""

    __slots__ = (
        "_change",
        "_grain",
        "_last",
        "_moved",
        "_noisy",
        "_repeating",
        "_repeats",
        "_since",
        "_t",
        "least",
        "patience_s",
        "wraps",
    )

    def __init__(self, patience_s: float = 4.0, least: float = inf, wraps: float = 0.0):
        # `least`: the smallest motion that counts, border units; `wraps`: period of an angle, as in Channel
        self.patience_s, self.least, self.wraps = patience_s, least, wraps
        self._last: float | None = None
        self._t = 0.0
        self._grain, self._change, self._repeating = inf, 0.0, 0.0
        self._since, self._moved, self._repeats, self._noisy = 0.0, 0.0, 0, False

    def stuck(self, value: float, t: float, rate: float) -> bool:
        """Whether this sample shows a frozen instrument; `rate`: how the ship's motion changes it
        [unit/s]."""
        change, self._last = (abs(value - self._last) if self._last is not None else 0.0), value
        if self.wraps and change > 0.5 * self.wraps:  # 359.9 to 0.1 deg: the short way round
            change = abs((change + 0.5 * self.wraps) % self.wraps - 0.5 * self.wraps)
        dt, self._t = min(t - self._t, 5.0), t
        if change > 0.0 or self._change == 0.0:
            self._moves(change)
            return False
        if self._repeats == 0:
            noisy = self._change > NOISY * self._grain and self._repeating < RARE
            self._since, self._noisy = t - dt, noisy
        self._repeats += 1
        self._moved += rate * dt
        if self._repeats < 4 or t - self._since < self.patience_s:
            return False
        return self._noisy or abs(self._moved) > max(MOVED * self._grain, self.least)

    def _moves(self, change: float) -> None:
        """Learn from a change what is usual here: how large, how small at least, how often after a repeat."""
        self._repeating += 0.01 * ((self._repeats > 0) - self._repeating)
        self._repeats, self._moved = 0, 0.0
        self._grain = min(self._grain, change or inf)
        self._change += 0.2 * (change - self._change)
