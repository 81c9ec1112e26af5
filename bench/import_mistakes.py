"""`twin-bench import-mistakes`: are mistakes of a recording named, and are healthy recordings left in peace?

Healthy voyages of the reference sea in every form of export: how many have anything proved wrong. Then each
mistake in each of ten voyages: is it named, by itself, and does its remedy give back the healthy voyage?
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from bench.import_forms import FORMS, Export, export, voyage_of
from bench.import_plant import MISTAKES, PlantedMistake
from bench.reference import Recording, SeaCase, simulate
from twin import whole
from twin.recording.checks import Check, run_checks
from twin.recording.voyage import Voyage

SCHEMA_VERSION = 1
HULLS = ("container", "kvlcc2", "usv")
MANOEUVRES = ("zigzag_20", "turning_circle", "mixed", "course_changes", "speed_changes", "square", "straight")
WEATHERS = ("calm", "TS-02")
ACTIVE = ("mixed", "zigzag_20", "course_changes", "square")  # a mistake shows where a ship turns
TEN = 10
DURATION_S = 900.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--seeds", type=int, default=2, metavar="N", help="voyages of each hull, manoeuvre and weather"
    )
    parser.add_argument("--first-seed", type=int, default=101, metavar="SEED", help="the first of them")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")
    parser.add_argument("--out", metavar="FILE.md", help="the page")


def run(args: argparse.Namespace) -> int:
    print("sailing ...", file=sys.stderr)
    sea = simulate(cases(args.seeds, args.first_seed))
    result = {"schema_version": SCHEMA_VERSION, "healthy": healthy(sea), "mistakes": mistakes(sea)}
    if args.json:
        text = json.dumps(result, indent=2)
        print(text) if args.json == "-" else whole.write(args.json, text + "\n", "--json")
    page = mistakes_page(result)
    if args.out:
        whole.write(args.out, page, "--out")
    if args.json != "-":
        print(page)
    return 0


def cases(seeds: int, first: int) -> list[SeaCase]:
    kinds = [(h, m, w) for h in HULLS for m in MANOEUVRES for w in WEATHERS]
    return [
        SeaCase(h, m, w, seed=first + seeds * i + k, duration_s=DURATION_S)
        for i, (h, m, w) in enumerate(kinds)
        for k in range(seeds)
    ]


def healthy(sea: Sequence[Recording]) -> dict[str, Any]:
    """How many voyages had something proved wrong, and which checks asked for a look."""
    wrong: list[dict[str, Any]] = []
    looks: dict[str, int] = {}
    count, start = 0, time.perf_counter()
    for recording in sea:
        for form, (columns, hz) in FORMS.items():
            count += 1
            for c in run_checks(voyage_of(export(recording.columns, recording.truth["psi"], hz), columns)):
                if c.unusable:
                    wrong.append({"case": name_of(recording), "form": form, "check": c.name, "text": c.text})
                elif not c.ok:
                    looks[c.name] = looks.get(c.name, 0) + 1
    return {
        "voyages": count,
        "wrong": wrong,
        "looks": looks,
        "seconds_each": (time.perf_counter() - start) / max(count, 1),
    }


def name_of(recording: Recording) -> str:
    c = recording.case
    return f"{c.hull} {c.manoeuvre} {c.weather} {c.seed}"


def mistakes(sea: Sequence[Recording]) -> list[dict[str, Any]]:
    """Each mistake on ten voyages that turn, spread over hulls and manoeuvres."""
    turning = [r for r in sea if r.case.manoeuvre in ACTIVE]
    ten = [
        turning[(7 * i) % len(turning)] for i in range(min(TEN, len(turning)))
    ]  # hulls, manoeuvres and weathers in turn
    return [of_mistake(m, ten) for m in MISTAKES]


def of_mistake(m: PlantedMistake, voyages: Sequence[Recording]) -> dict[str, Any]:
    out: dict[str, Any] = {
        "mistake": m.name,
        "voyages": 0,
        "cannot_show": 0,
        "named": 0,
        "alone": 0,
        "mended": 0,
        "missed": [],
    }
    for recording in voyages:
        table = export(recording.columns, recording.truth["psi"], m.hz, m.north_up)
        planted = m.plant(dict(table))
        if not m.shows(table) or (m.north_up and same(planted, table)):
            out["cannot_show"] += 1
            continue
        out["voyages"] += 1
        answers = run_checks(voyage_of(planted, m.form))
        named = [c for c in answers if not c.ok and all(word in c.text for word in m.words)]
        out["named"] += bool(named)
        out["alone"] += bool(named) and all(c in named for c in answers if c.unusable)
        out["mended"] += m.remedy is None or mended(
            voyage_of(planted, m.form | m.remedy), voyage_of(table, m.form)
        )
        if not named:
            out["missed"].append({"case": name_of(recording), "said": said(answers)})
    return out


def same(a: Export, b: Export) -> bool:
    """Whether a mistake changes nothing that counts (no mean across north where the ship never heads
    north)."""
    return all(np.allclose(a[n], b[n], atol=5.0 if n == "hdg" else 1e-9, equal_nan=True) for n in a)


def mended(again: Voyage, healthy: Voyage) -> bool:
    """Whether the voyage is the healthy one again (a compass to a degree: what was late is drawn between
    samples)."""
    for name in healthy.columns:
        a, b = again[name], healthy[name]
        both = np.isfinite(a) & np.isfinite(b)
        apart = np.abs(a[both] - b[both])
        apart = np.minimum(apart, np.abs(apart - 360.0)) if name.endswith("_deg") else apart
        if not both.any() or np.quantile(apart, 0.95) > max(
            1.0 if name.endswith("_deg") else 0.05 if name.endswith("_mps") else 0.0,
            0.02 * np.nanstd(b),
            1e-6,
        ):
            return False
    return True


def said(answers: Sequence[Check]) -> str:
    return "; ".join(f"{c.name}: {c.text[:120]}" for c in answers if not c.ok)


def mistakes_page(result: dict[str, Any]) -> str:
    h, m = result["healthy"], result["mistakes"]
    lines = [
        "# Mistakes of a recording: named, and never proved where there are none",
        "",
        "`twin-bench import-mistakes --out docs/results/import.md`. Voyages of 15 minutes of three hulls in "
        "the reference sea, which shares no line with the twin.",
        "",
        f"**Healthy voyages**: {h['voyages']}, in {len(FORMS)} forms of export. Something proved wrong: "
        f"**{len(h['wrong'])}** "
        f"(with {h['voyages']} voyages the rate is below {upper(len(h['wrong']), h['voyages']):.2g} % at 95 "
        "%). Asked for a look: "
        + (", ".join(f"{k} {n}" for k, n in h["looks"].items()) or "none")
        + f". {1000 * h['seconds_each']:.0f} ms a voyage.",
        "",
        *(f"* {w['case']}, {w['form']}: {w['check']}: {w['text']}" for w in h["wrong"]),
        "",
        "| mistake | voyages | named | nothing else proved | remedy gives back the healthy voyage |",
        "|---|---|---|---|---|",
        *(f"| {x['mistake']} | {x['voyages']} | {x['named']} | {x['alone']} | {x['mended']} |" for x in m),
        "",
        f"Named: {sum(x['named'] for x in m)} of {sum(x['voyages'] for x in m)}.",
        "",
        *(
            f"* not named, {x['mistake']}, {y['case']}: {y['said'] or 'nothing said'}"
            for x in m
            for y in x["missed"]
        ),
    ]
    return "\n".join(lines) + "\n"


def upper(hits: int, of: int) -> float:
    """One-sided 95 % bound of a rate [%]: the rule of three when there were none."""
    return 100.0 * (3.0 if hits == 0 else hits + 1.64 * np.sqrt(hits) + 1.5) / max(of, 1)
