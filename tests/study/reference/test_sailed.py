"""What a verb reads of a voyage that it is given: any file or folder that can be read."""

import pytest

from twin.commands.story import MONDAY, SHIP
from twin.errors import DataError
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.study.reference.sailed import read_all, samples_hash


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
