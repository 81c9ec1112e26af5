"""The result of `twin-bench --steps N` as a table for a terminal."""

from typing import Any

WIDTH = 78
DOC = {
    "read": "take the samples that came in, decode, log",
    "sensors": "gates, ages, quality",
    "correct": "observer with gain K",
    "known": "known force: core and effects",
    "checks": "instruments against each other",
    "guard": "may the learned force act?",
    "learned": "learned force: network and last layer",
    "step": "the model to the next tick",
    "adapt": "learn slowly, inside bounds",
    "predict": "10, 60 and 120 s ahead, a few steps a tick",
    "tube": "how far predictions were off, and will be",
    "certificate": "stability by numbers",
    "publish": "the wide record",
    "record": "to the bus and to the log",
}
PEERS = {
    "analytic": "equations only, one Runge-Kutta step",
    "ekf": "filterpy's extended Kalman filter",
    "lstm": "2 x 128, re-run over its window of 50",
    "lstm_stateful": "2 x 128, carrying its state",
}
COUNTED = {
    "analytic": "one Runge-Kutta step of the equations",
    "network": "one run of the residual's network",
    "tick": "one whole tick at 50 Hz, without bus and disk",
}


def text(r: dict[str, Any]) -> str:
    """All of it."""
    blocks = [
        _head(r),
        _steps(r),
        _parts(r),
        _memory(r),
        _peers(r),
        _ahead(r),
        _counts(r),
        _cortex(r),
        _verdict(r),
    ]
    return "\n".join(line.rstrip() for block in blocks if block for line in block.split("\n"))


def _title(words: str, right: str = "") -> str:
    return f"\n{words}{right:>{WIDTH - len(words)}}".rstrip(" ") + "\n" + "─" * WIDTH


def _head(r: dict[str, Any]) -> str:
    lines = [f"twin-bench: {r['steps']} steps of the whole loop at {r['rate_hz']:g} Hz, mode: {r['mode']}"]
    lines.append(
        f"residual: {r['residual']}; {r['messages_per_step']:g} messages a step; {r['log']['written']} logged"
    )
    others = {mode: n for mode, n in r["modes"].items() if mode != r["mode"]}
    if others:
        lines.append(f"note: not all steps did all the work: {others}")
    lines += [f"note: {note}" for note in [*r["notes"], *r["reasons"]]]
    return "\n".join(lines)


def _row(name: str, times: dict[str, float]) -> str:
    return f"  {name:<22}" + "".join(f"{times[q]:>14,.0f}" for q in ("median", "p99", "p999", "max"))


def _steps(r: dict[str, Any]) -> str:
    lines = [
        _title("Time of a step [us]"),
        f"  {'':<22}" + "".join(f"{q:>14}" for q in ("median", "p99", "p99.9", "max")),
    ]
    lines.append(_row("as fast as it can", r["step_us"]))
    paced = r["paced"]
    if paced:
        lines.append(_row(f"on time at {r['rate_hz']:g} Hz", paced["step_us"]))
        lines.append(_row("  woken so late", paced["wake_up_us"]))
        lines.append(f"  {'missed deadlines':<22}{r['missed_deadlines']:>14}")
    lines.append(f"  {'processor time':<22}{r['cpu_us_per_step']:>14,.0f}   with the threads of bus and log")
    return "\n".join(lines)


def _parts(r: dict[str, Any]) -> str:
    lines = [_title("Part by part [us]"), f"  {'':<12}{'median':>8}{'p99':>8}{'mean':>8}"]
    total = sum(p["mean"] for p in r["parts_us"].values()) or 1.0
    for name, times in r["parts_us"].items():
        bar = "█" * round(14 * times["mean"] / total)
        lines.append(
            f"  {name:<12}{times['median']:>8,.0f}{times['p99']:>8,.0f}{times['mean']:>8,.0f}  "
            f"{DOC.get(name, ''):<44}{bar}"
        )
    return "\n".join(lines)


