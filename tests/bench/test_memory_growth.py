"""The slope of the service's memory: a healthy service passes, a leak is found."""

import json

import pytest

from bench import memory_growth
from bench.cli import main
from bench.memory_growth import CHILD, slope
from tests.thorough import thorough
from twin.errors import ThresholdError, UsageError

MOST = ["--most-mb", "70"]  # a slope over two minutes is no better than so; the planted leak is 180
SHORT = ["growth", "--hours", "0.04", "--rate-hz", "10", *MOST]
LEAK = """
from twin.live.log.segment import Segment
kept, close = [], Segment.close
Segment.close = lambda segment: (kept.append(b"x" * 500_000), close(segment))
"""


@thorough
def test_a_service_that_is_well_passes_and_has_done_all_its_work(tmp_path):
    """Test: 144 s at 10 Hz after 18 s of warm-up, a file each 15 min and each 10 s. Expected: every tick with the
    learned force, nearly all with a promise, nine messages a tick in the log, many files in the second process."""
    assert main([*SHORT, "--json", str(tmp_path / "g.json"), "--markdown", str(tmp_path / "g.md")]) == 0
    rows = json.loads((tmp_path / "g.json").read_text())["rows"]
    assert [row["change_s"] for row in rows] == [900.0, 10.0]
    assert rows[0]["files"] == 1 and 10 <= rows[1]["files"] <= 17
    for row in rows:
        assert row["ticks"] == 1620 and row["logged"] == 9 * 1620 and row["not_logged"] == 0
        assert row["hybrid"] > 0.9 and row["promised"] > 0.9
        assert len(row["readings_mb"]) == 120 and 15.0 < row["lowest_mb"] <= row["highest_mb"] < 60.0
    page = (tmp_path / "g.md").read_text()
    assert f"| 10 s | {rows[1]['files']} | 1620 |" in page and "at most 70 MB" in page


def test_half_a_megabyte_kept_of_each_file_is_exit_code_3(tmp_path, monkeypatch, capsys):
    """Test: a leak planted in the process, 180 MB an hour. Expected: found with the right size, said in one
    line."""
    monkeypatch.setattr(memory_growth, "CHILD", LEAK + CHILD)
    monkeypatch.setattr(memory_growth, "CHANGES_S", (10.0,))
    assert main([*SHORT, "--json", str(tmp_path / "g.json")]) == ThresholdError.exit_code
    (row,) = json.loads((tmp_path / "g.json").read_text())["rows"]
    assert 140.0 < row["mb_an_hour"] < 220.0
    said = capsys.readouterr().err
    assert "wanted: 70 at most" in said and said.count("\n") == 1


def test_hours_too_few_for_the_readings_are_a_wrong_use(capsys):
    assert main(["growth", "--hours", "0.0001"]) == main(["growth", "--hours", "-1"]) == UsageError.exit_code
    assert "120 readings" in capsys.readouterr().err


def test_a_slope_by_hand():
    """Expected: 2 MB/h of a line; of 0, 1, 0, 1 at 0, 1, 2, 3 h the slope 0.2, and half the interval by hand: residuals
    -0.2, 0.6, -0.6, 0.2 give ss 0.8, over two degrees of freedom and 5 h^2 a standard error of sqrt(0.08);
    neighbours differ in sign, so it is not widened. Blocks of equal residuals widen it."""
    assert slope([0.0, 1.0, 2.0], [5.0, 7.0, 9.0]) == pytest.approx((2.0, 0.0))
    assert slope([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 0.0, 1.0]) == pytest.approx((0.2, 1.98 * 0.08**0.5))
    hours = [float(i) for i in range(40)]
    apart, alike = [i % 2 for i in range(40)], [i // 5 % 2 for i in range(40)]
    assert slope(hours, alike)[1] > 1.5 * slope(hours, apart)[1]
