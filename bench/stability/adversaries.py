"""Ten thousand ships try to break the stabilizer's certificate: `twin-bench stability`.

Truth is the ship's own equations with a bounded force added, integrated twice as finely; the observer sees
late, noisy, missing measurements and a hostile network. Disturbance, noise and network are chosen against it
(along its error, held in one corner, square waves, white), all within their bounds. A run that leaves the
operating set is judged until it leaves, and counted. Beside them a few of the twin's own loops
(stability_loop.py)."""

import argparse
import time
from collections import deque
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from bench import answer
from bench.options import positive
from twin.errors import ThresholdError
from twin.live.certificate import certificate as cert
from twin.live.certificate import comparison as c3
from twin.live.certificate.certificate import Certificate, Confined
from twin.live.certificate.tube import look_back
from twin.live.learning.movable import Movable, movable, moved
from twin.physics import core
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Force, Situation
from twin.recording.jsonable import plain

NOISE = {
    "kvlcc2": (0.15, 0.15, 0.0005),
    "container": (0.15, 0.15, 0.0006),
    "usv": (0.06, 0.06, 0.008),
}  # three sigma of usual sensors
HEADING_NOISE = 0.005  # rad


class AdversaryCase(NamedTuple):
    """One line of the table: which ship, how often, how late, in what sea, how many runs."""

    ship: str
    rate_hz: float
    delays: tuple[int, int, int]  # oldest measurement of u, v, r, in samples
    runs: int
    H_s: float = 0.0
    dropouts: bool = False
    K: float | None = None  # 1/s; None: `usual_gain`
    # effects whose numbers an adversary moves in their boxes, and the wind's, as adaptation might
    moving: tuple[str, ...] = ()


CASES = (
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 3000),
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 1000, H_s=2.0),
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 1500, dropouts=True),
    AdversaryCase("kvlcc2", 10.0, (12, 12, 1), 500),
    AdversaryCase("kvlcc2", 50.0, (1, 1, 1), 500),
    AdversaryCase("container", 10.0, (1, 1, 1), 1500),
    AdversaryCase("container", 10.0, (1, 1, 1), 500, dropouts=True),
    AdversaryCase("usv", 50.0, (1, 1, 1), 500),
    AdversaryCase("usv", 50.0, (0, 0, 0), 500, dropouts=True),
    AdversaryCase("usv", 10.0, (0, 0, 0), 500),
    AdversaryCase("kvlcc2", 10.0, (1, 1, 1), 1000, moving=("RudderWear", "HullFouling")),
    AdversaryCase("container", 10.0, (1, 1, 1), 500, moving=("RudderWear", "Loading")),
)


@dataclass(frozen=True)
class AdversaryOutcome:
    """What became of the runs of a case; ratios are error over bound, by axis (surge, sway, yaw)."""

    runs: int
    left: int
    steps: int
    samples: int  # inside the operating set, of runs x steps
    violations: int
    of_tube: tuple[float, ...]
    of_bound: tuple[float, ...]
    error: tuple[float, ...]
    seconds: float


def certified(case: AdversaryCase) -> tuple[Model, Certificate]:
    """The model of a case, with wind and a current, and its certificate."""
    model = Model.of(load(case.ship))
    U = model.ship.U_0
    model = model.but(
        find("Wind").plausible(model.ship),
        find("Current").plausible(model.ship).but(north=0.12 * U, east=-0.08 * U),
        *(find(name).plausible(model.ship) for name in case.moving),
    )
    h = 1.0 / case.rate_hz
    plant = cert.plant_of(
        model, cert.of_ship(model), h, movable(model.effects, model.ship) if case.moving else ()
    )
    # if none holds, the certificate says so
    K = case.K or cert.usual_gain(plant, case.delays) or 1.0 / model.ship.scale("time")
    return model, cert.certify(
        model, K, h, case.delays, NOISE[case.ship], heading_noise=HEADING_NOISE, adapted=bool(case.moving)
    )


