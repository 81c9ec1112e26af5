"""What follows an answer of the fleet: more voyages of the ship, and what their owner makes of them."""

from types import SimpleNamespace

import numpy as np
import pytest

from bench.fleet import kept_ships
from bench.fleet.addition_proof import table
from bench.fleet.kept_ships import answers
from bench.fleet.plausibility import build
from bench.fleet.several_voyages import table as table_together
from bench.fleet.voyage_plan import FleetCase, changed, sailed_again
from twin.errors import DataError


@pytest.fixture(scope="module")
def ship():
    return build("planing", 3)


def test_a_further_voyage_has_the_same_fault_on_another_day(ship):
    case = FleetCase("planing", 3, 1, "pair", {"HeadingBias": 1.0, "Current": 1.0})
    one, two = (sailed_again(ship, case, k, False) for k in (0, 1))
    bias = changed(ship, case)[2]["HeadingBias"].flaws["heading"]
    assert one.flaws == two.flaws and one.flaws["heading"] == pytest.approx(bias)
    assert one.weather != two.weather
    assert one.time_s.size != two.time_s.size or not np.array_equal(
        one.columns["rudder_angle_deg"], two.columns["rudder_angle_deg"]
    )


def test_a_healthy_further_voyage_differs_by_the_fault_alone(ship):
    case = FleetCase("planing", 3, 1, "single", {"HeadingBias": 1.0})
    ill, well = (sailed_again(ship, case, 0, healthy) for healthy in (False, True))
    assert "heading" not in well.flaws and well.weather == ill.weather
    assert np.allclose(ill.columns["yaw_rate_degps"], well.columns["yaw_rate_degps"], equal_nan=True)
    turned = ill.columns["heading_true_north_deg"] - well.columns["heading_true_north_deg"]
    mean = np.degrees(np.angle(np.nanmean(np.exp(1j * np.radians(turned)))))
    assert mean == pytest.approx(np.degrees(ill.flaws["heading"]), abs=1.0)


def added(accepted, right, before, after, healthy):
    sizes = {"before_m": before, "after_m": after, "healthy_m": healthy}
    return {"accepted": accepted, "right": right, "by_thirds": {"accepted": accepted}} | sizes


def test_only_right_names_that_could_pay_count_as_owed():
    rows = [
        added(True, True, 10.0, 4.0, 4.0),
        added(False, True, 10.0, 5.0, 4.0),
        added(False, True, 10.0, 9.5, 9.0),
        added(True, False, 10.0, 9.0, 4.0) | {"kind": "pair"},
        {"failed": "too short"},
    ]
    said = table(rows)
    assert "| 2 | 1 of 2, 50%" in said[2] and "| 1 | 0 of 1" in said[3] and "| 1 | 1 of 1" in said[4]
    assert said[-1] == "Could not be asked: 1."


def test_answers_about_more_voyages_stand_beside_those_about_one():
    blind = {"missing": [], "verdict": "nothing_missing"}
    named = {"missing": ["GyroBias"], "verdict": "missing"}
    row = {"key": "a", "kind": "single", "hidden": {"GyroBias": 1.0}, "gains": True}
    rows = [
        row | {"1": blind, "2": blind, "3": named},
        row | {"1": blind, "2": {"failed": "gap"}, "3": named},
    ]
    said = table_together(rows)
    assert said[2].startswith("| single cause, gains | 0 of 1") and said[2].count("1 of 1") == 1
    assert said[-1] == "Could not be asked: 1 of 2."


def test_a_folder_without_answers_says_how_they_are_made(tmp_path):
    with pytest.raises(DataError, match="no answers in it"):
        answers(tmp_path)


def test_a_voyage_whose_process_ended_is_told_and_asked_the_next_time(tmp_path, monkeypatch, capsys):
    (tmp_path / "rows.jsonl").write_text('{"key": "mmg-0-1", "missing": []}\n')
    dead = [SimpleNamespace(answer=None, why="no process", job=(str(tmp_path), {"key": "mmg-0-1"}))]
    well = [SimpleNamespace(answer={"key": "mmg-0-1", "2": {}}, why=None, job=dead[0].job)]
    asked = []
    for one in (dead, well):
        monkeypatch.setattr(
            kept_ships, "spread", lambda ask, jobs, workers, one=one: asked.append(jobs) or one
        )
        found = list(kept_ships.ask_again([tmp_path], "more.jsonl", lambda row: True, print, 1))
    assert [len(jobs) for jobs in asked] == [1, 1] and found == [well[0].answer]
    assert "mmg-0-1: no process" in capsys.readouterr().err
