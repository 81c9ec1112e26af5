"""Is the promise of the certificate kept where its assumptions are not? `twin-bench assumptions`

The loop that the service builds (certificate, residual, adaptation) meets what its theorem excludes: waves
that nobody reports, instruments that walk off slowly, ticks that come late. A tick is wrong where the loop
says `inside` and the error of u, v or r against the true low-frequency motion is beyond that bound."""

import argparse
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from bench import bench_output
from bench.promised_bound import promised_bound
from bench.reference import SeaCase, simulate
from bench.sea_disturbance import sailed
from bench.stability.adversary_loop import LoopCase, Loops
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.study.reference.split import low_frequency, window

SHIP, STEP_S, BEGIN_S, WALL, LEFT_OUT_S = "kvlcc2", 0.1, 1000.0, 1.7e9, 60.0
RAMP_S = 60.0
WAVES = ("wave_height_significant_m", "wave_period_peak_s", "wave_direction_deg")
Lie = Callable[[float], dict[str, float]]  # time [s] -> what is added to channels


class BrokenAssumption(NamedTuple):
    """One line of the table: a voyage, what its instruments do not say or say wrongly."""

    name: str
    manoeuvre: str
    weather: str
    silent: tuple[str, ...] = ()
    lie: Lie = lambda t: {}


class KeptPromise(NamedTuple):
    """Share of ticks with a promise, share of those that are wrong, the greatest error over its bound, and
    what was said."""

    name: str
    ticks: int
    inside: float
    wrong: float
    worst: float
    said: str


def ramp(**most: float) -> Lie:
    """Walks off within a minute, from 100 s on."""
    return lambda t: {
        name: size * float(np.clip((t - 100.0) / RAMP_S, 0.0, 1.0)) for name, size in most.items()
    }


SCENARIOS = (
    BrokenAssumption("nothing wrong, TS-01", "mixed", "TS-01"),
    BrokenAssumption("nothing wrong, no waves reported, TS-01", "mixed", "TS-01", WAVES),
    BrokenAssumption("TS-02, reported", "mixed", "TS-02"),
    BrokenAssumption("TS-02, not reported", "mixed", "TS-02", WAVES),
    BrokenAssumption("TS-03, reported", "mixed", "TS-03"),
    BrokenAssumption("TS-03, not reported", "mixed", "TS-03", WAVES),
    BrokenAssumption("TS-03 zigzag, not reported", "zigzag_20", "TS-03", WAVES),
    BrokenAssumption("surge +1.0 m/s in 60 s", "mixed", "TS-01", (), ramp(surge_velocity_mps=1.0)),
    BrokenAssumption(
        "surge +1.0 m/s, ground and water",
        "mixed",
        "TS-01",
        (),
        ramp(surge_velocity_mps=1.0, surge_velocity_through_water_mps=1.0),
    ),
    BrokenAssumption("sway +0.5 m/s", "mixed", "TS-01", (), ramp(sway_velocity_mps=0.5)),
    BrokenAssumption("sway +1.0 m/s", "mixed", "TS-01", (), ramp(sway_velocity_mps=1.0)),
    BrokenAssumption("yaw rate +0.2 deg/s", "mixed", "TS-01", (), ramp(yaw_rate_degps=0.2)),
    BrokenAssumption("yaw rate +0.5 deg/s", "mixed", "TS-01", (), ramp(yaw_rate_degps=0.5)),
)
LATE = (1, 2, 3, 5, 10)  # certified periods between two ticks


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--seconds", type=float, default=600.0, metavar="S", help="length of each voyage (default: 600)"
    )
    parser.add_argument("--runs", type=int, default=8, help="hostile ships for each lateness (default: 8)")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    rows = voyages(args.seconds) + [late(j, args.runs, 0.2 * args.seconds) for j in LATE]
    bench_output.give(args, {"rows": [row._asdict() for row in rows]}, table(rows))
    return 0