def _memory(r: dict[str, Any]) -> str:
    return "\n".join(
        [
            _title("Memory of the whole process [MB]"),
            f"  peak (VmHWM) {r['rss_peak_mb']:.1f}   at the end: anonymous {r['rss_anon_mb']:.1f}, "
            f"file-backed {r['rss_file_mb']:.1f}",
            f"  growth from a tenth of the steps to the end: {r['rss_growth_mb']:+.2f}, of it anonymous "
            f"{r['rss_growth_anon_mb']:+.2f}",
        ]
    )


def _peers(r: dict[str, Any]) -> str:
    if not r["peers"]:
        return ""
    lines = [_title("Computing of one step, beside the peers, all hot [us]", "twin/peer")]
    lines.append(
        f"  {'twin':<14}{'correct, known, learned, step, adapt (mean)':<44}{r['hybrid']['mean_us']:>8,.0f}"
    )
    for name, doc in PEERS.items():
        ratio = r["ratios"][f"hybrid_over_{name}"]
        lines.append(f"  {name:<14}{doc:<44}{r['peers'][name]['median_us']:>8,.0f}{ratio:>10.2f}")
    lines.append(
        f"  in the loop, caches cold: {r['computing_us']:,.0f}, and gates and predictions, which no "
        f"peer has, {r['more_us']:,.0f}"
    )
    return "\n".join(lines)


def _ahead(r: dict[str, Any]) -> str:
    if not r["look_ahead"]:
        return ""
    lines = [_title("Look-ahead of 120 s by the equations, outside the tick [ms]")]
    for who, found in r["look_ahead"].items():
        times = "   ".join(
            f"{name.split('_')[1]} steps {ms:,.0f}" for name, ms in found.items() if name.endswith("_ms")
        )
        lines.append(f"  {who:<12}{times}   ends {100.0 * found['apart_m']:.1f} cm apart")
    return "\n".join(lines)


def _counts(r: dict[str, Any]) -> str:
    if not r["instructions"]:
        return ""
    lines = [_title("Instructions of one step (valgrind), the same on every run")]
    lines += [f"  {name:<14}{count:>14,}   {COUNTED[name]}" for name, count in r["instructions"].items()]
    return "\n".join(lines)


def _cortex(r: dict[str, Any]) -> str:
    c = r["cortex_a72"]
    a, median, tail = c["anchor"], c["step_ms_median_range"], c["step_ms_p999_range"]
    return "\n".join(
        [
            _title("Estimate for a Cortex-A72 at 1.5 GHz [ms]", "not measured"),
            f"  x{c['factor']:g} (x{c['factor_low']:g} to x{c['factor_high']:g})   "
            f"median {c['step_ms_median']:.2f} ({median[0]:.2f} to {median[1]:.2f})   "
            f"p99.9 {c['step_ms_p999']:.2f} ({tail[0]:.2f} to {tail[1]:.2f})",
            "  published single-thread ratios of current x86-64 cores, and their geometric mean",
            f"  anchor: N-body in Python takes {a['nbody_us']:.1f} us here, "
            f"{a['nbody_us_cortex_a72']:.1f} us on a Pi 4 (published): x{a['ratio']:.2f}, by which",
            f"  median {a['ratio'] * r['step_us']['median'] * 1e-3:.2f}   p99.9 "
            f"{a['ratio'] * r['step_us']['p999'] * 1e-3:.2f}",
        ]
    )


def _verdict(r: dict[str, Any]) -> str:
    budget = f"{r['budget']['step_ms']:g} ms (p99.9, {r['target']}) and {r['budget']['rss_mb']:g} MB (peak)"
    if r["within_budget"]:
        return f"\nWithin budget: {budget}. Next: twin run --example-config"
    return f"\nNOT within budget: {budget}: " + "; ".join(r["over_budget"])
