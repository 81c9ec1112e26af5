"""What the page says of a step's cost and of the closed loop: Table 9 and Fig. 5."""

from typing import Any

PAPER_9 = {"analytic": (8.0, 12), "lstm": (34.0, 215)}  # ms, MB


def nine(t: dict[str, Any]) -> list[str]:
    """Table 9, from `twin-bench --json`."""
    lines = ["", "## Table 9: cost of a step", ""]
    if "9" not in t:
        return [
            *lines,
            "`twin-bench` measures it: [tick.md](tick.md); `--tick FILE.json` brings its figures here.",
        ]
    r, board = t["9"], t["9"]["cortex_a72"]
    lines += [
        "From `twin-bench --json` on this machine; the paper's are a Cortex-A72's. The loop's step holds "
        "everything on board (sensors, observer, "
        "guard, certificate, log), the others one step of the "
        "model.",
        "",
        "| | here us, median | paper ms | paper MB |",
        "|---|---|---|---|",
    ]
    for name, (ms, mb) in PAPER_9.items():
        lines.append(f"| {name} | {r['peers'][name]['median_us']:.0f} | {ms:g} | {mb} |")
    loop, peak = r["step_us"], r["rss_peak_mb"]
    return [
        *lines,
        f"| EKF | {r['peers']['ekf']['median_us']:.0f} | | |",
        f"| the whole loop | {loop['median']:.0f} (p99.9 {loop['p999']:.0f}) | 12 | 48 (here {peak:.1f} at "
        "the peak) |",
        "",
        f"On a Cortex-A72, by published ratios and not measured: {board['step_ms_median']:.2f} ms, p99.9 "
        f"{board['step_ms_p999']:.1f} ms.",
    ]


def five(rows: list[dict[str, Any]]) -> list[str]:
    lines = [
        "",
        "## Fig. 5: the closed loop",
        "",
        "+15 deg through a reference of third order, gust of 10 m/s from abeam at 7 L/U for one L/U, rudder "
        "by the inverse of the model "
        "with tau_corr (bench/paper/closed.py). Worst of the seeds unless it says mean. Goals: settled "
        "within 5 L/U, overshoot at most "
        "8 %, steady error at most 0.02 of the step, rudder short of 35 deg. The paper settles in 20 to 25 "
        "s: at a Froude scale of 1:64, "
        "not with a ship of 320 m.",
        "",
        "| controller | sea | runs | settled L/U, mean (worst) | full scale s | 1:64 s (paper 20-25) | "
        "overshoot % (8) | steady error (0.02) "
        "| gust deg | rudder deg | deg/s | met |",
        "|---" * 12 + "|",
    ]
    return lines + [
        f"| {x['mode']} | {x['scenario']} | {x['runs']} | {x['settle_lengths_mean']:.2f} "
        f"({x['settle_lengths_max']:.2f}) "
        f"| {x['settle_s_full_scale']:.0f} | {x['settle_s_model_1_64']:.1f} | {x['overshoot_percent']:.1f} | "
        f"{x['steady_error_max']:.4f} "
        f"| {x['gust_deg']:.2f} | {x['rudder_deg']:.1f} | {x['rudder_degps']:.2f} | "
        f"{'yes' if x['met'] else 'no'} |"
        for x in rows
    ]
