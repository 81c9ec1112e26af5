"""`twin-bench paper`: the paper's Tables 3 to 8 on open voyages, the paper's number beside ours."""

import argparse
import json
import tempfile
import time
from pathlib import Path
from typing import Any

from bench import bench_output
from bench.paper import paper_voyages

EPILOG = """example: twin-bench paper --quick

--quick takes minutes and few runs; --full is the paper's 18 hours of voyages, 90 zigzags and five seeds, and
takes hours. Both keep what is done in --work DIR and go on from there. What a page holds from its line "##
What it says" on stays. Exit code 0: the tables are written, whatever they say.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EPILOG
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quick", action="store_true", help="few runs, one seed (the default)")
    size.add_argument("--full", action="store_true", help="the paper's own amount, resumable")
    parser.add_argument(
        "--work",
        metavar="DIR",
        type=Path,
        help="where voyages and checkpoints are kept (default: nowhere; --full: .paper)",
    )
    parser.add_argument(
        "--figures", metavar="DIR", type=Path, help="Figures 2 to 6 as PNG files (needs matplotlib)"
    )
    parser.add_argument(
        "--tick", metavar="FILE.json", type=Path, help="what `twin-bench --json` wrote, for Table 9"
    )
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    from bench.paper.page import page

    tick = json.loads(args.tick.read_text()) if args.tick else None  # before the hours, not after them
    with tempfile.TemporaryDirectory() as nowhere:
        work = args.work or (Path(".paper") if args.full else Path(nowhere))
        result = reproduce(
            paper_voyages.FULL_PLAN if args.full else paper_voyages.QUICK, work, not args.full, args.figures
        )
    if tick:
        result["tables"]["9"] = tick
    bench_output.give(args, result, "\n".join(page(result)), bench_output.kept(args.page))
    return 0


def reproduce(
    plan: paper_voyages.PaperPlan, work: Path, quick: bool, figures: Path | None = None
) -> dict[str, Any]:
    """Sail, train, tune, predict, and count."""
    from bench.paper import closed as paper_closed
    from bench.paper import models as paper_models
    from bench.paper import paper_tables
    from bench.paper.curve import curve
    from bench.paper.lab import course
    from bench.paper.nominal_ship import nominal

    began, wall = time.process_time(), time.monotonic()
    work.mkdir(parents=True, exist_ok=True)
    ship, tell = nominal(), bench_output.tell
    changed, speeds = paper_voyages.changed(plan), paper_voyages.by_speed(plan)
    groups = {
        "lessons": paper_voyages.lessons(plan),
        "zigzags": paper_voyages.unseen(plan),
        **changed,
        **speeds,
    }
    sailed = iter(
        paper_voyages.sail(
            [c for cases in groups.values() for c in cases], work / "voyages", tell, plan.tick_s
        )
    )
    voyages = {name: [next(sailed) for _ in cases] for name, cases in groups.items()}
    voyages[paper_tables.EXACT] = [
        paper_voyages.without_gnss_noise(one) for one in voyages[next(iter(changed))]
    ]
    courses = {name: [course(one, ship, plan.starts_s) for one in some] for name, some in voyages.items()}
    models = paper_models.build(
        courses["lessons"], paper_models.settings_for(plan), plan.lstm_epochs, plan.seeds, work, tell
    )
    tell("predicting")
    tables = paper_tables.all_tables(
        models, courses, list(changed), list(speeds), plan.resamples, plan.resamples // 2
    )
    tell("closed loop")
    closed = paper_closed.sail(models.plain, models.network, plan.closed, plan.tick_s)
    tables["fig5"] = paper_closed.table(closed)
    tell("less data")
    tables["data"] = curve(
        models.shop, models.tuning, courses["zigzags"], plan.curve, plan.lstm_epochs, plan.seeds
    )
    if figures:
        tables["fig6_ms"] = _draw(figures, models, courses["zigzags"], closed, tables)
    return {
        "schema_version": 1,
        "quick": quick,
        "tables": tables,
        "ratios": paper_tables.ratios(tables["3"]),
        "models": models.about,
        "counts": {name: len(some) for name, some in courses.items()},
        "scenarios": list(paper_voyages.SCENARIOS),
        "cpu_seconds": round(time.process_time() - began, 1),
        "seconds": round(time.monotonic() - wall, 1),
    }


def _draw(
    folder: Path, models: Any, zigzags: list[Any], closed: Any, tables: dict[str, Any]
) -> dict[str, list[float]]:
    """All figures; gives the times behind Fig. 6."""
    from bench.paper import figures as draw

    folder.mkdir(parents=True, exist_ok=True)
    draw.learning(folder, models.curves)
    draw.zigzag(folder, models, next(c for c in zigzags if c.scenario == "TS-03"))
    draw.histogram(folder, models, zigzags)
    draw.closed_loop(folder, closed)
    three = tables["3"]
    whole = {"hours": sum(c.water.t[-1] for c in models.shop.parts["train"]) / 3600} | {
        n: {m: three[m][n] for m in ("heading_mae_deg", "lateral_mae_m")} for n in draw.CURVES
    }
    draw.data(folder, [*tables["data"], whole])
    return draw.horizons(folder)