def voyages(seconds: float, scenarios: Sequence[BrokenAssumption] = SCENARIOS) -> list[KeptPromise]:
    """Every scenario on the reference sea."""
    wanted = sorted({(s.manoeuvre, s.weather) for s in scenarios})
    sailed = dict(
        zip(
            wanted,
            simulate([SeaCase(SHIP, m, w, seed=3, duration_s=seconds) for m, w in wanted], STEP_S),
            strict=True,
        )
    )
    kept = []
    for scenario in scenarios:
        bench_output.tell(scenario.name)
        kept.append(sailed_through(scenario, sailed[scenario.manoeuvre, scenario.weather]))
    return kept


def sailed_through(scenario: BrokenAssumption, recording) -> KeptPromise:
    """One voyage through the loop."""
    ears = Played([])
    loop = loop_of(Settings({"ship.file": SHIP}), ears, Outbox(Publisher(), "twin", "ship"), None)
    columns = {
        name: x
        for name, x in recording.columns.items()
        if name in loop.sensors.gates and name not in scenario.silent
    }
    voyage = sailed(recording)
    n = window(voyage.T_p, STEP_S)
    truth = low_frequency(voyage.nu, n)  # the promise is of it
    score, said = Score(), {}
    for k in range(truth.shape[1] - 2 * n):
        t, now_s, off = k * STEP_S, BEGIN_S + k * STEP_S, scenario.lie(k * STEP_S)
        values = ((name, float(x[k]) + off.get(name, 0.0)) for name, x in columns.items())
        ears.next = [Reading(name, x, WALL + now_s, now_s, "ship") for name, x in values if x == x]
        tick, e = loop.tick(Instant(k, now_s, WALL + now_s)), loop.observer.estimate
        if t >= LEFT_OUT_S:
            score.take(
                tick.certificate.inside,
                np.abs(np.array((e.u, e.v, e.r)) - truth[:, k]) / promised_bound(loop),
            )
            why = loop.stabilizer.outside or loop.stabilizer.broken
            said[why] = said.get(why, 0) + bool(why)
    return score.kept(scenario.name, max(said, key=said.get) if any(said.values()) else "")


def late(every: int, runs: int, seconds: float) -> KeptPromise:
    """Hostile ships of one certificate, each tick so many of its periods after the last."""
    bench_output.tell(f"a tick every {every} periods")
    loops, score = Loops(LoopCase(SHIP, 10.0, runs), runs, 11), Score()
    loops.h *= every
    for k in range(round(seconds / loops.h)):
        off = np.abs(loops.step(k)) / loops.tube
        for i in range(runs):
            score.take(bool(loops.alive[i]), off[:, i])
    return score.kept(f"hostile, a tick every {loops.h:.2f} s", loops.loops[0].stabilizer.outside or "")


class Score:
    """Counts ticks."""

    def __init__(self) -> None:
        self.ticks = self.inside = self.wrong = 0
        self.worst = 0.0

    def take(self, inside: bool, of_tube: np.ndarray) -> None:
        self.ticks += 1
        if inside:
            self.inside += 1
            self.wrong += bool(np.any(of_tube > 1.0))
            self.worst = max(self.worst, float(np.max(of_tube)))

    def kept(self, name: str, said: str) -> KeptPromise:
        return KeptPromise(
            name, self.ticks, self.inside / self.ticks, self.wrong / max(self.inside, 1), self.worst, said
        )


def table(rows: Sequence[KeptPromise]) -> str:
    """The table."""
    lines = [
        "| scenario | promised | of these wrong | greatest error / bound | most often said |",
        "|---|---|---|---|---|",
    ]
    lines += [
        f"| {r.name} | {100 * r.inside:.1f} % | {100 * r.wrong:.2f} % | {r.worst:.2f} | "
        f"{r.said.replace('|', '/')} |"
        for r in rows
    ]
    return "\n".join(lines)
