"""One voyage asked: its ship knows it, or a file is another one than was listed."""

import pytest

import twin
from tests.study.fleet.rows import copied
from twin.commands.story import SHIP
from twin.study.fleet.ask import ask, job_of
from twin.study.fleet.listing import FleetShip, FleetVoyage, sha256_of
from twin.study.reference.derivatives import noted
from twin.study.reference.sailed import sailed

COLUMNS = {
    "north_m": "m",
    "east_m": "m",
    "heading_true_north_deg": "deg",
    "rudder_angle_deg": "deg",
    "propeller_rate_rpm": "rpm",
}


@pytest.fixture
def voyage(short, tmp_path):
    """Monday, read by a map."""
    entries = [f'[columns.{n}]\ncolumn = "{n}"\nunit = "{unit}"\n' for n, unit in COLUMNS.items()]
    (tmp_path / "map.toml").write_text("\n".join(['[time]\ncolumn = "time_utc"\nunit = "iso"\n', *entries]))
    return FleetVoyage(short / "monday.csv", tmp_path / "map.toml")


def job(file, voyage):
    return job_of(FleetShip("Alma", file, sha256_of(file), twin.Ship.load(file), (voyage,)), voyage)


def test_a_ship_that_was_calibrated_in_python_knows_its_reference_voyages(voyage, tmp_path):
    """Test: a ship file that keeps the hash of Monday's samples, as `twin.calibrate` writes it. Expected: Monday is
    a reference voyage, and is not diagnosed."""
    ship, monday = twin.Ship.load(SHIP), twin.read_voyage(voyage.path, map=voyage.map)
    knows = noted(ship, "structural", {"voyages": [sailed(monday, ship).provenance()]})
    knows.save(tmp_path / "ship.toml")
    (row,) = ask(job(tmp_path / "ship.toml", voyage))
    assert row["verdict"] == "reference" and row["failed"] is None


def test_a_map_that_changed_since_it_was_listed_gives_no_answer(voyage, tmp_path):
    copied(SHIP, tmp_path / "ship.toml")
    listed = job(tmp_path / "ship.toml", voyage)
    with voyage.map.open("a") as file:
        file.write("# another\n")
    (row,) = ask(listed)
    assert row["failed_as"] == "TwinError" and "map.toml: changed while the fleet was asked" in row["failed"]
