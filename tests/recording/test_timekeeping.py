"""A clock that was set is told from a wait by how far the ship went, where that was measured."""

import pytest

from twin.recording.checks import run_checks
from twin.recording.read import read_voyage


@pytest.mark.parametrize(
    ("hole_s", "measured", "told", "words"),
    [
        (3600.0, True, (False, True), "an hour, at 29.9 s"),
        (3600.0, False, (True, False), "an hour without a row after 29.9 s"),
        (0.0, False, (True, True), "no step of an hour"),
    ],
)
def test_a_clock_set_by_an_hour_is_seen_in_a_position_that_was_measured(
    sail, required, write_csv, hole_s, measured, told, words
):
    """Test: a ship that sails on over an hour's step of its clock, with and without a position. Expected: proved
    by the position, and not called sound where the position is only summed up of velocities."""
    names = [n for n in required if measured or n not in ("north_m", "east_m")]
    columns = {n: x for n, x in sail(60.0).items() if n in names}
    late = columns | {"time_s": columns["time_s"] + hole_s * (columns["time_s"] >= 30.0)}
    check = {c.name: c for c in run_checks(read_voyage(write_csv(late)))}["clock_steps"]
    assert (check.ok, check.informative) == told and words in check.text, check
