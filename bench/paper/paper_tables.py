"""Tables 3 to 8 as numbers, the paper's own among them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from bench.paper import stats
from bench.paper.lab import Errors, LabCourse, judge
from bench.paper.models import Models, Predict

PAPER_3 = {
    "heading_mae_deg": {"analytic": 2.10, "ekf": 0.48, "hybrid": 0.15},
    "lateral_mae_m": {"analytic": 142.5, "ekf": 34.7, "hybrid": 11.2},
    "r2_heading": {"hybrid": 0.99},
    "r2_lateral": {"hybrid": 0.96},
}
PAPER_4 = {"analytic": [142.5, 138.2, 147.9], "lstm": [34.7, 32.9, 36.8], "hybrid": [11.2, 10.5, 12.1]}
PAPER_5 = {"analytic": 0.91, "lstm": 0.78}
PAPER_6 = {"analytic": [0.72, 0.69, 0.75], "hybrid": [0.96, 0.95, 0.97]}
PAPER_7 = {
    "Mass error M (+5%)": [12.4, 1.2],
    "Damping error D (+10%)": [18.7, 2.5],
    "GNSS sensor noise (0.5 m)": [4.2, 0.8],
}
EXACT = "GNSS without noise"
GNSS = "GNSS sensor noise (0.5 m)"
COMPARED = ("analytic", "hybrid", "hybrid_adapted", "physics_added_hybrid")  # in Table 7
BY_SPEED = ("analytic", "ekf", "hybrid", "physics_added_hybrid")  # in Table 8
PAPER_8 = {"Maneuvering": [32.4, 8.2], "Cruising": [18.1, 4.5], "Full speed": [25.6, 6.1]}


def all_tables(
    models: Models,
    courses: dict[str, list[LabCourse]],
    changed: Sequence[str],
    speeds: Sequence[str],
    resamples: int,
    r2_resamples: int,
) -> dict[str, Any]:
    """Every table that was worked out."""
    wanted = {name: ["zigzags", *_also(name, changed, speeds)] for name in models.predict}
    found = {
        name: by_group(f, {group: courses[group] for group in wanted[name]})
        for name, f in models.predict.items()
    }
    errors = {name: e["zigzags"] for name, e in found.items()}
    zigzags = courses["zigzags"]
    seeds = {
        n: [errors[n], *(judge(f(zigzags), zigzags) for f in list(some.values())[1:])]
        for n, some in models.seeds.items()
    }
    return {
        "3": table3(errors, seeds),
        "4": {n: _interval(e, resamples) | {"paper": PAPER_4.get(n)} for n, e in errors.items()},
        "5": {
            n: _against(errors["hybrid"], e) | {"paper": PAPER_5.get(n)}
            for n, e in errors.items()
            if n != "hybrid"
        },
        "6": {n: _r2(e, r2_resamples) | {"paper": PAPER_6.get(n)} for n, e in errors.items()},
        "7": table7(found, changed),
        "8": {
            name: table8(found, name) | {"paper": dict(zip(("ekf", "hybrid"), PAPER_8[name], strict=True))}
            for name in speeds
        },
    }


def _also(model: str, changed: Sequence[str], speeds: Sequence[str]) -> list[str]:
    """The groups beside the zigzags that the tables ask this model about."""
    return [*([*changed, EXACT] if model in COMPARED else []), *(speeds if model in BY_SPEED else [])]


def by_group(predict: Predict, groups: dict[str, list[LabCourse]]) -> dict[str, Errors]:
    """One model's errors on every group, predicted side by side."""
    runs = iter(predict([c for some in groups.values() for c in some]))
    return {name: judge([next(runs) for _ in some], some) for name, some in groups.items()}


