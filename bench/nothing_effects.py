"""How often `twin add` accepts an effect that is not there: every lasting effect, on healthy voyages of three
hulls of the reference sea.

Each hull is calibrated on a few calm voyages; then pairs of healthy voyages are sailed, one to fit on and
another manoeuvre to prove on. The number of each effect is the most probable one to first order, which for
effects that are not there is where a full fit ends as well (--full asks that too). One line of JSON a trial,
so that a run that was cut off goes on where it was."""

import argparse
import json
import pickle
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bench.league.league_ships import LeagueFleet, calibrated
from bench.league.league_voyages import kept, sail
from bench.league.plan import lasts
from bench.reference import SeaCase
from twin.errors import DataError
from twin.physics.effects import catalogue, find
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.study.diagnosis.assemble import of_tracks
from twin.study.diagnosis.case import SCENARIOS
from twin.study.diagnosis.case import Case as Judged
from twin.study.diagnosis.refine import Found
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import linearise
from twin.study.prediction.left_out import models_without
from twin.study.prediction.openloop import HORIZONS_S
from twin.study.reference.derivatives import first_prior
from twin.study.reference.evidence import Hypothesis, boxed, posterior
from twin.study.reference.nuisance import usual_unknowns
from twin.study.reference.sailed import fed, read_all
from twin.study.reference.seaway import swung
from twin.study.reference.structure import noise_model_of
from twin.study.track.track import Track, track
from twin.study.update.adding import Fitted, fitted, lasting, of_hypothesis
from twin.study.update.held_parts import predicted
from twin.study.update.proof import prove

HULLS = ("kvlcc2", "container", "usv")
PAIRS = (("mixed", "course_changes"), ("zigzag_20", "mixed"), ("course_changes", "zigzag_20"))
SEED = 7000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--work", default=".nothing", help="where voyages, ships and the log are kept")
    parser.add_argument(
        "--hull", action="append", choices=HULLS, help="one of the hulls (repeat; default: all)"
    )
    parser.add_argument("--seeds", type=int, default=3, help="pairs of voyages of each hull")
    parser.add_argument("--calm", type=int, default=3, help="calm voyages by which each hull is calibrated")
    parser.add_argument(
        "--full", action="store_true", help="fit every effect as twin add does (minutes a pair)"
    )
    parser.add_argument(
        "--references",
        metavar="FILE",
        nargs="+",
        help="instead: a calibrated ship file and its reference voyages, each left out in turn",
    )
    parser.add_argument("--json", help="the table as JSON ('-': standard output)")