class AdversaryFleet:
    """Many ships of one kind at once, each with an observer and an adversary of its own."""

    def __init__(
        self,
        model: Model,
        c: Certificate,
        runs: int,
        seed: int,
        H_s: float = 0.0,
        dropouts: bool = False,
        moving: bool = False,
    ) -> None:
        self.c, self.runs, self.rng, self.h = c, runs, np.random.default_rng(seed), c.h
        self.H_s, self.dropouts = H_s, dropouts
        self.numbers = movable(model.effects, model.ship) if moving else ()
        self.time = model.ship.scale("time")  # L/U_0 [s]
        self.limit = np.array(c.disturbance.at(H_s))[:, None]
        self.stated = c.disturbance.noise(c.noise, H_s)
        self.noise = np.array(self.stated)[:, None]
        self.heading_noise = c.disturbance.heading_noise(HEADING_NOISE, H_s)
        self.inverse = np.array([core.accelerations(*row, model.c) for row in c3.IDENTITY]).T  # M^-1
        self.true = replace(model, residual=lambda s: Force(*self.push))
        self.twin = Confined.to(replace(model, residual=lambda s: Force(*self.learned)), c.operating)
        self._start()

    def _start(self) -> None:
        n, rng, ranges = self.runs, self.rng, self.c.operating.ranges
        through = [rng.uniform(*_inner(ranges[a], s), n) for a, s in (("u", 0.5), ("v", 0.2), ("r", 0.2))]
        zero, psi = np.zeros(n), rng.uniform(-np.pi, np.pi, n)
        w = self.true.water(Situation(psi=psi))
        nu = np.array([through[0] + w.u, through[1] + w.v, through[2]])
        self.truth = (zero, zero, psi, *nu)
        self.estimate = nu + self.noise * rng.uniform(-1, 1, (3, n))
        self.past = deque(maxlen=self.c.delay_samples + 1)
        self.tube = np.repeat(np.array(self.stated)[:, None], n, axis=1)
        window = look_back(self.c.delay_samples)
        self.before, self.after = deque([self.tube], maxlen=window), deque([self.tube], maxlen=window)
        self.alive = np.ones(n, bool)
        self.policy = rng.integers(0, 4, n)
        self.corner = rng.choice([-1.0, 1.0], (3, n))
        self.period = self.time * rng.uniform(0.05, 2.0, n)
        self.share = rng.random(n)  # of the disturbance that is the ship's; the rest is the hostile network's
        self.gentle = rng.uniform(0.1, 1.0, n)
        self.silent = np.zeros((3, n))  # samples for which a row stays silent
        # the end of its box at which each number is held
        self.held = rng.integers(0, 2, (len(self.numbers), n))
        self._helm()

    def _helm(self) -> None:
        """New orders and new weather for some of the ships, within the operating set."""
        n, rng, ranges = self.runs, self.rng, self.c.operating.ranges
        ahead = ranges["n"][1] / 1.25
        fresh = {
            "delta": self.gentle * rng.uniform(*ranges["delta"], n),
            "n": ahead * np.minimum(rng.uniform(0.5, 1.2, n), 1.25),
            "wind_speed": self.gentle * rng.uniform(*ranges["wind_speed"], n),
            "wind_to": rng.uniform(-np.pi, np.pi, n),
        }
        change = rng.random(n) < (1.0 if not hasattr(self, "inputs") else self.h / (0.5 * self.time))
        self.inputs = {k: np.where(change, x, getattr(self, "inputs", fresh)[k]) for k, x in fresh.items()}

    def _against(self, k: int) -> np.ndarray:
        """(3, runs) the direction in which the adversary drives the error."""
        error = np.sign(self.estimate - np.array(self.truth[3:]))
        square = self.corner * np.sign(np.sin(2 * np.pi * k * self.h / self.period))
        white = self.rng.uniform(-1, 1, (3, self.runs))
        return np.choose(self.policy, [error, self.corner, square, white])

    def _twin(self, k: int, before: tuple[Any, ...], side: np.ndarray) -> Confined:
        """What the observer integrates: the ship's equations, with every number of its effects where the
        adversary wants it."""
        if not self.numbers:
            return self.twin
        worst = [self._worse(i, before, side) for i in range(len(self.numbers))]
        square = (self.held + (np.sin(2 * np.pi * k * self.h / self.period) > 0.0)) % 2
        share = np.choose(self.policy, [worst, self.held, square, self.rng.random(self.held.shape)])
        return self._with(
            self.numbers, [m.low + x * (m.high - m.low) for m, x in zip(self.numbers, share, strict=True)]
        )

    def _worse(self, i: int, before: tuple[Any, ...], side: np.ndarray) -> np.ndarray:
        """(runs,) 1 where the upper end of a number's box drives the error further than the lower one, else
        0."""
        m, weight = self.numbers[i], side / np.array(self.c.bound)[:, None]
        low, high = (
            np.array(self._with((m,), [x]).step(before, Situation(**self.inputs), self.h)[3:])
            for x in (m.low, m.high)
        )
        return ((weight * (high - low)).sum(0) > 0.0).astype(int)

    def _with(self, numbers: Sequence[Movable], values: Sequence[object]) -> Confined:
        return replace(self.twin, effects=moved(self.twin.effects, numbers, values))

    def _received(self) -> np.ndarray:
        """(3, runs) which rows were measured: all, or one in ten lost and now and then all of an axis for a
        while.
        """
        if not self.dropouts:
            return np.ones((3, self.runs), bool)
        burst = self.rng.random((3, self.runs)) < self.h / (2.0 * self.time)
        length = self.time * self.rng.uniform(0.02, 0.3, (3, self.runs)) / self.h
        self.silent = np.where(burst, length, self.silent - 1.0)
        return (self.rng.random((3, self.runs)) > 0.1) & (self.silent <= 0.0)

    def step(self, k: int) -> np.ndarray:
        """One tick of all ships: truth, prediction, correction; (3, runs) the error after it."""
        self._helm()
        side = self._against(k)
        force = np.sign(self.inverse.T @ (side / np.array(self.c.bound)[:, None])) * self.limit
        self.push, self.learned = -self.share * force, (1.0 - self.share) * force
        heading = self.truth[2] + self.heading_noise * side[2]
        before = (0.0, 0.0, heading, *self.estimate)
        self.estimate = np.array(
            self._twin(k, before, side).step(before, Situation(**self.inputs), self.h)[3:]
        )
        for _ in range(2):
            self.truth = self.true.step(self.truth, Situation(**self.inputs), 0.5 * self.h)
        self.past.append((np.array(self.truth[3:]), self.estimate))
        self.received = self._received()
        self.estimate = self.estimate + np.where(self.received, self._pull(k, side), 0.0)
        # what comes late is compared with the corrected estimate of its time
        self.past[-1] = (self.past[-1][0], self.estimate)
        self._grow()
        low, high = np.array([self.c.operating.ranges[a] for a in ("u", "v", "r")]).T
        nu, w = np.array(self.truth[3:]), self.true.water(Situation(psi=self.truth[2]))
        through = nu - np.array([w.u, w.v, 0.0 * w.u])
        self.alive = self.alive & np.all((through >= low[:, None]) & (through <= high[:, None]), axis=0)
        return self.estimate - nu

    def _pull(self, k: int, side: np.ndarray) -> np.ndarray:
        """h K times a late and noisy measurement less the estimate of its own time; the age changes now and
        then.
        """
        measured = []
        for axis, oldest in enumerate(self.c.delays):
            age = min(len(self.past) - 1, oldest if k % 3 else int(self.rng.integers(0, oldest + 1)))
            was, thought = self.past[-1 - age]
            measured.append(was[axis] - thought[axis])
        return np.array(self.c.step.pull)[:, None] * (np.array(measured) + self.noise * side)

    def _grow(self) -> None:
        """The same bound as `Tube`, for all runs at once."""
        c, step = self.c, self.c.step
        V, drift, now, again = (np.array(x) for x in (step.V, step.drift, step.now, step.again))
        turned = np.array([c.h * p + row[3] for p, row in zip(c.plant.heading, c.plant.bend, strict=False)])
        d = np.array(c.push) @ self.limit[:, 0] + c.calm + turned * (self.heading_noise - c.heading_noise)
        E = V @ self.tube + d[:, None]
        self.before.append(E)
        told = np.array(step.told(tuple(d.tolist()), self.stated))
        seen = (
            now @ self.tube
            + again[:, None] * np.max(self.before, axis=0)
            + drift @ np.max(self.after, axis=0)
            + told[:, None]
        )
        self.tube = np.where(self.received, seen, E)
        self.after.append(self.tube)


