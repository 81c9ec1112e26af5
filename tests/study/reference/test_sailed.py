"""What a verb reads of a voyage that it is given: any file or folder that can be read."""

import pytest

from twin.commands.story import MONDAY, SHIP, TUESDAY
from twin.errors import DataError
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.study.reference.derivatives import noted
from twin.study.reference.sailed import own_references, read_all, samples_hash


def test_a_folder_of_tables_is_read_and_known_by_its_samples(tmp_path):
    """Test: a voyage as two tables in a folder, given once and given twice. Expected: its track, and the hash of
    its samples; a folder given twice is refused as a file is."""
    pytest.importorskip("pandas")
    table, folder = read_voyage(MONDAY).to_dataframe(), tmp_path / "monday"
    folder.mkdir()
    controls = ["rudder_angle_deg", "propeller_rate_rpm"]
    table[controls].to_csv(folder / "controls.csv")
    table.drop(columns=controls).to_csv(folder / "motion.csv")
    ship = load(SHIP)
    (made,) = read_all([str(folder)], ship)
    assert made.sha256 == samples_hash(read_voyage(folder)) and len(made.voyage) == len(table)
    with pytest.raises(DataError, match="the same voyage"):
        read_all([str(folder), str(folder)], ship)


def test_a_ship_knows_the_voyages_that_it_was_calibrated_on_by_their_files_and_by_their_samples():
    """Test: a ship that was calibrated on Monday's file, and one that was on its samples. Expected: both know
    Monday, neither knows Tuesday, and without the file only its samples tell."""
    voyages, files = [read_voyage(MONDAY), read_voyage(TUESDAY)], [str(MONDAY), str(TUESDAY)]
    ship = load(SHIP)
    of_file = noted(ship, "structural", {"voyages": [{"sha256": read_all(files[:1], ship)[0].sha256}]})
    of_samples = noted(ship, "structural", {"voyages": [{"sha256": samples_hash(voyages[0])}]})
    assert own_references(of_file, voyages, files) == ["monday"] == own_references(of_samples, voyages, files)
    assert own_references(of_file, voyages) == [] and own_references(of_samples, voyages) == ["monday"]