def run(args: argparse.Namespace) -> int:
    folder = Path(args.work)
    folder.mkdir(parents=True, exist_ok=True)
    log = folder / "trials.jsonl"
    done = [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
    asked = {(d["hull"], d["seed"], d["full"]) for d in done}
    with log.open("a") as out:
        for hull, seed, trials in _every(args, folder, asked):
            rows = [r | {"hull": hull, "seed": seed, "full": args.full} for r in trials]
            out.write("".join(json.dumps(r) + "\n" for r in rows))
            out.flush()
            done += rows
    table, page = summary(done), sys.stderr if args.json == "-" else sys.stdout
    print(f"{'hull':<12}{'trials':>8}{'accepted':>10}   which", file=page)
    for row in table:
        print(
            f"{row['hull']:<12}{row['trials']:>8}{row['accepted']:>10}   {', '.join(row['which'])}", file=page
        )
    if args.json:
        text = json.dumps({"schema_version": 1, "table": table, "trials": done})
        sys.stdout.write(text) if args.json == "-" else Path(args.json).write_text(text)
    return 0


def _every(
    args: argparse.Namespace, folder: Path, asked: set[tuple[str, int, bool]]
) -> Iterator[tuple[str, int, Iterator[dict[str, Any]]]]:
    """Hull, number and trials of every pair of voyages that was not asked yet."""
    if args.references:
        ship, tracks, without = _left_out(*args.references)
        for k, (t, other) in enumerate(zip(tracks, without, strict=True)):
            if (ship.name, k, args.full) not in asked:
                half = len(t) // 2
                yield (
                    ship.name,
                    k,
                    _of_pair(other, t.part(0, half), t.part(half, len(t)), f"{ship.name} {k}", args.full),
                )
        return
    for hull in args.hull or HULLS:
        ship = _ship(hull, folder, args.calm)
        for seed in range(args.seeds):
            if (hull, seed, args.full) not in asked:
                yield hull, seed, _trials(ship, hull, seed, folder, args.full)


def _left_out(path: str, *voyages: str) -> tuple[Ship, list[Track], list[Ship]]:
    """A calibrated ship, its reference voyages, and the ship as each voyage's others would have it."""
    ship, known = load(path), catalogue()
    tracks, stored = [s.track for s in read_all(voyages, ship)], ship.notes["structural"]
    model, unknowns = Model.of(ship), usual_unknowns(Model.of(ship), known)
    normal = innovate(
        [linearise(t, fed(model, t)[0], unknowns, known) for t in tracks],
        [noise_model_of(ship, "beside") or NoiseModel()],
    )[0]
    pull = np.array([(first_prior(u, ship).centre - u.centre) / u.sd for u in unknowns])
    shown = np.array([stored["between_voyages"].get(u.label, 0.0) ** 2 for u in unknowns])
    scatter = np.maximum(shown, [u.varies**2 for u in unknowns])
    models = models_without(model, unknowns, normal, scatter, pull, stored["temper_beside"], known)
    return ship, tracks, [replace(m.ship, effects=m.effects) for m in models]


def summary(done: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Trials and acceptances of each hull and of all."""
    out = []
    for hull in [*dict.fromkeys(d["hull"] for d in done), "all"]:
        # voyages too broken to judge by are no trials
        mine = [d for d in done if hull in (d["hull"], "all") and "why" not in d]
        which = [d["effect"] for d in mine if d["proved"]]
        out.append({"hull": hull, "trials": len(mine), "accepted": len(which), "which": which})
    return out


def _ship(hull: str, folder: Path, references: int) -> Ship:
    path = folder / f"{hull}-{references}.ship"
    if not path.exists():
        print(f"calibrating {hull} ...", file=sys.stderr)
        fleet = LeagueFleet(hull, lasts(hull, 1200.0), references, weather=False)
        sail(fleet.cases(), folder)
        path.write_bytes(pickle.dumps(calibrated(fleet, folder)[""]))
    ship: Ship = pickle.loads(path.read_bytes())
    return ship


def _trials(ship: Ship, hull: str, seed: int, folder: Path, full: bool) -> Iterator[dict[str, Any]]:
    """One for each lasting effect that the voyages can feed."""
    cases = [
        SeaCase(hull, m, seed=SEED + 2 * seed + i, duration_s=lasts(hull, 1200.0))
        for i, m in enumerate(PAIRS[seed % len(PAIRS)])
    ]
    sail(cases, folder)
    used, held = (swung(track(kept(c, folder)[0], ship), Model.of(ship)) for c in cases)
    yield from _of_pair(ship, used, held, f"{hull} {seed}", full)


def _of_pair(ship: Ship, used: Track, held: Track, said: str, full: bool) -> Iterator[dict[str, Any]]:
    case = of_tracks([used], ship)
    usual = case.reduced(case.lines, case.scenarios(["usual"]))[0]
    for name in lasting(case.names(case.candidates)):
        print(f"{said}: {name} ...", file=sys.stderr)
        made = fitted(ship, [find(name)], [used]) if full else _first_order(case, usual, name)
        yield {"effect": name} | _proved(made, held, ship)


def _first_order(case: Judged, usual: Any, name: str) -> Fitted:
    """The effect where the equations about none of it have it."""
    own = boxed(usual, (name,), posterior(usual, (name,)))
    h = Hypothesis((name,), next(iter(SCENARIOS)), own.log_evidence, 0.0)
    return of_hypothesis(case, (name,), Found(h, own, case.model))


def _proved(made: Fitted, held: Track, ship: Ship) -> dict[str, Any]:
    numbers = {n.name: [n.value, n.low95, n.high95] for n in made.numbers}
    try:
        w = predicted(made, [held], HORIZONS_S)
        proof = prove(w.judged_before, w.judged_after, w.errors, w.horizons_s, float(ship.scale("time")))
    except DataError as error:
        return {"proved": False, "why": str(error), "numbers": numbers}
    return proof.entry() | {"numbers": numbers}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    add_arguments(parser)
    sys.exit(run(parser.parse_args()))


if __name__ == "__main__":
    main()