def trial(fleet: AdversaryFleet, seconds: float | None = None) -> AdversaryOutcome:
    """Let a fleet sail until old errors have faded five times over, at least two ship lengths (at most 1500
    samples).
    """
    begin, c = time.perf_counter(), fleet.c
    steps = min(int((seconds or max(5.0 / c.rate, 2.0 * fleet.time)) / c.h), 1500)
    bound = np.array(c.bound_in(fleet.H_s))[:, None]
    of_tube = of_bound = error = np.zeros(3)
    violations = samples = 0
    for k in range(steps):
        e = np.abs(fleet.step(k))
        inside = fleet.alive
        if not inside.any():
            continue
        samples += int(inside.sum())
        violations += int(np.any(e > fleet.tube * (1.0 + 1e-9), axis=0)[inside].sum())
        of_tube = np.maximum(of_tube, (e / fleet.tube)[:, inside].max(axis=1))
        of_bound = np.maximum(of_bound, (e / bound)[:, inside].max(axis=1))
        error = np.maximum(error, e[:, inside].max(axis=1))
    took = time.perf_counter() - begin
    ratios = (tuple(x.tolist()) for x in (of_tube, of_bound, error))
    return AdversaryOutcome(fleet.runs, int((~fleet.alive).sum()), steps, samples, violations, *ratios, took)


