"""`twin-bench adaptation`: laws of adaptation side by side on ships that changed, and under measurements that lie.

The change has just happened when a voyage begins, and nothing is learned yet; or it comes in the middle, when the law on board has
heard the ship as she was for five minutes (adaptation_named.py: there it is a named effect that grows). All laws see the same stream
of unexplained force and regressors (from the hybrid's own filter, which does not use what they learn), and are judged by the free runs
of 120 s that follow. Boxes, ball and gate are those of twin/live/adapt.py for all of them.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from twin.study.import_voyage import write_json

EPILOG = """example: twin-bench adaptation --work .paper --markdown docs/results/adaptation.md

Trains the hybrid first where DIR holds none from `twin-bench paper` (--full: that of its full plan). Beside FILE.md go two
figures, FILE.png and FILE-named.png; what the page held from its line "## What it says" on stays. Exit code 0: the tables are made.
"""
STARTS_S = (60.0, 120.0, 180.0, 240.0, 300.0, 360.0, 420.0, 480.0, 540.0)
CHANGE_S = 300.0  # of a change in the middle of a voyage
ROUND_S = (180.0, 300.0, 360.0, 420.0, 480.0, 540.0, 600.0, 660.0, 720.0)  # windows around it: the first ends where it begins
EARLY, LATE = slice(0, 3), slice(4, 9)  # windows while it learns, and after
ON_BOARD = "ridge on fading evidence"
Stream = list[tuple[tuple[float, ...], list[float], float, str]]  # what a law is told at each step: wanted, regressors, dt, frozen


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument("--full", action="store_true", help="the network of `twin-bench paper --full`")
    parser.add_argument("--seeds", metavar="N", type=int, default=2, help="seeds for each scenario and zigzag (%(default)s)")
    parser.add_argument("--work", metavar="DIR", type=Path, default=Path(".paper"), help="voyages and checkpoints (%(default)s)")
    parser.add_argument("--markdown", metavar="FILE.md", type=Path, help="the tables as a page")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")


def run(args: argparse.Namespace) -> int:
    from bench.adaptation_page import page

    result = compare(args.work, args.full, args.seeds)
    text = "\n".join(page(result))
    print(text, file=sys.stderr if args.json == "-" else sys.stdout)
    if args.markdown:
        from bench import adaptation_named_page
        from bench.adaptation_page import figure, kept

        second = args.markdown.with_name(f"{args.markdown.stem}-named.png")
        figure(result, args.markdown.with_suffix(".png"))
        adaptation_named_page.figure(result["named"], second)
        drawn = f"![Error over time since a change]({args.markdown.stem}.png)\n\n![A named effect that grows]({second.name})"
        args.markdown.write_text(f"{text}\n\n{drawn}\n{kept(args.markdown)}")
    if args.json:
        write_json(result, args.json)
    return 0


def compare(work: Path, full: bool, seeds: int) -> dict[str, Any]:
    """Every law on every ship and every lie; and the law on board where a named effect grows."""
    from bench import adaptation_named

    bench = Bench.of(work, full)
    out: dict[str, Any] = {"schema_version": 1, "seeds": seeds, "full": full, "changed": {}, "lies": {}}
    streams = {name: bench.heard(cases) for name, cases in ships(seeds).items()}
    for law in laws():
        _tell(f"law: {law}")
        out["changed"][law] = {name: bench.judged(law, heard) for name, heard in streams.items()}
        clean = streams["as she is"]
        out["lies"][law] = {name: bench.judged(law, replace(clean, streams=lie(clean.streams))) for name, lie in LIES.items()}
    out["voyages"] = len(streams["as she is"].courses)
    named = adaptation_named.compare(work, full, 2 * seeds, _tell)
    return out | {"midway": bench.midway(seeds), "change_s": CHANGE_S, "starts_s": ROUND_S, "named": named}


def laws() -> dict[str, Any]:
    """None first, the one on board last."""
    from bench import adaptation_laws as peers
    from twin.live.adapt import Adaptation

    return {
        "none": None, "gradient, sigma": peers.Gradient, "gradient, e-modification": peers.EModified, "gradient, dead zone": peers.DeadZone,
        "RLS, forgetting": peers.Recursive, "Kalman, walk and leak": peers.Kalman, ON_BOARD: Adaptation,
    }  # fmt: skip


def midway_laws() -> dict[str, Any]:
    """Nothing, the law on board, and the same told of the change."""
    from bench.adaptation_laws import Told

    return {"off": None, "on": laws()[ON_BOARD], "told": partial(Told, at_s=CHANGE_S)}


def ships(seeds: int) -> dict[str, list[Any]]:
    """The ship as the models know her, and changed ones; the same seas for all."""
    from bench.paper_sea import zigzags

    return {name: zigzags(seeds, 80_000, hull=h) for name, h in hulls().items()}


def hulls() -> dict[str, Any]:
    """Hers, and what may become of it."""
    from bench.paper_sea import FULL, changed
    from bench.reference import HULLS

    hull = HULLS["kvlcc2"]
    heavy, held = (changed(FULL)[name][0].hull for name in ("Mass error M (+5%)", "Damping error D (+10%)"))
    return {
        "as she is": hull, "mass +5 %": heavy, "damping +10 %": held, "fouling: resistance +30 %": replace(hull, R0=1.3 * hull.R0),
        "windage +50 %": replace(hull, A_L=1.5 * hull.A_L, A_F=1.5 * hull.A_F), "rudder area -20 %": replace(hull, A_R=0.8 * hull.A_R),
    }  # fmt: skip


def changes() -> dict[str, Any]:
    """What happens to her at CHANGE_S."""
    from bench.reference import Change

    altered = hulls()
    became = {name: Change(CHANGE_S, altered[name]) for name in altered if name not in ("as she is", "windage +50 %")}
    return {"as she is": None, **became, "wind x 1.5": Change(CHANGE_S, wind=1.5), "wind x 2": Change(CHANGE_S, wind=2.0)}


@dataclass(frozen=True)
class Heard:
    """What the laws of each voyage are told, and where its filter stood after each step (K, V, 11)."""

    courses: Sequence[Any]
    states: np.ndarray
    streams: Sequence[Stream]


@dataclass(frozen=True)
class Bench:
    """The hybrid whose last layer is adapted."""

    model: Any
    acting: Any
    tuning: Any
    work: Path

    @classmethod
    def of(cls, work: Path, full: bool) -> "Bench":
        from bench import paper_sea as sea
        from bench.paper import settings_for
        from bench.paper_adapted import Acting
        from bench.paper_lab import course
        from bench.paper_models import Workshop
        from bench.paper_ship import nominal
        from export.batches import zeta_of
        from export.data import split
        from twin.physics.model import Model

        ship, plan = nominal(), sea.FULL if full else sea.QUICK
        courses = [course(one, ship) for one in sea.sail(sea.lessons(plan), work / "voyages", _tell)]
        legs = split([c.water for c in courses])
        shop = Workshop(split(courses), legs, settings_for(plan), work, _tell)  # type: ignore[type-var]
        model = Model(ship)
        taught = shop.taught(model, plan.seeds[0], "hybrid")
        return cls(model, Acting(taught.network, model, zeta_of(taught.network, taught.samples)), shop.tuned(model, taught.network), work)

    def midway(self, seeds: int) -> dict[str, Any]:
        """Of every change in the middle: errors by window, by how she learns."""
        from bench.paper_sea import zigzags

        out: dict[str, Any] = {}
        for name, change in changes().items():
            _tell(f"midway: {name}")
            heard = self.heard(zigzags(seeds, 90_000, change=change), ROUND_S)
            scenario = np.array([c.scenario for c in heard.courses])
            out[name] = {how: _summary(*self.errors(made, heard)[:2], scenario) for how, made in midway_laws().items()}
        return out

    def heard(self, cases: list[Any], starts_s: tuple[float, ...] = STARTS_S) -> Heard:
        """Sail, filter, and write down what a law would be told."""
        from bench.adaptation_laws import Writes
        from bench.paper_adapted import Learning
        from bench.paper_lab import course
        from bench.paper_sea import sail

        courses = [replace(course(one, self.model.ship), starts_s=starts_s) for one in sail(cases, self.work / "voyages", _tell)]
        learning = Learning(courses, self.model, self.acting, self.tuning, Writes)
        states = learning.run(int(courses[0].starts[-1]))
        return Heard(courses, states, [law.heard for law in learning.laws])  # type: ignore[attr-defined]

    def judged(self, law: str, heard: Heard) -> dict[str, Any]:
        """Heading deg and lateral m, early and late; and the greatest |A|."""
        heading, lateral, largest = self.errors(laws()[law], heard)
        return {
            "heading_deg": float(heading[:, LATE].mean()), "lateral_m": float(lateral[:, LATE].mean()),
            "heading_early_deg": float(heading[:, EARLY].mean()), "lateral_early_m": float(lateral[:, EARLY].mean()),
            "by_start_deg": heading.mean(0).tolist(), "largest_A": largest,
        }  # fmt: skip

    def errors(self, made: Any, heard: Heard) -> tuple[np.ndarray, np.ndarray, float]:
        """Free runs with what the law had learned by their starts: heading deg and lateral m (V, W); and the greatest |A|."""
        from bench.paper_filter import from_states
        from bench.paper_lab import judge

        learned = [self._numbers(made, stream, len(heard.states)) for stream in heard.streams]
        held = np.concatenate([x[c.starts] for x, c in zip(learned, heard.courses, strict=True)])
        starts = [heard.states[c.starts, i] for i, c in enumerate(heard.courses)]
        e = judge(from_states(heard.courses, self.model, self.acting.holding(held), starts), heard.courses)
        heading, lateral = (x.reshape(len(heard.courses), -1) for x in (e.heading_deg, e.lateral_m))
        return heading, lateral, float(np.sqrt((np.array(learned) ** 2).sum((2, 3))).max())

    def _numbers(self, made: Any, stream: Stream, steps: int) -> np.ndarray:
        """(K, 3, width) what acts after each step; steps without a measurement change nothing."""
        from twin.live.adapt import BESIDE

        width = len(self.acting.rows) + BESIDE
        out = np.zeros((steps, 3, width))
        if made is None:
            return out
        law = made(self.model.ship, self.acting.network.S, len(self.acting.rows))
        for k, (wanted, regressors, dt, frozen) in enumerate(stream, start=steps - len(stream)):
            law.learn(wanted, regressors, dt, frozen)
            out[k:] = law.numbers()
        return out


def _summary(heading: np.ndarray, lateral: np.ndarray, scenario: np.ndarray) -> dict[str, Any]:
    """Of errors (V, W): by window; and heading of the windows since the change, by scenario."""
    since = heading[:, np.array(ROUND_S) >= CHANGE_S].mean(1)
    return {
        "heading_deg": heading.mean(0).tolist(), "lateral_m": lateral.mean(0).tolist(),
        "by_scenario_deg": {name: float(since[scenario == name].mean()) for name in sorted(set(scenario.tolist()))},
    }  # fmt: skip


def _noisy(streams: Sequence[Stream]) -> list[Stream]:
    """White noise as large as three times what is usual there."""
    rng = np.random.default_rng(1)
    return [_changed(s, lambda k, w: w + 0.15 * rng.standard_normal(3)) for s in streams]


def _outliers(streams: Sequence[Stream]) -> list[Stream]:
    """Three in a hundred are ten units of the force scale off."""
    rng = np.random.default_rng(2)
    return [_changed(s, lambda k, w: w + 10.0 * rng.standard_normal(3) * (rng.random(3) < 0.03)) for s in streams]


def _dropouts(streams: Sequence[Stream]) -> list[Stream]:
    """Nothing to learn from in two of every three minutes."""
    return [[(w, q, dt, "out" if k * dt % 180.0 < 120.0 else frozen) for k, (w, q, dt, frozen) in enumerate(s)] for s in streams]


def _adversary(streams: Sequence[Stream]) -> list[Stream]:
    """Square waves of one unit in each row, slow enough to be believed."""
    return [_changed(s, lambda k, w: w + np.sign(np.sin(2 * np.pi * k / np.array([40.0, 55.0, 70.0])))) for s in streams]


def _stuck(streams: Sequence[Stream]) -> list[Stream]:
    """From the middle on every reading stays where it was."""
    return [s[: len(s) // 2] + [s[len(s) // 2]] * (len(s) - len(s) // 2) for s in streams]


def _changed(stream: Stream, change: Callable[[int, np.ndarray], np.ndarray]) -> Stream:
    return [(tuple(change(k, np.array(w)).tolist()), q, dt, frozen) for k, (w, q, dt, frozen) in enumerate(stream)]


LIES: dict[str, Callable[[Sequence[Stream]], list[Stream]]] = {
    "noise 0.15": _noisy, "3 % outliers of 10": _outliers, "drop-outs": _dropouts, "square waves of 1": _adversary, "stuck": _stuck,
}  # fmt: skip


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
