"""A sequential test: does a number that should stay where it is walk away?

    S+ = max(0, S+ + (x - mean)/scale - K),   S- = max(0, S- - (x - mean)/scale - K),   alarm at H

Page's cumulative sum (Page, Biometrika 41, 1954). A shift by d scales is found after about H/(d - K) blocks.
By Siegmund's approximation (Sequential Analysis, 1985, 2.5), independent normal blocks give a false alarm
once in exp(2 K (H + 1.17))/(4 K^2) blocks: 8e6, which is a year of blocks of 4 s. An alarm is over
once S has fallen to OVER H: that a shift of 2 K scales is gone is then exp(2 K (1 - OVER) H) = 8000 times as
likely as that it lasts. What speaks for a shift beyond H would only delay that, so S ends there. Mean and
scale are those of the ship's own healthy blocks, learned while the ship sails, the mean within `most`, the
scale not below `least`. What looks suspicious teaches little, so that a lie does not become the rule.
"""

from math import copysign, inf

K, H = 0.75, 10.0
OVER = 0.4  # share of H at which an alarm is over, and from which little is taught
WILD = 3.0  # usual deviations, as which a wilder one counts where it teaches
ENOUGH = 12  # blocks from which the scale is known
NO_NOISE_SCALES = 25.0  # scales that no noise reaches: one block is enough once the scale is known
FORGETS = 80.0  # blocks that mean and scale remember
NORMAL_SCALE = 1.25  # scale of a normal number over the mean of its size
SLOWLY = 0.1  # of the usual pace at which what is suspicious teaches


class Cusum:
    """Fed with one number a block; `alarm` says whether it has walked away."""

    __slots__ = ("_count", "_down", "_size", "_up", "alarm", "least", "mean", "most")

    def __init__(self, least: float, most: float = inf):
        self.least, self.most = least, most
        self.mean = 0.0
        self.alarm = False
        self._count = 0
        self._size = least / NORMAL_SCALE  # mean size of a deviation
        self._up = self._down = 0.0

    @property
    def scale(self) -> float:
        """The usual deviation of a block, never below `least`."""
        return max(NORMAL_SCALE * self._size, self.least)

    @property
    def calm(self) -> bool:
        """Whether nothing at all speaks for a shift."""
        return self._up == self._down == 0.0

    @property
    def suspicious(self) -> bool:
        """Whether so much speaks for a shift that little is taught."""
        return self.alarm or max(self._up, self._down) > OVER * H

    def usual(self, off: float) -> float:
        """A deviation as far as it may teach: one wild block counts as three usual ones."""
        wide = WILD * self.scale
        return min(max(off, -wide), wide)

    def feed(self, x: float, allowed: float = 0.0) -> bool:
        """One block, of which so much either way counts for nothing; whether there is an alarm."""
        off = x - self.mean
        z = copysign(max(abs(off) - allowed, 0.0), off) / self.scale
        sure = abs(z) > NO_NOISE_SCALES
        if self._count >= ENOUGH:
            step = min(max(z, -0.5 * H), 0.5 * H)
            self._up = min(max(self._up + step - K, 0.0), H)
            self._down = min(max(self._down - step - K, 0.0), H)
            worst = H if sure else max(self._up, self._down)
            if sure:
                self._up, self._down = (worst, 0.0) if z > 0.0 else (0.0, worst)
            self.alarm = worst >= (OVER * H if self.alarm else H)
        self._learn(x, self._count >= ENOUGH and 0.0 < allowed < abs(off))
        return self.alarm

    def _learn(self, x: float, odd: bool) -> None:
        """The mean and the usual deviation."""
        self._count += 1
        a = SLOWLY / FORGETS if odd or self.suspicious else 1.0 / min(self._count, FORGETS)
        off = self.usual(x - self.mean)
        self.mean = min(max(self.mean + a * off, -self.most), self.most)
        self._size += a * (abs(off) - self._size)
