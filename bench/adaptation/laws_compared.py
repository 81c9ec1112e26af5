"""`twin-bench adaptation`: laws of adaptation side by side on ships that changed, and under measurements that
lie.

The change has just happened when a voyage begins, and nothing is learned yet; or it comes in the middle, when
the law on board has heard the ship as it was for five minutes (effect_growth.py: there it is a named
effect that grows). All laws see the same stream of unexplained force and regressors (from the hybrid's own
filter, which does not use what they learn), and are judged by the free runs of 120 s that follow. Boxes, ball
and gate are those of twin/live/learning/adapt.py for all of them."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bench import bench_output
from bench.adaptation import laws as peers
from bench.adaptation.laws import Stream
from bench.options import positive
from bench.paper.paper_voyages import FULL_PLAN, QUICK, changed, zigzags
from bench.reference import HULLS, Change
from twin.live.learning.adapt import Adaptation
from twin.live.learning.adapted_row import BESIDE

EPILOG = """example: twin-bench adaptation --work .paper --markdown docs/results/adaptation.md

Trains the hybrid first where DIR holds none from `twin-bench paper` (--full: that of its full plan). Beside
FILE.md go two figures, FILE.png and FILE-named.png; what the page held from its line "## What it says" on
stays. Exit code 0: the tables are made.
"""
STARTS_S = (60.0, 120.0, 180.0, 240.0, 300.0, 360.0, 420.0, 480.0, 540.0)
CHANGE_S = 300.0  # of a change in the middle of a voyage
# windows around it: the first ends where it begins
ROUND_S = (180.0, 300.0, 360.0, 420.0, 480.0, 540.0, 600.0, 660.0, 720.0)
EARLY, LATE = slice(0, 3), slice(4, 9)  # windows while it learns, and after
ON_BOARD = "ridge on fading evidence"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    parser.add_argument("--full", action="store_true", help="the network of `twin-bench paper --full`")
    parser.add_argument(
        "--seeds",
        metavar="N",
        type=positive,
        default=2,
        help="seeds for each scenario and zigzag (%(default)s)",
    )
    parser.add_argument(
        "--work",
        metavar="DIR",
        type=Path,
        default=Path(".paper"),
        help="voyages and checkpoints (%(default)s)",
    )
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    from bench.adaptation import growth_page
    from bench.adaptation.page import figure, page
    from bench.paper.models import Workshop

    shop = Workshop.planned(FULL_PLAN if args.full else QUICK, args.work, bench_output.tell)
    result = {"schema_version": 1, "seeds": args.seeds, "full": args.full} | compare(shop, args.seeds)
    more = ""
    if args.page:
        first, second = args.page.with_suffix(".png"), args.page.with_name(f"{args.page.stem}-named.png")
        figure(result, first)
        growth_page.figure(result["named"], second)
        more = (
            f"\n![Error over time since a change]({first.name})\n\n![A named effect that "
            f"grows]({second.name})\n{bench_output.kept(args.page)}"
        )
    bench_output.give(args, result, "\n".join(page(result)), more)
    return 0


def compare(shop: Any, seeds: int) -> dict[str, Any]:
    """Every law on every ship and every lie; and the law on board where a named effect grows."""
    from bench.adaptation import effect_growth
    from bench.adaptation.heard import Hearing
    from bench.paper.nominal_ship import nominal
    from twin.physics.model import Model

    hearing = Hearing.of(shop, Model(nominal()), "hybrid")
    heard = {name: hearing.of_voyages(cases, STARTS_S) for name, cases in ships(seeds).items()}
    clean, out = heard["as it is"], {"changed": {}, "lies": {}}
    for name, law in laws().items():
        shop.tell(f"law: {name}")
        out["changed"][name] = {ship: law_errors(law, some) for ship, some in heard.items()}
        out["lies"][name] = {
            said: law_errors(law, replace(clean, streams=lie(clean.streams))) for said, lie in LIES.items()
        }
    named = effect_growth.compare(shop, 2 * seeds)
    return out | {
        "voyages": len(clean.courses),
        "midway": midway(hearing, seeds),
        "change_s": CHANGE_S,
        "starts_s": ROUND_S,
        "named": named,
    }


def laws() -> dict[str, Any]:
    """None first, the one on board last."""
    return {
        "none": None,
        "gradient, sigma": peers.Gradient,
        "gradient, e-modification": peers.EModified,
        "gradient, dead zone": peers.DeadZone,
        "RLS, forgetting": peers.Recursive,
        "Kalman, walk and leak": peers.Kalman,
        ON_BOARD: Adaptation,
    }


def midway_laws() -> dict[str, Any]:
    """Nothing, the law on board, and the same told of the change."""
    return {"off": None, "on": Adaptation, "told": partial(peers.ForgettingLaw, at_s=CHANGE_S)}


def ships(seeds: int) -> dict[str, list[Any]]:
    """The ship as the models know it, and changed ones; the same seas for all."""
    return {name: zigzags(seeds, 80_000, hull=h) for name, h in hulls().items()}


def hulls() -> dict[str, Any]:
    """The ship's own, and what may become of it."""
    hull = HULLS["kvlcc2"]
    heavy, held = (
        changed(FULL_PLAN)[name][0].hull for name in ("Mass error M (+5%)", "Damping error D (+10%)")
    )
    return {
        "as it is": hull,
        "mass +5 %": heavy,
        "damping +10 %": held,
        "fouling: resistance +30 %": replace(hull, R0=1.3 * hull.R0),
        "windage +50 %": replace(hull, A_L=1.5 * hull.A_L, A_F=1.5 * hull.A_F),
        "rudder area -20 %": replace(hull, A_R=0.8 * hull.A_R),
    }


