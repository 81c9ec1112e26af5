"""How much of a seaway the promise has to bear: `twin-bench seaway --ship kvlcc2`

Reference voyages in seas up to the ship's own limit are split into low-frequency motion and motion with the
waves (twin/study/reference/split.py); what is found goes into the ship file's [seaway]. Others then sail
through the loop that the service builds: is the promise given, kept, and how wide is it?"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bench import bench_output
from bench.options import positive
from bench.reference import SeaCase, Weather, simulate
from bench.reference.hulls import HULLS
from bench.reference.sea_voyage import Recording
from bench.through_loop import through
from twin.live.certificate.certificate import usual_disturbance
from twin.physics import ship as ships
from twin.physics.model import Model
from twin.recording.jsonable import plain
from twin.study.reference.split import PERIODS, SplitVoyage, low_frequency, scores, section, window

LEVEL = 0.95
STEP_S = 0.1
HIGHEST = {"kvlcc2": 3.0, "container": 2.0, "kvlcc2_model": 0.066, "usv": 0.2}  # H_s [m]
MANOEUVRES = ("mixed", "zigzag_20", "zigzag_10")
LEFT_OUT_S = 60.0


class KeptVoyage(NamedTuple):
    """One voyage through the loop: share of ticks with a promise, of these wrong; the greatest error of the
    low-frequency motion in u, v, r and the greatest bound in ticks with a promise [m/s, m/s, rad/s]."""

    H_s: float
    inside: float
    wrong: float
    error: tuple[float, ...]
    bound: tuple[float, ...]
    said: str


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--ship", choices=sorted(HIGHEST), default="kvlcc2")
    parser.add_argument("--voyages", type=positive, default=40, help="to calibrate with (default: 40)")
    parser.add_argument("--tried", type=positive, default=8, help="through the loop (default: 8)")
    parser.add_argument("--seconds", type=float, default=300.0, help="length of a voyage (default: 300)")
    parser.add_argument("--write", action="store_true", help="put what was found into the bundled ship file")
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    ship = ships.load(args.ship)
    model = Model.of(ship)
    calm = replace(usual_disturbance(model)).calm
    cases = [case(args.ship, k, args.voyages, args.seconds, 1000) for k in range(args.voyages)]
    bench_output.tell(f"{args.voyages} voyages to calibrate with")
    found = [scores(model, sailed(r), calm) for r in simulate(cases, STEP_S)]
    source = f"twin-bench seaway --ship {args.ship} --voyages {args.voyages} --seconds {args.seconds:g}"
    table = section(found, LEVEL, source)
    if args.write:
        ship = replace(ship, notes={**ship.notes, "seaway": table})
        ships.save(ship, Path(ships.__file__).parent.parent / "ships" / f"{args.ship}.toml")
    kept = [
        loop_errors(args.ship, r)
        for r in simulate([case(args.ship, k, args.tried, args.seconds, 5000) for k in range(args.tried)])
    ]
    bench_output.give(
        args, plain({"seaway": table, "voyages": [k._asdict() for k in kept]}), sea_table(table, kept)
    )
    return 0


def case(hull: str, k: int, count: int, seconds: float, first_seed: int) -> SeaCase:
    """Voyage k of a series in which the sea rises to the ship's highest; wind and current grow with it as in
    the test sailings TS-01 to TS-03."""
    rng = np.random.default_rng([first_seed, k])
    H_s, scale = HIGHEST[hull] * (k + 1) / count, HULLS[hull].scale
    full = H_s / scale  # the wave height of the full-sized ship
    weather = Weather(
        wind_mps=9.0 * full**0.5 * scale**0.5,
        wind_from_deg=rng.uniform(0.0, 360.0),
        wave_height_m=H_s,
        wave_period_s=max(rng.uniform(5.1, 7.5) * H_s**0.5, 3.0 * scale**0.5),
        wave_from_deg=rng.uniform(0.0, 360.0),
        current_mps=0.43 * full * scale**0.5,
        current_to_deg=rng.uniform(0.0, 360.0),
        current_spread_mps=0.05 * full * scale**0.5,
    )
    return SeaCase(hull, MANOEUVRES[k % 3], weather, seed=first_seed + k, duration_s=seconds)


def sailed(r: Recording) -> SplitVoyage:
    """The truth of a reference voyage, in the terms of the split; wave height and period as reported."""
    t, of = r.truth, r.columns
    inputs = {
        "delta": t["rudder"],
        "n": t["n"],
        "wind_speed": t["wind_speed"],
        "wind_to": t["wind_from"] + np.pi,
    }
    H_s, T_p = (float(np.nanmean(of[f"wave_{name}"])) for name in ("height_significant_m", "period_peak_s"))
    return SplitVoyage(
        STEP_S,
        np.array([t["u"], t["v"], t["r"]]),
        t["psi"],
        inputs,
        np.array([t["current_north"], t["current_east"]]),
        max(H_s, 1e-6),
        T_p,
    )


def loop_errors(hull: str, r: Recording) -> KeptVoyage:
    """A voyage through the loop, against its low-frequency motion."""
    voyage = sailed(r)
    n = window(voyage.T_p, STEP_S)
    true = low_frequency(voyage.nu, n)
    off, bound, inside, said = [], [], [], {}
    for k, tick, loop in through(hull, r, STEP_S):
        e = loop.observer.estimate
        off.append(np.abs(np.array((e.u, e.v, e.r)) - true[:, k]))
        bound.append(loop.stabilizer.tube.beta)
        inside.append(tick.certificate.inside)
        if why := loop.stabilizer.outside:
            why = why.partition(" = ")[0]
            said[why] = said.get(why, 0) + 1
    used = slice(max(round(LEFT_OUT_S / STEP_S), 2 * n), -2 * n)
    off, bound, inside = (np.array(x)[used] for x in (off, bound, inside))
    wrong = np.any(off > bound, axis=1) & inside
    count = max(int(inside.sum()), 1)
    return KeptVoyage(
        voyage.H_s,
        float(inside.mean()),
        float(wrong.sum() / count),
        tuple(off.max(axis=0).tolist()),
        tuple((bound[inside] if inside.any() else bound).max(axis=0).tolist()),
        max(said, key=said.get) if said else "",
    )


def sea_table(table: dict[str, Any], kept: Sequence[KeptVoyage]) -> str:
    """The table."""
    numbers = ", ".join(f"{k} {v['value']:g} {v['unit']}" for k, v in table.items() if isinstance(v, dict))
    lines = [
        f"{table['voyages']} voyages, level {table['level']:g}, averaged over {PERIODS:g} peak periods: "
        f"{numbers}",
        "",
        "| H_s m | promised | of these wrong | greatest error u, v, r | greatest bound u, v, r | why not |",
        "|---|---|---|---|---|---|",
    ]
    for k in kept:
        error, bound = (f"{u:.3f}, {v:.3f} m/s, {np.degrees(r):.3f} deg/s" for u, v, r in (k.error, k.bound))
        lines.append(
            f"| {k.H_s:.2f} | {100 * k.inside:.0f} % | {100 * k.wrong:.2f} % | {error} | {bound} | {k.said} |"
        )
    return "\n".join(lines)
