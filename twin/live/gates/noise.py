"""Is an instrument much noisier than it used to be?

    d_k = y_k - (line between its two neighbours),    sigma^2 = -mean(d_k d_{k-1})

White noise of variance sigma^2 gives d's neighbours the covariance -sigma^2; what the ship or a wave does is
smooth from sample to sample, so its neighbours go the same way and it counts for nothing. What is usual is
the instrument's own, learned while the ship sails, noise and waves together:

    usual = mean |d_k d_{k-1}|/1.18             sigma^2 of white noise, more where the sea adds to it

Speed through water and speed over ground see the same motion of the ship, each with its own noise. So what
the sea has to do with the log's present roughness is the covariance with the receiver's b_k, made of its
values at the log's samples as d_k is of the log's:

    w = -mean (d_k b_{k-1} + b_k d_{k-1})/2     taken off sigma^2, never added

The receiver's noise has no part in it, for it knows nothing of the log's; a ship that comes beam on to the
sea moves both. A log without such a witness has its own past alone.

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
SEEN_TOO = {  # what else sees the same motion, but for a current, which changes slowly
    "surge_velocity_through_water_mps": "surge_velocity_mps",
    "sway_velocity_through_water_mps": "sway_velocity_mps",
}
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

    def feed(self, name: str, change: float, dt: float, seen_too: float | None = None) -> None:
        """The change of a channel since its sample before, which is dt seconds older; `seen_too`: what the
        channel of SEEN_TOO says at this sample."""
        if name not in self._of:
            return
        noise, instrument = self._of[name]
        noise.feed(change, dt, seen_too)
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

    __slots__ = (
        "_b",
        "_beside",
        "_count",
        "_d",
        "_grain",
        "_last",
        "_least",
        "_now",
        "_sea",
        "_usual",
        "loud",
        "restless",
    )

    def __init__(self, allowance: float):
        self.loud = self.restless = False  # far above its usual noise; somewhat
        self._least = LEAST_NOISE * allowance
        self._grain = allowance
        self._last: tuple[float, float] | None = None  # the last change, and over how long
        self._d = self._b = 0.0
        self._beside = 0.0, 0.0  # what else sees the same motion: its value, and its last change
        self._now = self._usual = self._sea = 0.0
        self._count = 0

    @property
    def weight(self) -> float:
        """The usual variance over the present one, at most 1."""
        return min(self._floor() / self._own(), 1.0) if self.loud else 1.0

    def feed(self, change: float, dt: float, seen_too: float | None = None) -> None:
        """The change since the sample before, which is dt seconds older, and the value beside it of what
        sees the same motion."""
        if change != 0.0:
            self._grain = min(self._grain, abs(change))
        before, self._last = self._last, (change, dt)
        if before is None or not 0.2 < dt / before[1] < 5.0:  # a hole: no line goes across it
            self._d = 0.0
            self._bend(seen_too, 1.0)
            self._b = 0.0
            return
        share = before[1] / (before[1] + dt)
        d = before[0] - (before[0] + change) * share
        both = -d * self._d
        if seen_too is not None:
            b_before, b = self._b, self._bend(seen_too, share)
            sea = -0.5 * (d * b_before + b * self._d)
            most = SAMPLE_LIMIT * self._floor()
            self._sea += (min(max(sea, -most), most) - self._sea) / min(self._count + 1, NOW)
        self._d = d
        if both != 0.0:
            self._judge(both)

    def _bend(self, seen_too: float | None, share: float) -> float:
        """b of what sees the same motion, as d is made of the samples."""
        if seen_too is None:
            return 0.0
        value, before = self._beside
        change = seen_too - value
        self._beside = seen_too, change
        self._b = before - (before + change) * share
        return self._b

    def _floor(self) -> float:
        least = max(self._least, self._grain)
        return max(self._usual, least * least)

    def _own(self) -> float:
        """The present variance less what the sea has to do with it."""
        return self._now - max(self._sea, 0.0)

    def _judge(self, both: float) -> None:
        self._count += 1
        known = self._count > ENOUGH
        most = SAMPLE_LIMIT * self._floor()
        seen = min(max(both, -most), most) if known else both
        self._now += (seen - self._now) / min(self._count, NOW)
        self.restless = known and self._now > QUIET * self._floor()
        noisy = self.restless and self._own() > QUIET * self._floor()
        self.loud = noisy and (self.loud or self._own() > LOUD * self._floor())
        pace = SLOWLY if noisy else 1.0
        self._usual += pace * (abs(seen) / WHITE - self._usual) / min(self._count, USUALLY)
