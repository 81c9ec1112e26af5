"""Clocks that count otherwise than was thought: one line or a note, never a traceback, and no memory for time
that was not recorded."""

import subprocess
import sys

import numpy as np
import pytest

from twin.cli import main
from twin.commands.story import SHIP
from twin.errors import DataError
from twin.live.clock import ReplayClock
from twin.live.log.played import PlayedLog
from twin.num import as_given
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage

SECOND_OF_2023 = 1.7e9


@pytest.mark.parametrize("unit, scale", [("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
def test_an_epoch_in_a_finer_unit_is_read_as_what_it_is_and_said(write_csv, columns, unit, scale):
    """Test: time_s holds milliseconds (and finer) since 1970. Expected: the same voyage as in seconds, and a
    note with the map's line."""
    t = columns["time_s"]
    whole = read_voyage(write_csv(columns | {"time_s": SECOND_OF_2023 + t}, digits=18))
    path = write_csv(columns | {"time_s": [f"{round((SECOND_OF_2023 + x) * scale)}" for x in t.tolist()]})
    voyage = read_voyage(path)
    np.testing.assert_allclose(voyage.time_s, whole.time_s, atol=2e-3)
    assert voyage.meta["start_time_utc"] == whole.meta["start_time_utc"] == "2023-11-14T22:13:20Z"
    assert any(f'[time] unit = "{unit}"' in note and "since 1970" in note for note in voyage.meta["notes"])


@pytest.mark.parametrize("first", [1e12 * 1e9, 1e300, -1e12, 5e9, 1e11])
def test_stamps_that_are_no_date_in_any_unit_are_refused_with_the_maps_line(
    write_csv, columns, refused, first
):
    path = write_csv(columns | {"time_s": first * (1.0 + 1e-9 * columns["time_s"])}, digits=17)
    refused(path, as_given(first)[:5], "[time] unit")


@pytest.mark.parametrize("ahead", [1e9, 1e12, 1e300])
@pytest.mark.parametrize("row", [-1, 300])
def test_one_stamp_far_ahead_is_named_with_its_line(write_csv, columns, refused, ahead, row):
    t = columns["time_s"].copy()
    t[row] += ahead
    line = np.arange(2, t.size + 2)[row]
    refused(
        write_csv(columns | {"time_s": t}, digits=17), f"line {line}:", "leaps ahead", "Correct or remove"
    )


def test_rows_from_before_the_clock_was_set_are_named(write_csv, columns, refused):
    t = columns["time_s"] + SECOND_OF_2023
    t[:20] = np.arange(20.0)
    refused(write_csv(columns | {"time_s": t}, digits=17), "line 22:", "leaps ahead")


def test_text_stamps_after_2100_are_refused(write_csv, columns, refused):
    stamps = [f"9999-05-17T08:{int(x) // 60:02d}:{x % 60:05.2f}Z" for x in columns.pop("time_s").tolist()]
    refused(write_csv({"time_utc": stamps} | columns), "after 2100")


def of_stamps(columns, t):
    return Voyage("odd", t, {n: x for n, x in columns.items() if n != "time_s"})


@pytest.mark.parametrize("scale, verb", [(1e3, "compare"), (1e3, "replay"), (1e9, "replay")])
def test_a_log_whose_rows_count_otherwise_is_one_line_for_every_verb(columns, tmp_path, capsys, scale, verb):
    """Test: rows stamped in ms and ns since 1970, and one in 1e300. Expected: exit code 4 or a note, never a
    traceback."""
    write_voyage(
        of_stamps(columns, (SECOND_OF_2023 + columns["time_s"]) * scale), path := tmp_path / "odd.mcap"
    )
    code = main([verb, str(path), "--ship", "kvlcc2"])
    told = capsys.readouterr()
    if verb == "replay":
        assert code == 4 and told.err.count("\n") == 1 and "twin import" in told.err
    else:
        assert code == 4 and "three ship lengths" in told.err, (
            "it is read: a minute is too short for a tanker"
        )
    assert "since 1970" in " ".join(read_voyage(path).meta["notes"])


@pytest.mark.parametrize("ahead", [4e7, 1e9, 1e300])
def test_a_replayed_stamp_far_ahead_ends_it_in_one_line(columns, tmp_path, capsys, ahead):
    t = columns["time_s"].copy()
    t[300] += ahead
    from twin.live.keelson.messages import Row
    from twin.live.log.logfile import LogFile

    with LogFile(tmp_path / "odd.mcap") as log:
        for i, x in enumerate(t.tolist()):
            row = Row(time_s=x, heading_true_north_deg=1.0, rudder_angle_deg=0.0, propeller_rate_rpm=60.0)
            log.add("shiptwin/voyage/row", "shiptwin.Row", row.SerializeToString(), i)
    assert main(["replay", str(tmp_path / "odd.mcap"), "--ship", "usv"]) == 4
    assert "odd.mcap" in (said := capsys.readouterr().err) and said.count("\n") == 1


@pytest.mark.parametrize("hole_s", [2400.0, 3e7])
def test_a_played_log_makes_no_ticks_in_a_hole(columns, tmp_path, hole_s):
    t = np.where(np.arange(columns["time_s"].size) < 300, columns["time_s"], columns["time_s"] + hole_s)
    write_voyage(of_stamps(columns, t), path := tmp_path / "hole.mcap")
    ticks = [b.time_s for b in PlayedLog(path, 10.0).batches()]
    assert 590 < len(ticks) < 620 and max(np.diff(ticks)) == pytest.approx(hole_s, rel=0.01)


def test_a_replay_in_real_time_sleeps_through_no_long_hole():
    clock = ReplayClock([(0.0, 0.0), (1e6, 1e6), (1e6 + 0.05, 1e6 + 0.05)], 1.0)
    assert [clock.wait().time_s for _ in range(3)] == [0.0, 1e6, 1e6 + 0.05]


def test_a_hole_of_a_year_takes_no_memory(write_csv, sail, tmp_path):
    """Test: a voyage with a hole of 300 days through the checks and the ship's grid. Expected: less than 400
    MB."""
    columns = sail(900.0)
    t = columns["time_s"]
    path = write_csv(columns | {"time_s": np.where(t < 450.0, t, t + 300.0 * 86400.0)}, digits=17)
    code = (
        "from twin.cli import main; "
        f"code = main(['compare', {str(path)!r}, '--ship', {str(SHIP)!r}]); "
        "print(code, open('/proc/self/status').read().split('VmHWM:')[1].split()[0])"  # ru_maxrss: the parent's
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    code, kilobytes = map(int, done.stdout.splitlines()[-1].split())
    assert code == 0 and kilobytes < 400_000, done.stderr


def test_a_voyage_that_would_need_too_fine_a_grid_for_too_long_is_refused():
    t = np.arange(0.0, 3e8, 5e2)
    with pytest.raises(DataError, match="Cut it into shorter voyages"):
        Voyage("slow", t, {"roll_deg": 0.0 * t}).on_grid(0.1)
