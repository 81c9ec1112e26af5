"""Answers on disk: whole, once, gathered after an interruption."""

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from twin.errors import DataError, TwinError
from twin.study.fleet.ask import Job, failed, key_of
from twin.study.fleet.row_store import Store, lasting


def job(voyage="a", version="1"):
    return Job("Alma", "alma.toml", "s", f"{voyage}.csv", voyage, None, None, version)


def row(effect="Wind", **of):
    return failed(job(**of), "", "") | {"failed": None, "failed_as": None, "effect": effect, "named": True}


def test_rows_come_back_as_they_were_put_in(tmp_path):
    """Expected: with the numbers of a cause and the words beside it."""
    store = Store(tmp_path)
    size = {"name": "c", "value": 0.5, "low95": 0.25, "high95": 0.75, "unit": "-", "at_box_end": False}
    given = row() | {"parameters": [size], "cannot_be_told_from": ["Current"], "p_value": 0.125}
    with store.alone():
        store.add([given, row("Current")])
    (back, second) = store.rows()[key_of(vars(job()))]
    assert back["parameters"] == [size | {"in_ship_file": None}]
    assert (back["p_value"], back["cannot_be_told_from"], second["effect"]) == (0.125, ["Current"], "Current")
    assert pq.read_table(tmp_path / "rows.parquet").num_rows == 2 and not list((tmp_path / "parts").iterdir())


def test_what_an_interrupted_run_left_is_gathered_and_stands_once(tmp_path):
    store = Store(tmp_path)
    with store.alone():
        store.add([row()])
    store.add([row(), row("Current")])  # asked again, and cut off before the run ended
    store.add([row(voyage="b")])
    with Store(tmp_path).alone():
        pass
    effects = [r["effect"] for r in pq.read_table(tmp_path / "rows.parquet").to_pylist()]
    assert sorted(effects) == ["Current", "Wind", "Wind"] and not list((tmp_path / "parts").iterdir())


def test_another_version_ship_voyage_or_map_is_another_question():
    keys = {key_of(vars(job(**of))) for of in ({}, {"voyage": "b"}, {"version": "2"})}
    assert len(keys) == 3 and len({key_of(vars(job())), key_of(vars(job()))}) == 1


@pytest.mark.parametrize("kind, lasts", [("DataError", True), ("KilledWorker", False), ("TwinError", False)])
def test_a_voyage_that_cannot_be_used_is_known_and_a_worker_that_died_is_asked_again(kind, lasts):
    assert lasting([failed(job(), "why", kind)]) is lasts
    assert lasting([row()]) and not lasting([])


def test_two_programs_do_not_add_to_one_folder(tmp_path):
    with (
        Store(tmp_path).alone(),
        pytest.raises(TwinError, match="another `twin fleet` is at work"),
        Store(tmp_path).alone(),
    ):
        pass


def test_a_file_that_is_no_parquet_and_a_place_that_is_no_folder_are_said(tmp_path):
    (tmp_path / "rows.parquet").write_text("no rows")
    with pytest.raises(DataError, match=r"rows.parquet: cannot be read as Parquet"):
        Store(tmp_path).rows()
    with pytest.raises(TwinError, match="Choose another folder with -o"):
        Store(Path(tmp_path / "rows.parquet"))