def _inner(span: tuple[float, float], share: float) -> tuple[float, float]:
    middle, half = 0.5 * (span[0] + span[1]), 0.5 * (span[1] - span[0])
    return middle - share * half, middle + share * half


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--runs", type=positive, default=sum(c.runs for c in CASES), help="runs in all (default: %(default)s)"
    )
    parser.add_argument("--seed", type=int, default=1)
    answer.add_arguments(parser, "--results")


def run(args: argparse.Namespace) -> int:
    """All cases; ThresholdError when a bound was broken inside the operating set."""
    from bench.stability.loop import CASES as LOOPS
    from bench.stability.loop import Loops
    from bench.stability.report import tables

    share = args.runs / sum(c.runs for c in CASES)
    rows, loops = [], []
    for i, case in enumerate(CASES):
        model, c = certified(case)
        fleet = AdversaryFleet(
            model,
            c,
            max(1, round(case.runs * share)),
            args.seed + i,
            case.H_s,
            case.dropouts,
            bool(case.moving),
        )
        rows.append((case, c, _told(f"{case.ship} {case.rate_hz:g} Hz", trial(fleet))))
    for i, of_loop in enumerate(LOOPS):
        sailed = Loops(of_loop, max(1, round(of_loop.runs * share)), args.seed + i)
        loops.append(
            (of_loop, sailed.c, _told(f"the loop, {of_loop.ship} {of_loop.rate_hz:g} Hz", trial(sailed)))
        )
    cases, own = (
        [{**case._asdict(), **asdict(o), "bound": c.bound, "K": c.K} for case, c, o in some]
        for some in (rows, loops)
    )
    answer.give(args, plain({"schema_version": 1, "cases": cases, "loops": own}), tables(rows, loops, args))
    broken = sum(o.violations for _, _, o in (*rows, *loops))
    if broken:
        raise ThresholdError(
            f"the bound was broken in {broken} samples inside the operating set. Do not use the certificate."
        )
    return 0


def _told(what: str, o: AdversaryOutcome) -> AdversaryOutcome:
    answer.tell(f"{what}: {o.violations} violations in {o.runs} runs")
    return o
