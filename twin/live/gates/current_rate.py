"""How fast does the current change? Learned from the ship's own record, so that eddies are no fault.

    c_k = c_{k-1} + w,  y_k = c_k + e           a current that wanders, seen through block means
    q = var w = (mean |y_k - y_{k-n}|^2 - mean |y_k - y_{k-1}|^2)/(2 (n - 1))
    g = P/(P + R),  P = (q + sqrt(q^2 + 4 q R))/2

The steady Kalman gain g of the local level model (Harvey, Forecasting, structural time series models and the
Kalman filter, 1989, 4.1) leaves innovations that do not follow from each other, as Page's test assumes; the
mean of ten minutes, in a current that changes within ten minutes, leaves some that all go the same way.
"""

from collections import deque
from math import sqrt

from twin.live.gates.cusum import ENOUGH, SLOWLY, WILD

BLOCKS_APART = 6  # blocks between the two whose difference tells of the current, n
REMEMBERED = 360.0  # blocks: an hour, for a current's unrest is a matter of tides and places


class CurrentRate:
    """Fed with each block's current; `gain` is the share of what is new that belongs to the current."""

    __slots__ = ("_blocks", "_count", "_far", "_near")

    def __init__(self) -> None:
        self._blocks: deque[tuple[float, float]] = deque(maxlen=BLOCKS_APART)
        self._count = 0
        self._near = self._far = 0.0  # mean squares of the differences to the last block and the n-th before

    @property
    def variance(self) -> float:
        """By which the current's components each change from block to block [m2/s2]."""
        return max(self._far - self._near, 0.0) / (2.0 * (BLOCKS_APART - 1))

    def gain(self, scale: float) -> float:
        """`scale`: the usual deviation of a block [m/s]; 0 until as many blocks are known as a test needs."""
        if self._count < ENOUGH - BLOCKS_APART:
            return 0.0
        q, noise = self.variance, scale * scale
        prior = 0.5 * (q + sqrt(q * q + 4.0 * q * noise))
        return prior / (prior + noise)

    def feed(self, north: float, east: float, scale: float, suspicious: bool) -> None:
        """One block's current [m/s]; a suspicious one teaches little, a wild one as three usual ones."""
        blocks = self._blocks
        if len(blocks) == BLOCKS_APART:
            self._count += 1
            a = (SLOWLY if suspicious else 1.0) / min(self._count, REMEMBERED)
            most = WILD * WILD * max(self._far, 2.0 * scale * scale / BLOCKS_APART)
            near, far = (min((north - y[0]) ** 2 + (east - y[1]) ** 2, most) for y in (blocks[-1], blocks[0]))
            self._near += a * (near - self._near)
            self._far += a * (far - self._far)
        blocks.append((north, east))
