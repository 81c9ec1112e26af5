"""The budget: a short run of the whole loop in its own process, and what is made of its numbers."""

import json
import subprocess
import sys

import pytest

from bench.tick import terminal_table as tick_table
from bench.tick.budget import against_budgets

# at 100 Hz the warm-up of the paced run takes half the time
SHORT = ["--steps", "120", "--paced", "30", "--rate", "100", "--no-peers", "--no-instructions"]


def bench(*arguments):
    command = [sys.executable, "-m", "bench.cli", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=240)


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    """One short run with a wide budget: (finished process, its JSON)."""
    path = tmp_path_factory.mktemp("bench") / "r.json"
    done = bench(*SHORT, "--budget-ms", "10000", "--budget-mb", "10000", "--json", str(path))
    assert path.exists(), done.stdout + done.stderr
    return done, json.loads(path.read_text())


def test_a_short_run_of_the_whole_loop_is_good(short):
    done, result = short
    assert done.returncode == 0, done.stdout + done.stderr
    assert result["within_budget"] is True
    assert result["modes"]["hybrid"] > 0.98 * sum(result["modes"].values())  # else it did not do all its work
    assert result["messages_per_step"] > 0.5
    assert result["log"]["written"] > 120


def test_the_whole_process_stays_inside_its_budget_of_memory(short):
    """Expected: bus, log, network and adaptation loaded, at most 48 MB at the peak; half of it is other
    people's pages."""
    assert short[1]["rss_peak_mb"] < 48.0


def test_the_json_holds_what_the_contract_says(short):
    result = short[1]
    assert set(result["step_us"]) == {"median", "p99", "p999", "max"}
    top = {"schema_version", "steps", "missed_deadlines", "rss_peak_mb", "rss_anon_mb", "peers"}
    assert top <= set(result)
    assert set(result["budget"]) == {"step_ms", "rss_mb"}
    names = {"factor_low", "factor", "factor_high", "step_ms_median", "step_ms_p999"}
    assert names <= set(result["cortex_a72"])
    assert all({"median", "p99"} <= set(part) for part in result["parts_us"].values())


def test_the_parts_are_there_and_their_sum_is_less_than_the_step(short):
    result = short[1]
    assert {"read", "known", "learned", "adapt", "publish", "record"} <= set(result["parts_us"])
    assert sum(p["median"] for p in result["parts_us"].values()) < 1.5 * result["step_us"]["median"]


def test_the_table_names_every_part_and_fits_a_terminal(short):
    done, result = short
    for part in result["parts_us"]:
        assert part in done.stdout
        assert part in tick_table.DOC
    assert max(len(line) for line in done.stdout.splitlines() if "note:" not in line) <= 100


def measured(step_p999_us=1000.0, peak_mb=40.0):
    """A measurement as the loop's process gives it."""
    step = {"median": 200.0, "p99": 300.0, "p999": step_p999_us, "max": step_p999_us}
    memory = {"peak_mb": peak_mb, "now_mb": 30.0, "anon_mb": 20.0, "file_mb": 10.0}
    return {
        "step_us": step,
        "memory": memory,
        "growth_mb": 0.0,
        "growth_anon_mb": 0.0,
        "missed_deadlines": 0,
        "messages_per_step": 1.0,
        "cpu_us_per_step": 200.0,
        "mode": "hybrid",
        "modes": {"hybrid": 1},
        "reasons": [],
        "notes": [],
        "log": {"written": 1},
        "parts_us": {"known": {"median": 9.0, "p99": 12.0, "mean": 10.0}},
    }


def judge(target="here", **numbers):
    from argparse import Namespace

    args = Namespace(steps=1000, rate=50.0, target=target, budget_ms=12.0, budget_mb=48.0)
    peers = {"hybrid": {"mean_us": 10.0}, "peers": {"ekf": {"median_us": 20.0}}, "look_ahead": {}}
    return against_budgets(args, measured(**numbers), None, peers, {}, "bundled")


def test_within_both_budgets_is_good():
    assert judge()["within_budget"] is True


def test_a_slow_tail_misses_the_budget():
    result = judge(step_p999_us=13000.0)
    assert result["within_budget"] is False
    assert "13.0 ms" in result["over_budget"][0]


def test_too_much_memory_misses_the_budget():
    assert "48.1 MB" in judge(peak_mb=48.1)["over_budget"][0]


def test_the_target_scales_the_time():
    """Test: 4 ms here. Expected: kept here, missed on a Cortex-A72, which is some four times slower."""
    assert judge("here", step_p999_us=4000.0)["within_budget"] is True
    assert judge("cortex-a72", step_p999_us=4000.0)["within_budget"] is False


def test_the_ratio_to_a_peer_is_the_twins_step_over_its_step():
    assert judge()["ratios"]["hybrid_over_ekf"] == 0.5


def test_a_missed_budget_is_exit_code_3():
    done = bench(*SHORT, "--budget-mb", "1")
    assert done.returncode == 3, done.stderr
    assert "NOT within budget" in done.stdout


def test_too_few_steps_are_refused_in_one_line():
    done = bench("--steps", "3")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1 and "--steps 3" in done.stderr
