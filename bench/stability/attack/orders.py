"""What the adversary of each run orders: where it begins, which way all pushes, how old samples are."""

from dataclasses import dataclass, fields, replace

import numpy as np

from bench.stability.attack.cases import Group
from twin.live.certificate.certificate import Certificate

PLACES = ("u", "v", "r", "delta", "n", "delta", "n")  # motion through the water, first and second orders
MOST_AGES = 4  # different ages that are tried


@dataclass(frozen=True)
class Orders:
    """N runs of K ticks. Rows of four: u, v, r, psi.

    place (7, N): share of its range at which each of PLACES lies; turn (N,): the tick of the second orders;
    share (N,): of the force that is the ship's, the rest is the hostile network's; start (4, N), force (K, 3,
    N), noise (K, 4, N): -1 to 1, of the limit; age (K, 4, N): of the sample that counts, in samples; axis,
    side (N,): the error that is to become great, and to which side."""

    place: np.ndarray
    psi: np.ndarray
    turn: np.ndarray
    share: np.ndarray
    start: np.ndarray
    force: np.ndarray
    noise: np.ndarray
    age: np.ndarray
    axis: np.ndarray
    side: np.ndarray

    def of(self, runs: np.ndarray) -> "Orders":
        """Those of these runs."""
        return Orders(*(getattr(self, f.name)[..., runs] for f in fields(self)))

    def moved(self, rng: np.random.Generator, by: float, which: np.ndarray) -> "Orders":
        """Other places for some of the runs, `by` of the range away, and the rest as it was."""
        place = self.place + np.where(which, by * rng.normal(size=self.place.shape), 0.0)
        psi = self.psi + np.where(which, np.pi * by * rng.normal(size=self.psi.shape), 0.0)
        turn = self.turn + np.where(which, by * len(self.force) * rng.normal(size=self.turn.shape), 0.0)
        return replace(self, place=np.clip(place, 0.01, 0.99), psi=psi, turn=turn)


def ages_of(c: Certificate, group: Group) -> np.ndarray:
    """The ages that an adversary of this group may choose from, in samples, by halves inside."""
    most = max(c.delays) * group.delay + hidden_age(c, group)
    grid = np.linspace(0.0, most, MOST_AGES)
    return np.unique(np.append(np.floor(2.0 * grid) / 2.0, most))


def hidden_age(c: Certificate, group: Group) -> float:
    """By how much a sample is older than is allowed, in samples."""
    return (group.excess.delay - 1.0) * max(*c.delays, 1)


def random_orders(
    c: Certificate, groups: list[Group], runs: int, ticks: int, rng: np.random.Generator
) -> Orders:
    """So many runs of each group, group after group: places all over the set, half of each on its ends;
    forces and errors somewhere in their range that stay there for a random while."""
    n = runs * len(groups)
    place = rng.random((len(PLACES), n))
    place = np.where(rng.random(place.shape) < 0.5, np.round(place), place)
    age = np.empty((ticks, 4, n))
    for i, group in enumerate(groups):
        of = slice(i * runs, (i + 1) * runs)
        grid = ages_of(c, group)
        if c.inner > 1:  # each row's samples are all of one age
            age[:, :, of] = grid[-1] * np.array(group.ages)[:, None] / (group.delay or 1.0)
        else:
            age[:, :, of] = rng.choice(grid, (ticks, 4, runs))
    k = np.arange(n)
    return Orders(
        place=np.clip(place, 0.01, 0.99),
        psi=rng.uniform(-np.pi, np.pi, n),
        turn=rng.uniform(0.0, ticks, n),
        share=np.round(rng.random(n)),
        start=rng.uniform(-1.0, 1.0, (4, n)),
        force=_held(rng, (ticks, 3, n)),
        noise=_held(rng, (ticks, 4, n)),
        age=age,
        axis=k % 3,
        side=np.where(k // 3 % 2, 1.0, -1.0),
    )


def _held(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """Between minus and plus one, changing at random, seldom in some runs and in each tick in others."""
    often = rng.uniform(0.0, 1.0, (1, *shape[1:])) ** 2
    changed = np.where(rng.random(shape) < often, np.arange(shape[0])[:, None, None], 0)
    last = np.maximum.accumulate(changed, axis=0)
    return np.take_along_axis(rng.uniform(-1.0, 1.0, shape), last, axis=0)
