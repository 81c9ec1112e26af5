"""Is an instrument much noisier than it used to be?

    d_k = y_k - (line between its two neighbours),    sigma^2 = -mean(d_k d_{k-1})

White noise of variance sigma^2 gives d's neighbours the covariance -sigma^2; what the ship or a wave does is
smooth from sample to sample, so its neighbours go the same way and it counts for nothing. What is usual is
the instrument's own, learned while the ship sails, noise and waves together:

    usual = mean |d_k d_{k-1}|/1.18             sigma^2 of white noise, more where the sea adds to it

A short wave on a slow instrument goes to and fro between samples on one heading and smoothly on the next:
its signed mean may be near nought, or below, while it is as rough as ever. Waves too short for a slow
instrument look like noise of all instruments: one that is loud is believed to be so only while the others
are not.
"""

from collections.abc import Mapping

NOW, USUALLY = 16, 600  # samples that either mean remembers
ENOUGH = 50  # samples from which the usual is known
LOUD, QUIET = 16.0, 6.0  # times the usual variance: said above the first, until below the second
SAMPLE_LIMIT = 4.0 * LOUD  # one sample counts no more than that: a spike is not noise
SLOWLY = 0.1  # of the usual pace at which a loud channel teaches
WHITE = 1.18  # mean |d_k d_{k-1}|/sigma^2 of white noise: (3/pi)(sqrt(1 - c^2) + c asin c), c = 2/3
LEAST_NOISE = 0.01  # of what noise may add to a change (Gate.allowance): noise below it does not matter


INSTRUMENTS = (  # what one instrument measures; the sea moves all of them at once
    ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps"),
    ("heading_true_north_deg", "yaw_rate_degps", "roll_deg"),
    ("surge_velocity_through_water_mps", "sway_velocity_through_water_mps"),
)
WITNESSES = ("roll_deg",)  # tells of the sea; its own noise matters to nothing


class NoiseWatch:
    """The channels of one ship; `loud` are those that are far noisier than they were while no other
    instrument is restless, and what a sample of each is worth now."""

    def __init__(self, allowances: Mapping[str, float]):
        self.loud: dict[str, float] = {}
        self._of = {
            name: (Noise(allowances[name]), instrument) for instrument in INSTRUMENTS for name in instrument
        }
        self._restless: set[str] = set()

    def feed(self, name: str, change: float, dt: float) -> None:
        """The change of a channel since its sample before, which is dt seconds older."""
        if name not in self._of:
            return
        noise, instrument = self._of[name]
        noise.feed(change, dt)
        (self._restless.add if noise.restless else self._restless.discard)(name)
        if noise.loud and name not in WITNESSES and not self._restless.difference(instrument):
            self.loud[name] = noise.weight
        else:
            self.loud.pop(name, None)

    def lose(self, name: str) -> None:
        """Nothing comes from this channel any more."""
        self._restless.discard(name)
        self.loud.pop(name, None)


class Noise:
    """Fed with each good sample of one channel; `weight` is what a sample is worth now, 1 unless loud."""

    __slots__ = ("_count", "_d", "_grain", "_last", "_least", "_now", "_usual", "loud", "restless")

    def __init__(self, allowance: float):
        self.loud = self.restless = False  # far above its usual noise; somewhat
        self._least = LEAST_NOISE * allowance
        self._grain = allowance
        self._last: tuple[float, float] | None = None  # the last change, and over how long
        self._d = 0.0
        self._now = self._usual = 0.0
        self._count = 0

    @property
    def weight(self) -> float:
        """The usual variance over the present one, at most 1."""
        return min(self._floor() / self._now, 1.0) if self.loud else 1.0

    def feed(self, change: float, dt: float) -> None:
        """The change since the sample before, which is dt seconds older."""
        if change != 0.0:
            self._grain = min(self._grain, abs(change))
        before, self._last = self._last, (change, dt)
        if before is None or not 0.2 < dt / before[1] < 5.0:  # a hole: no line goes across it
            self._d = 0.0
            return
        d = before[0] - (before[0] + change) * before[1] / (before[1] + dt)
        both, self._d = -d * self._d, d
        if both != 0.0:
            self._judge(both)

    def _floor(self) -> float:
        least = max(self._least, self._grain)
        return max(self._usual, least * least)

    def _judge(self, both: float) -> None:
        self._count += 1
        known = self._count > ENOUGH
        most = SAMPLE_LIMIT * self._floor()
        seen = min(max(both, -most), most) if known else both
        self._now += (seen - self._now) / min(self._count, NOW)
        self.restless = known and self._now > QUIET * self._floor()
        self.loud = self.restless and (self.loud or self._now > LOUD * self._floor())
        pace = SLOWLY if self.restless else 1.0
        self._usual += pace * (abs(seen) / WHITE - self._usual) / min(self._count, USUALLY)
