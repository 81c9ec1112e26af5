"""The pond's runs: which the model is calibrated on, what is asked, and what the page says of the answers."""

import os
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bench.decisions.pond import pond_voyage
from bench.real.esso_osaka import REFERENCES, chosen, main, questions
from bench.real.esso_page import HEAD, page
from twin.recording.voyage import Voyage

PAGE = Path(__file__).parents[2] / "docs" / "results" / "real-esso-osaka.md"
DATA = Path(os.environ.get("SHIPTWIN_DATA", ".")) / "esso_osaka"


def run(name, wind):
    t = np.arange(60.0)
    columns = {"surge_velocity_mps": np.full(60, 0.3), "sway_velocity_mps": np.zeros(60)}
    return Voyage(name, t, columns | {"true_wind_speed_mps": np.full(60, wind)})


@pytest.fixture
def runs():
    kinds = [f"zigzag_{i}" for i in range(7)] + [f"turn_{i}" for i in range(3)] + ["random_1", "random_2"]
    return [run(name, 3.0 + (7 * i) % 12) for i, name in enumerate(kinds)]


def test_the_model_is_calibrated_on_the_calmest_runs(runs):
    wind = {v.name: v["true_wind_speed_mps"][0] for v in runs if "random" not in v.name}
    first, second = (chosen(runs, r) for r in REFERENCES)
    assert [v.name for v in first] == sorted(wind, key=wind.get)[:5]
    assert second[:5] == first and [v.name for v in second[5:]] == ["random_2"]


def test_no_question_is_asked_of_a_reference_run(runs):
    references = {v.name for r in REFERENCES for v in chosen(runs, r)}
    asked = list(questions(runs))
    assert not references & {v.name for a in asked for v in a.voyages}
    alone = {a.of for a in asked if len(a.voyages) == 1}
    assert len(alone) == 5 and {a.wind for a in asked} == {"hidden", "given"}
    assert len({a.key() for a in asked}) == len(asked) == (5 + 1) * (2 * len(REFERENCES) + 3)


def row(**said):
    return {
        "references": "calmest five",
        "of": "turn_1",
        "runs": 1,
        "windiness": 7.2,
        "wind": "given",
        "put": "nothing",
        "effects": [],
        "verdict": "nothing_missing",
        "reason": "nothing",
        "missing": [],
        "candidates": [],
        "path": {"error_without": 1.25, "horizon_s": 37.0, "error_floor": 1.5},
    } | said


def test_the_page_counts_single_runs_and_shows_each_answer():
    named = {"effect": "Wind", "error_with": 0.8}
    rows = [
        row(),
        row(wind="hidden", verdict="missing", reason="weather", missing=["Wind"], candidates=[named]),
        row(put="compass 2.5 deg", effects=["HeadingBias"], verdict="missing", missing=["RudderOffset"]),
        row(of="all turns", runs=3, verdict="unknown"),
    ]
    text = page(rows)
    assert "`Wind` named | >= 80 % | 1 of 1" in text and "nothing missing | >= 70 % | 1 of 1" in text
    assert "named, or `unknown` | <= 5 % | 0 of 1" in text and "a wrong name | | 1 of 1" in text
    assert "1.2 to 0.8 after 37 s (expected 1.5)" in text


def test_the_page_that_is_kept_begins_as_it_is_made_and_says_that_it_is_not_blind():
    kept = PAGE.read_text()
    assert kept.startswith(HEAD)
    assert "Not blind" in HEAD and "before anything was asked" not in kept
    named = re.findall(r"\(\.\./decisions/(00\d\d-[\w-]+\.md)\)", HEAD)
    assert named and all((PAGE.parents[1] / "decisions" / name).is_file() for name in named)


@pytest.mark.skipif(not DATA.is_dir(), reason="the runs of Esso Osaka are not here (SHIPTWIN_DATA)")
def test_a_run_is_read_through_its_map():
    v = pond_voyage(next(DATA.glob("zigzag_31-Jul-2020_13_04_24.csv")))
    assert v.duration_s == pytest.approx(140.2) and np.nanmax(np.abs(v["rudder_angle_deg"])) < 21.0
    assert np.nanmax(v["propeller_rate_rpm"]) == pytest.approx(1000.0)
    assert replace(v).name.startswith("zigzag")


def test_a_folder_without_the_runs_is_said(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["esso", str(tmp_path / "out"), "--data", str(tmp_path)])
    with pytest.raises(SystemExit) as stopped:
        main()
    assert stopped.value.code == 2 and "Set SHIPTWIN_DATA" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
