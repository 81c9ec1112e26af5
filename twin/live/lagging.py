"""Whether the loop keeps its time: periods it had to skip lately, in words."""

from collections import deque

MEMORY_S = 60.0
NOTICE_S = 10.0  # how long a skip is still said


class Lagging:
    """Looks at the count of skipped periods once in a while."""

    def __init__(self, rate_hz: float):
        self._rate_hz = rate_hz
        self._looks: deque[tuple[float, int]] = deque()  # time, skipped since the start
        self._skipped_s = float("-inf")

    def look(self, now_s: float, overruns: int) -> str:
        """Why the loop is said to lag, "" when no period was skipped in the last ten seconds."""
        if self._looks and overruns > self._looks[-1][1]:  # what the start itself took is no lag
            self._skipped_s = now_s
        self._looks.append((now_s, overruns))
        while now_s - self._looks[0][0] > MEMORY_S:
            self._looks.popleft()
        if now_s - self._skipped_s >= NOTICE_S:
            return ""
        since_s, before = self._looks[0]
        seconds = max(now_s - since_s, 1.0)
        skipped = overruns - before
        share = f"{100.0 * skipped / (seconds * self._rate_hz):.1f} %"
        return (
            f"lagging: {skipped} periods skipped in the last {seconds:.0f} s ({share}). Is the machine "
            "too busy?"
        )
