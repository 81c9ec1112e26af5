"""Do the samples contradict the promised bound? Two tests, row by row.

    how often   the share of the last hundred accepted samples with |y - nu_hat| > E + n:  above a tenth
    how far     S = max(0, S + min(BEYOND z - BEYOND^2/2, LIMIT/2)):                       above LIMIT
                z = (|y - nu_hat| - E)/sigma

E: the greatest bound before a correction that the sample may be compared with; n: three deviations sigma of
    the instrument's noise.

Where a sample takes most of an error away, the first one that is wrong makes the next look right. So while
S > 0 a sample counts as no measurement (RolledTube), and the next is compared with where the estimate would
be without them: z = (|y - nu_hat + c| - (E - |c|))/sigma, c what they pulled it by, to first order.

The second is Page's test, accepted or not, of a noise that is BEYOND deviations off for good: where |e| <= E
and the noise is white and normal, a factor exp(S) has an expectation of at most one, so a false alarm comes
once in exp(LIMIT) samples or less often [Lorden 1971]. One sample alone, however wild, is for the gates. What
contradicts is either the estimate or the instrument, and till then has corrupted the other: so the answer
lasts until a minute has passed without, in which the parity test and the cross-checks have seen the new state
of things from end to end."""

from collections.abc import Sequence
from math import log

from twin.live.parity import WINDOW_S

MEMORY = 100.0  # samples over which it is counted how often they contradict the bound
SURPRISED = 0.1  # share of them from which it does not hold
DEVIATIONS = 3.0  # of an instrument's noise, which the certificate takes for its bound
BEYOND = 3.0  # deviations: as far beyond the bound as usual noise reaches
LIMIT = log(1e8)  # as many samples as three instruments give in 1000 h at 10 Hz

SPOKEN = {"u": "surge speed", "v": "sway speed", "r": "rate of turn"}  # rows of the estimate


class Contradiction:
    """Of one row."""

    def __init__(self) -> None:
        self._share = self._far = self._off = 0.0
        self._until_s = float("-inf")

    def feed(self, gap: float, most: float, noise: float, accepted: bool) -> None:
        """One tick's sample: its distance from the estimate, the bound E, the noise n."""
        if accepted and (self._share or abs(gap) > most + noise):
            self._share += ((abs(gap) > most + noise) - self._share) / MEMORY

    @property
    def suspects(self) -> bool:
        """Whether the last samples were farther off than usual noise explains."""
        return self._far > 0.0

    def fresh(self, gap: float, most: float, noise: float, now_s: float, uncounted: float = 0.0) -> None:
        """A sample that was not there before. `uncounted`: what it moved the estimate by without counting as
        a measurement (0: it did count, or that is not known); E of the next contains it."""
        off, self._off = self._off, self._off + uncounted
        z = DEVIATIONS * (abs(gap + off) - (most - abs(off))) / noise
        self._far = max(self._far + min(BEYOND * z - 0.5 * BEYOND * BEYOND, 0.5 * LIMIT), 0.0)
        if self._far >= LIMIT:
            self._far, self._until_s = LIMIT, now_s + WINDOW_S
        if not self._far or not uncounted:
            self._off = 0.0

    def at(self, now_s: float) -> bool:
        """Whether the bound is contradicted."""
        return self._share > SURPRISED or now_s < self._until_s


def contradicted(rows: Sequence[str], tests: Sequence[Contradiction], now_s: float) -> str:
    """Which row of the estimate is, in words; "" when none is."""
    for row, test in zip(rows, tests, strict=True):
        if test.at(now_s):
            return f"{SPOKEN[row]} is measured farther from the estimate than its bound allows"
    return ""