def changes() -> dict[str, Any]:
    """What happens to it at CHANGE_S."""
    altered = hulls()
    became = {
        name: Change(CHANGE_S, altered[name]) for name in altered if name not in ("as it is", "windage +50 %")
    }
    return {
        "as it is": None,
        **became,
        "wind x 1.5": Change(CHANGE_S, wind=1.5),
        "wind x 2": Change(CHANGE_S, wind=2.0),
    }


def midway(hearing: Any, seeds: int) -> dict[str, Any]:
    """Of every change in the middle: errors by window, by how it learns."""
    out: dict[str, Any] = {}
    for name, change in changes().items():
        hearing.shop.tell(f"midway: {name}")
        heard = hearing.of_voyages(zigzags(seeds, 90_000, change=change), ROUND_S)
        out[name] = {
            how: _summary(*errors(law, heard)[:2], heard.scenario) for how, law in midway_laws().items()
        }
    return out


def law_errors(law: Any, heard: Any) -> dict[str, Any]:
    """Heading deg and lateral m, early and late; and the greatest |A|."""
    heading, lateral, largest = errors(law, heard)
    return {
        "heading_deg": float(heading[:, LATE].mean()),
        "lateral_m": float(lateral[:, LATE].mean()),
        "heading_early_deg": float(heading[:, EARLY].mean()),
        "lateral_early_m": float(lateral[:, EARLY].mean()),
        "by_start_deg": heading.mean(0).tolist(),
        "largest_A": largest,
    }


def errors(law: Any, heard: Any) -> tuple[np.ndarray, np.ndarray, float]:
    """Free runs with what the law had learned by their starts: heading deg and lateral m (V, W); and the
    greatest |A|."""
    learned = [_acting(law, heard, stream) for stream in heard.streams]
    held = np.concatenate([x[c.starts] for x, c in zip(learned, heard.courses, strict=True)])
    return *heard.errors(held), float(np.sqrt((np.array(learned) ** 2).sum((2, 3))).max())


def _acting(law: Any, heard: Any, stream: Stream) -> np.ndarray:
    """(K, 3, width) what acts after each step; steps without a measurement change nothing."""
    steps, components = len(heard.states), len(heard.acting.rows)
    out = np.zeros((steps, 3, components + BESIDE))
    if law is None:
        return out
    made = law(heard.model.ship, heard.acting.network.S, components)
    for k, told in enumerate(stream, start=steps - len(stream)):
        made.learn(*told)
        out[k:] = made.numbers()
    return out


def _summary(heading: np.ndarray, lateral: np.ndarray, scenario: np.ndarray) -> dict[str, Any]:
    """Of errors (V, W): by window; and heading of the windows since the change, by scenario."""
    from bench.adaptation.heard import by_scenario

    since = heading[:, np.array(ROUND_S) >= CHANGE_S].mean(1)
    return {
        "heading_deg": heading.mean(0).tolist(),
        "lateral_m": lateral.mean(0).tolist(),
        "by_scenario_deg": by_scenario(since, scenario),
    }


def _noisy(streams: Sequence[Stream]) -> list[Stream]:
    """White noise as large as three times what is usual there."""
    rng = np.random.default_rng(1)
    return [_changed(s, lambda k, w: w + 0.15 * rng.standard_normal(3)) for s in streams]


def _outliers(streams: Sequence[Stream]) -> list[Stream]:
    """Three in a hundred are ten units of the force scale off."""
    rng = np.random.default_rng(2)
    return [
        _changed(s, lambda k, w: w + 10.0 * rng.standard_normal(3) * (rng.random(3) < 0.03)) for s in streams
    ]


def _dropouts(streams: Sequence[Stream]) -> list[Stream]:
    """Nothing to learn from in two of every three minutes."""
    return [
        [(w, q, dt, "out" if k * dt % 180.0 < 120.0 else frozen) for k, (w, q, dt, frozen) in enumerate(s)]
        for s in streams
    ]


def _adversary(streams: Sequence[Stream]) -> list[Stream]:
    """Square waves of one unit in each row, slow enough to be believed."""
    return [
        _changed(s, lambda k, w: w + np.sign(np.sin(2 * np.pi * k / np.array([40.0, 55.0, 70.0]))))
        for s in streams
    ]


def _stuck(streams: Sequence[Stream]) -> list[Stream]:
    """From the middle on every reading stays where it was."""
    return [s[: len(s) // 2] + [s[len(s) // 2]] * (len(s) - len(s) // 2) for s in streams]


def _changed(stream: Stream, change: Callable[[int, np.ndarray], np.ndarray]) -> Stream:
    return [
        (tuple(change(k, np.array(w)).tolist()), q, dt, frozen) for k, (w, q, dt, frozen) in enumerate(stream)
    ]


LIES: dict[str, Callable[[Sequence[Stream]], list[Stream]]] = {
    "noise 0.15": _noisy,
    "3 % outliers of 10": _outliers,
    "drop-outs": _dropouts,
    "square waves of 1": _adversary,
    "stuck": _stuck,
}
