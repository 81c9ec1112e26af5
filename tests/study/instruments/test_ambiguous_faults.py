"""A fault that the voyages cannot tell from another is named with it, and written nowhere."""

import json

import numpy as np
import pytest

import twin
from tests.study.instruments.test_instruments import EVERY, KEPT, LOG, RATE, voyage
from twin.cli import main
from twin.num import num
from twin.physics.ship import load
from twin.study.instruments.findings import FAULT_BAYES_FACTOR
from twin.study.instruments.unknowns import FAULTS


@pytest.fixture
def healthy(sail):
    """{column: (N,)} of twelve minutes of zigzags twice a second; neither rudder nor shaft."""
    return {name: column[::EVERY] for name, column in sail(720.0, seed=3).items() if name in KEPT}


@pytest.mark.parametrize("ship", [[], ["--ship", "kvlcc2"]])
def test_where_a_fault_is_not_told_from_another_no_file_is_written_and_the_answer_says_why(
    ship, healthy, write_csv, tmp_path, capsys
):
    """Test: a log 15 % too high, which on one voyage at one speed looks like a bias. Expected: both are named, no
    file, exit code 3, and one line that says which are not told apart and what would tell them."""
    out, answer = tmp_path / "corrected.toml", tmp_path / "answer.json"
    path = str(write_csv(healthy | {LOG: 1.15 * healthy[LOG]}))
    assert main(["instruments", path, *ship, "-o", str(out), "--json", str(answer)]) == 3
    (fault,) = json.loads(answer.read_text())["faults"]
    assert {fault["fault"], *fault["or_instead"]} == {"log_bias", "log_scale"} and not out.exists()
    said = capsys.readouterr().out.splitlines()
    (line,) = (x for x in said if x.startswith(f"{out} was not written: "))
    pair = " from ".join(FAULTS[f].words for f in (fault["fault"], *fault["or_instead"]))
    assert (
        f"these voyages do not tell {pair}, and neither is written; sail reciprocal" in line
        and "at two speeds" in line
    )
    assert any(x.startswith("next: twin instruments") and "OTHER-DAY" in x for x in said)


def test_what_is_told_is_written_beside_a_fault_that_is_not(healthy, write_csv, tmp_path, capsys):
    path = write_csv(healthy | {LOG: 0.7 + healthy[LOG], RATE: healthy[RATE] + np.degrees(0.001)})
    out = tmp_path / "corrected.toml"
    assert main(["instruments", str(path), "--ship", "kvlcc2", "-o", str(out)]) == 0
    assert {"GyroBias"} == {type(e).__name__ for e in load(out).effects} - {
        type(e).__name__ for e in load("kvlcc2").effects
    }
    said = capsys.readouterr().out.splitlines()
    assert any("do not tell speed log bias from speed log scale, and neither is written" in x for x in said)


def test_a_fault_is_seen_by_the_log_bayes_factor_that_is_shown_with_it(healthy, write_csv):
    """Test: a log that is off, by its scale or by a bias. Expected: what is said of the two together is above the
    limit of docs/instruments.md, and what tells one from the other is not."""
    found = twin.instruments(load("kvlcc2"), voyage(healthy | {LOG: 0.7 + healthy[LOG]}))
    (fault,) = found.data["faults"]
    assert fault["log_bayes_factor"] <= FAULT_BAYES_FACTOR < fault["log_bayes_factor_of_any"]
    shown = num(fault["log_bayes_factor_of_any"], 3)
    assert found.text()[0] == f"speed log bias (SpeedLogBias) or speed log scale: log Bayes factor {shown}"
    assert any("do not tell which" in x and "told above 5" in x for x in found.text())
    assert found.faults == ["log_bias"] and found.distinct == []
    assert "Speed log bias or speed log scale." in found.page()
