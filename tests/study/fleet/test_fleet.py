"""`twin fleet` from files to table, JSON, page and rows: good voyages beside broken ones, and a run that is
killed."""

import json
import shutil
import signal
import subprocess
import sys
import time

import pyarrow.parquet as pq
import pytest

import twin
from twin import cli
from twin.api.json_key import absent_keys, unknown_paths
from twin.api.json_keys import KEYS
from twin.commands.story import SHIP


@pytest.fixture(scope="module")
def yard(short, tmp_path_factory):
    """Two tankers: one with a voyage, a copy of it, a broken one and one that is not there; one with another
    voyage."""
    folder = tmp_path_factory.mktemp("yard")
    for name in ("alma", "berta"):
        (folder / name).mkdir()
        shutil.copy(SHIP, folder / name / "ship.toml")
    shutil.copy(short / "monday.csv", folder / "alma" / "monday.csv")
    shutil.copy(short / "monday.csv", folder / "alma" / "monday-again.csv")
    (folder / "alma" / "broken.csv").write_text("time_s,heading\n0,1\n")
    shutil.copy(short / "tuesday.csv", folder / "berta" / "tuesday.csv")
    (folder / "fleet.toml").write_text(
        '[[ships]]\nname = "Alma"\nfile = "alma/ship.toml"\n'
        'voyages = ["alma/broken.csv", "alma/gone.csv", "alma/monday.csv", "alma/monday-again.csv"]\n'
        '[[ships]]\nname = "Berta"\nfile = "berta/ship.toml"\nvoyages = "berta/*.csv"\n'
        'tags = { period = "July" }\n'
    )
    return folder


@pytest.fixture(scope="module")
def asked(yard, tmp_path_factory):
    """(result, folder of the rows)."""
    results = tmp_path_factory.mktemp("results")
    return twin.fleet(yard / "fleet.toml", results), results


def voyages(result, ship):
    (found,) = [s for s in result.to_dict()["ships"] if s["ship"] == ship]
    return {v["file"].rpartition("/")[2]: v for v in found["voyages"]}


def test_a_broken_voyage_a_copy_and_one_that_is_gone_are_rows_and_the_others_go_on(asked):
    found = voyages(asked[0], "Alma")
    assert "there is no such file" in found["gone.csv"]["failed"]
    assert "is the same voyage as" in found["monday-again.csv"]["failed"]
    assert "broken.csv" in found["broken.csv"]["failed"]
    assert found["monday.csv"]["failed"] is None and found["monday.csv"]["verdict"]
    assert asked[0].to_dict()["voyages"] == {"listed": 5, "judged": 2, "references": 0, "failed": 3}


def test_a_voyage_has_the_answer_of_diagnose_and_compare(asked, short):
    ship, voyage = twin.Ship.load(SHIP), twin.read_voyage(short / "tuesday.csv")
    alone, compared = twin.diagnose(ship, voyage).to_dict(), twin.compare(ship, voyage).to_dict()
    found = voyages(asked[0], "Berta")["tuesday.csv"]
    assert found["tags"] == {"period": "July"} and found["start_time_utc"].startswith("2026-07-02")
    assert (found["verdict"], found["sentence"]) == (alone["verdict"], alone["sentence"])
    assert found["position_mae_m"] == compared["horizons"][-1]["position_mae_m"]
    assert {c["effect"] for c in found["causes"]} == {c["effect"] for c in alone["candidates"]}
    rows = pq.read_table(asked[1] / "rows.parquet").to_pylist()
    (facts,) = {r["facts"] for r in rows if r["voyage"] == "tuesday"}
    assert json.loads(facts) == alone["facts"]


def test_the_json_is_as_documented(asked):
    assert unknown_paths(KEYS["fleet"], asked[0].to_dict()) == []
    assert absent_keys(KEYS["fleet"], asked[0].to_dict()) == []


def test_a_result_is_a_table_a_line_and_a_page(asked):
    result = asked[0]
    assert set(result.to_dataframe()["ship"]) == set(result.ships) == {"Alma", "Berta"}
    assert len(repr(result)) < 300 and "2 ships" in repr(result)
    assert result._repr_html_().startswith("<iframe srcdoc=")
    assert "not judged:" in result.text() and any("not controlled" in line for line in result.text())


def test_a_second_run_asks_what_is_not_there_and_what_changed(asked, yard):
    """Expected: the voyage without a file, of which nobody knows whether it changed, and one that did."""
    again = twin.fleet(yard / "fleet.toml", asked[1])
    assert again.to_dict()["asked_now"] == 1
    assert again.with_keys(asked_now=0).to_dict() == asked[0].with_keys(asked_now=0).to_dict()
    (yard / "alma" / "monday.csv").touch()  # the same bytes
    (yard / "alma" / "broken.csv").write_text("time_s,heading\n0,2\n")
    assert twin.fleet(yard / "fleet.toml", asked[1]).to_dict()["asked_now"] == 2


def test_a_run_that_is_killed_goes_on_where_it_stopped(short, tmp_path):
    """Test: kill -9 as soon as the first of two voyages has its answer. Expected: the next run asks the other
    alone, and every row is there once."""
    ship = tmp_path / "fleet" / "alma"
    ship.mkdir(parents=True)
    shutil.copy(SHIP, ship / "ship.toml")
    for name in ("monday.csv", "tuesday.csv"):
        shutil.copy(short / name, ship)
    line = [sys.executable, "-m", "twin.cli", "fleet", str(ship.parent), "-o", str(tmp_path / "r")]
    began = subprocess.Popen([*line, "--workers", "1"], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    until = time.monotonic() + 300.0
    while not list((tmp_path / "r" / "parts").glob("*.parquet")):
        assert began.poll() is None and time.monotonic() < until
        time.sleep(0.02)
    began.send_signal(signal.SIGKILL)
    began.wait(20)
    assert not (tmp_path / "r" / "rows.parquet").exists()
    done = subprocess.run(
        [*line, "--workers", "2", "--json", str(tmp_path / "f.json"), "--report", str(tmp_path / "f.html")],
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "1 of 2 voyages are known, 1 are asked" in done.stderr
    assert done.stdout.splitlines()[-1].startswith("next: twin diagnose ")
    assert json.loads((tmp_path / "f.json").read_text())["voyages"]["judged"] == 2
    assert "<title>" in (tmp_path / "f.html").read_text()
    rows = pq.read_table(tmp_path / "r" / "rows.parquet").to_pylist()
    causes = [(r["voyage"], r["effect"]) for r in rows]
    assert len(causes) == len(set(causes)) and {v for v, _ in causes} == {"monday", "tuesday"}


def test_what_is_wrong_with_the_command_is_one_line_and_its_exit_code(yard, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    gone = tmp_path / "gone.toml"
    gone.write_text(f'[[ships]]\nfile = "{SHIP}"\nvoyages = "nowhere.csv"\n')
    asks = [
        (["none.toml", "-o", "r"], 5, "none.toml: cannot be read"),
        ([str(gone), "-o", "r", "--workers", "0"], 2, "at least 1 is needed"),
        ([str(gone), "-o", "r", "--workers", "1"], 4, "not one voyage could be used"),
        ([str(gone), "-o", "r", "--json", "no/f.json"], 1, "no/f.json: cannot be written"),
    ]
    for words, code, said in asks:
        assert cli.main(["fleet", *words]) == code
        assert said in capsys.readouterr().err.strip().splitlines()[-1]
