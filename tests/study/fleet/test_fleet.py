"""`twin fleet` from files to table, JSON, page and rows: good voyages beside broken ones, and a run that is
killed."""

import json
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pyarrow.parquet as pq
import pytest

import twin
from tests.study.fleet.rows import copied
from tests.thorough import thorough
from twin import cli
from twin.api.json_key import absent_keys, unknown_paths
from twin.api.json_keys import KEYS
from twin.commands.story import SHIP
from twin.errors import TwinError, UsageError
from twin.study.fleet.listing import sha256_of


@pytest.fixture(scope="module")
def yard(short, tmp_path_factory):
    """Two tankers: one with a voyage, a copy of it, a broken one and one that is not there; one with another
    voyage."""
    folder = tmp_path_factory.mktemp("yard")
    for name in ("alma", "berta"):
        (folder / name).mkdir()
        copied(SHIP, folder / name / "ship.toml")
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


def command(yard, results, *words):
    return [sys.executable, "-m", "twin.cli", "fleet", str(yard / "fleet.toml"), "-o", str(results), *words]


@pytest.fixture(scope="module")
def finished(yard, tmp_path_factory):
    """Killed (kill -9) as soon as the third of four voyages has its answer; run again to its end. The second
    run's words, and the folder of the rows."""
    results = tmp_path_factory.mktemp("results")
    began = subprocess.Popen(
        command(yard, results, "--workers", "1"), stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
    )
    until = time.monotonic() + 300.0
    while len(list((results / "parts").glob("[!.]*.parquet"))) < 3:
        assert began.poll() is None and time.monotonic() < until
        time.sleep(0.02)
    began.send_signal(signal.SIGKILL)
    began.wait(20)
    assert not (results / "rows.parquet").exists()
    more = ["--workers", "2", "--json", str(results / "f.json"), "--report", str(results / "f.html")]
    return subprocess.run(command(yard, results, *more), capture_output=True, text=True, timeout=300), results


@pytest.fixture(scope="module")
def asked(finished, yard):
    """(the result in Python, of answers that are known; folder of the rows)."""
    return twin.fleet(yard / "fleet.toml", finished[1]), finished[1]


@thorough
def test_a_run_that_is_killed_goes_on_where_it_stopped(finished):
    """Expected: what was answered is not asked again, but the voyage without a file; every row is there
    once."""
    done, results = finished
    assert done.returncode == 0, done.stderr
    assert "2 of 4 voyages are known, 2 are asked" in done.stderr
    assert done.stdout.splitlines()[-1].startswith("next: twin diagnose ")
    rows = pq.read_table(results / "rows.parquet").to_pylist()
    causes = [(r["voyage"], r["effect"]) for r in rows]
    assert len(causes) == len(set(causes))
    assert {v for v, _ in causes} == {"monday", "tuesday", "broken", "gone"}


def test_the_command_writes_the_json_and_the_page_of_the_result(finished, asked):
    found = json.loads((finished[1] / "f.json").read_text())
    keys = ("command", "rows", "asked_now")
    assert {k: v for k, v in found.items() if k not in keys} == {
        k: v for k, v in asked[0].to_dict().items() if k not in keys
    }
    assert found["command"].endswith("--workers 2") and found["command"].startswith("twin fleet ")
    assert "<title>" in (finished[1] / "f.html").read_text()


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
    assert (found["verdict"], found["reason"]) == (alone["verdict"], alone["reason"])
    assert found["position_mae_m"] == pytest.approx(compared["horizons"][-1]["position_mae_m"], rel=1e-6)
    assert {c["effect"] for c in found["causes"]} == {c["effect"] for c in alone["candidates"]}
    rows = pq.read_table(asked[1] / "rows.parquet").to_pylist()
    (facts,) = {r["facts"] for r in rows if r["voyage"] == "tuesday"}
    kept = json.loads(facts)  # another process rounds its last bits otherwise
    assert set(kept) == set(alone["facts"])
    assert kept["error_nothing"] == pytest.approx(alone["facts"]["error_nothing"], rel=1e-3)


def test_the_json_is_as_documented(asked):
    assert unknown_paths(KEYS["fleet"], asked[0].to_dict()) == []
    assert absent_keys(KEYS["fleet"], asked[0].to_dict()) == []


def test_a_result_is_a_table_a_line_and_a_page(asked):
    result = asked[0]
    assert set(result.to_dataframe()["ship"]) == set(result.ships) == {"Alma", "Berta"}
    assert len(repr(result)) < 300 and "2 ships" in repr(result)
    assert result._repr_html_().startswith("<iframe srcdoc=")
    assert "not judged:" in result.text() and any("6 reference voyages" in line for line in result.text())


def test_another_run_asks_what_is_not_there_and_what_changed(asked, yard):
    """Expected: the voyage without a file, of which nobody knows whether it changed; then one that did."""
    assert asked[0].to_dict()["asked_now"] == 1
    (yard / "alma" / "monday.csv").touch()  # the same bytes
    (yard / "alma" / "broken.csv").write_text("time_s,heading\n0,2\n")
    assert twin.fleet(yard / "fleet.toml", asked[1]).to_dict()["asked_now"] == 2


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


def test_a_fleet_of_references_alone_ends_with_what_to_do_and_no_traceback(short, tmp_path, capsys):
    """Test: the only voyage of each ship is one that it was calibrated on."""
    (tmp_path / "alma").mkdir()
    shutil.copy(short / "monday.csv", tmp_path / "alma")
    ship = twin.Ship.load(SHIP)
    used = {"sha256": sha256_of(short / "monday.csv")}
    structural = ship.notes["structural"]
    own = structural | {"voyages": [*structural["voyages"], used]}
    replace(ship, notes={**ship.notes, "structural": own}).save(tmp_path / "alma" / "ship.toml")
    assert cli.main(["fleet", str(tmp_path), "-o", str(tmp_path / "r"), "--workers", "1"]) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("next: add voyages to judge") and "twin fleet" in last


def test_a_fleet_in_python_is_refused_as_on_the_command_line(yard, tmp_path, monkeypatch):
    with pytest.raises(UsageError, match="workers = 0: at least 1 is needed"):
        twin.fleet(yard / "fleet.toml", tmp_path, workers=0)
    monkeypatch.setattr("twin.api.fleet.find_spec", lambda name: None)
    for asked in ({"workers": 2}, {"scheduler": "tcp://127.0.0.1:1"}):
        with pytest.raises(TwinError, match=r"pip install 'shiptwin\[fleet\]'"):
            twin.fleet(yard / "fleet.toml", tmp_path, **asked)
