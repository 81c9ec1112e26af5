"""The memory of `twin calibrate`, measured as the page has it, on one short voyage."""

import json

from bench.cli import main
from tests.thorough import thorough
from twin.errors import ThresholdError


@thorough
def test_the_peak_is_measured_and_more_than_wanted_is_exit_code_3(tmp_path, capsys):
    """Test: one voyage of five minutes at 10 Hz, 50 MB wanted. Expected: a peak that Python with numpy has at least
    and that is far below what six long voyages may take; exit code 3 and one line with both numbers."""
    words = ["--voyages", "1", "--minutes", "5", "--most-mb", "50", "--json", str(tmp_path / "m.json")]
    assert main(["calibrate-memory", *words]) == ThresholdError.exit_code
    found = json.loads((tmp_path / "m.json").read_text())
    assert 80.0 < found["peak_mb"] < 350.0 and found["cpu_s"] > 1.0 and found["voyages"] == 1
    said = capsys.readouterr().err
    assert said.count("\n") == 1 and "wanted: 50 MB" in said
