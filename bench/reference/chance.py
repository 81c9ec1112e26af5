"""Random numbers of a fleet: each ship draws from its own seed, whatever ships sail beside it."""

import numpy as np

CHUNK = 512


class Chance:
    """White normal numbers (k, B) for tick 0, 1, 2 ..., 512 ticks at a time from each ship's generator."""

    def __init__(self, seeds, stream, k):
        self.k, self.generators = k, [np.random.default_rng([seed, stream]) for seed in seeds]
        self.chunk, self.numbers = -1, None

    def at(self, tick):
        while self.chunk < tick // CHUNK:
            self.numbers = np.stack([g.standard_normal((CHUNK, self.k)) for g in self.generators], 2)
            self.chunk += 1
        return self.numbers[tick % CHUNK]


class Wander:
    """Ornstein-Uhlenbeck processes of unit variance and given correlation times, each row (B,)."""

    def __init__(self, seeds, times, dt):
        self.keep = np.exp(-dt / np.asarray(times, float))
        self.kick = np.sqrt(1 - self.keep**2)
        self.chance = Chance(seeds, 1, len(self.keep))
        self.value = np.stack(
            [np.random.default_rng([seed, 2]).standard_normal(len(self.keep)) for seed in seeds], 1
        )

    def step(self, tick):
        self.value = self.keep * self.value + self.kick * self.chance.at(tick)
        return self.value