def table3(errors: dict[str, Errors], seeds: dict[str, list[Errors]]) -> dict[str, Any]:
    """Mean errors of every model; by scenario; over the seeds of the hybrids."""
    every = {n: stats.summary(e) for n, e in errors.items()}
    out: dict[str, Any] = {
        measure: {n: s[measure] for n, s in every.items()} | {"paper": PAPER_3[measure]}
        for measure in PAPER_3
    }
    out["r2"] = out["r2_lateral"]  # the smaller of the two
    out["by_scenario"] = {
        f"TS-0{k}": {
            n: [float(e.heading_deg[e.scenario == k].mean()), float(e.lateral_m[e.scenario == k].mean())]
            for n, e in errors.items()
        }
        for k in sorted(set(errors["hybrid"].scenario.tolist()))
    }
    out["by_seed"] = {
        n: [[float(e.heading_deg.mean()), float(e.lateral_m.mean())] for e in some]
        for n, some in seeds.items()
    }
    means = np.array(out["by_seed"]["hybrid"])
    out["seeds"] = {
        "count": len(means),
        "mean": means.mean(0).tolist(),
        "sd": means.std(0, ddof=min(1, len(means) - 1)).tolist(),
    }
    out["windows"] = int(errors["hybrid"].voyage.size)
    return out


def ratios(table: dict[str, Any]) -> dict[str, float]:
    """How many times better the hybrid is; and what is left of that once the physics is named and
    calibrated."""
    out: dict[str, float] = {}
    for short, measure in (("heading", "heading_mae_deg"), ("lateral", "lateral_mae_m")):
        for name in ("analytic", "ekf", "lstm", "calibrated", "physics_added"):
            out[f"{short}_vs_{name}"] = table[measure][name] / table[measure]["hybrid"]
    return out


def _interval(e: Errors, resamples: int) -> dict[str, Any]:
    """Table 4: lateral error with its interval, windows drawn one by one and by whole voyages."""
    x = e.lateral_m
    return {
        "mae_m": float(x.mean()),
        "sd_m": float(x.std()),
        "by_window_95": stats.bootstrap(x, np.arange(x.size), resamples),
        "by_voyage_95": stats.bootstrap(x, e.voyage, resamples),
    }


def _against(ours: Errors, theirs: Errors) -> dict[str, Any]:
    """Table 5, lateral: size of effect, and p by windows and by voyages."""
    p = stats.wilcoxon(ours.lateral_m, theirs.lateral_m, ours.voyage)
    return {"cliff": stats.cliff(ours.lateral_m, theirs.lateral_m), "p_by_window": p[0], "p_by_voyage": p[1]}


def _r2(e: Errors, resamples: int) -> dict[str, Any]:
    """Table 6, lateral."""
    return {
        "r2": stats.r2(e.lateral, e.true_lateral),
        "by_window_95": stats.r2_interval(e.lateral, e.true_lateral, np.arange(e.voyage.size), resamples),
        "by_voyage_95": stats.r2_interval(e.lateral, e.true_lateral, e.voyage, resamples),
    }


def table7(errors: dict[str, dict[str, Errors]], changed: Sequence[str]) -> dict[str, Any]:
    """Other ships and another receiver, the models unchanged."""
    base, *others = changed
    found = {case: {n: stats.summary(errors[n][case]) for n in COMPARED} for case in (*changed, EXACT)}
    out: dict[str, Any] = {base: {"absolute": found[base]}}
    for case in others:
        out[case] = _change(found[base], found[case], found[base]["analytic"]) | _said(case)
    out[GNSS] = _change(found[EXACT], found[base], found[base]["analytic"]) | _said(GNSS)
    return out


def _change(before: dict[str, Any], after: dict[str, Any], nominal: dict[str, float]) -> dict[str, Any]:
    """Absolute errors after a change, the change in % of each model's own error, and in % of the nominal
    analytic error."""
    out: dict[str, Any] = {"absolute": after}
    for short, measure in (("lateral", "lateral_mae_m"), ("heading", "heading_mae_deg")):
        moved = {n: after[n][measure] - before[n][measure] for n in after}
        out[f"{short}_own_change_percent"] = {n: 100 * m / before[n][measure] for n, m in moved.items()}
        out[f"{short}_change_percent_of_analytic"] = {n: 100 * m / nominal[measure] for n, m in moved.items()}
    return out


def _said(case: str) -> dict[str, Any]:
    return {"paper": dict(zip(("analytic", "hybrid"), PAPER_7[case], strict=True))}


def table8(errors: dict[str, dict[str, Errors]], regime: str) -> dict[str, Any]:
    """One speed: lateral and heading errors."""
    found = {n: stats.summary(errors[n][regime]) for n in BY_SPEED}
    return {n: s["lateral_mae_m"] for n, s in found.items()} | {
        "heading_deg": {n: s["heading_mae_deg"] for n, s in found.items()}
    }
