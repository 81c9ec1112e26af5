"""A control of which most samples are none: told with its values and what the map needs, and refused."""

from dataclasses import replace

import numpy as np
import pytest

from bench.small_boats import sailed, ship_of
from twin.recording.checks import run_checks
from twin.recording.checks.channel_samples import plausible_values
from twin.recording.checks.proved_wrong import proved_wrong
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage

RUDDER, TURNS = "rudder_angle_deg", "propeller_rate_rpm"
SEED = 4242


def said_of(voyage, ship=None):
    return plausible_values(VoyageView(voyage, ship))


def with_pitch(sail, values):
    """A voyage of a ship with a controllable pitch, by these values (N,) of its record."""
    columns = sail(60.0)
    rudder, turns = columns.pop(RUDDER), columns.pop(TURNS)
    columns |= {"port.angle_deg": rudder, "port.rate_rpm": turns, "port.pitch_ratio": values(turns)}
    return columns


def test_a_pitch_in_per_cent_of_full_pitch_is_refused_with_its_remedy(sail, write_csv, tmp_path):
    """Expected: also after the voyage was written and read again, unless its owner accepts it."""
    voyage = read_voyage(write_csv(with_pitch(sail, lambda turns: np.linspace(40.0, 80.0, turns.size))))
    write_voyage(voyage, tmp_path / "v.mcap")
    for v in (voyage, read_voyage(tmp_path / "v.mcap")):
        found = said_of(v)
        assert found.unusable and "port.pitch_ratio" in found.text and "40 to 80" in found.text
        assert 'unit = "%"' in found.text and "factor = pitch over diameter at full pitch" in found.text
        refused = proved_wrong(v, run_checks(v))
        assert [c.name for c in refused] == ["plausible_values"]
        assert proved_wrong(v.with_meta(accepted=["plausible_values"]), run_checks(v)) == []


def test_a_few_samples_out_of_range_are_blanked_and_refuse_nothing(sail, write_csv):
    v = read_voyage(
        write_csv(with_pitch(sail, lambda turns: np.where(np.arange(turns.size) < 200, 80.0, 0.8)))
    )
    found = said_of(v)
    assert not found.ok and not found.unusable and "200 samples blanked" in found.text


@pytest.mark.parametrize(
    ("channel", "factor", "words"),
    [(RUDDER, 100.0, 'unit = "cdeg"'), (TURNS, 1000.0, "another unit or factor")],
)
def test_of_a_ship_of_one_propeller_most_of_a_control_out_of_range_is_refused(
    sail, write_csv, channel, factor, words
):
    """Test: its rudder, and its shaft, in another unit but for the first few samples, which lie within what
    a ship can have."""
    columns = sail(60.0)
    columns[channel] = np.where(columns["time_s"] < 5.0, 1.0, factor * (columns[channel] + 2.0))
    found = said_of(read_voyage(write_csv(columns)))
    assert found.unusable and channel in found.text and words in found.text


def test_a_control_without_any_sample_in_range_is_refused_with_its_values_and_remedy(
    sail, write_csv, refused
):
    columns = sail(60.0)
    columns[RUDDER] = np.linspace(500.0, 1500.0, columns[RUDDER].size)
    message = refused(write_csv(columns), f"{RUDDER}: 500 to 1500", 'unit = "cdeg"')
    assert "--without-controls" not in message


def test_a_unit_that_the_map_gives_and_the_column_has_not_is_taken_back(sail, write_csv, tmp_path):
    """Test: a rudder in degrees that a map calls radians. Expected: the remedy is deg."""
    columns = sail(60.0)
    columns[RUDDER] = np.abs(columns[RUDDER]) + 2.0
    (tmp_path / "map.toml").write_text(f'[columns]\n{RUDDER} = {{ unit = "rad" }}\n')
    columns[RUDDER][:3] = 0.1
    found = said_of(read_voyage(write_csv(columns), read_map(tmp_path / "map.toml")))
    assert found.unusable and 'unit = "deg"' in found.text


def test_of_two_tables_too_the_unit_that_the_map_gives_is_taken_back(sail, write_csv, tmp_path):
    columns = sail(60.0)
    steered = {"time_s": columns["time_s"], RUDDER: np.linspace(0.0, 20.0, columns["time_s"].size)}
    del columns[RUDDER]
    (tmp_path / "map.toml").write_text(f'[columns]\n{RUDDER} = {{ unit = "rad" }}\n')
    paths = [write_csv(columns), write_csv(steered, "steered.csv")]
    found = said_of(read_voyage(paths, read_map(tmp_path / "map.toml")))
    assert found.unusable and 'unit = "deg"' in found.text


def test_what_the_ship_file_does_not_need_refuses_nothing(sail, write_csv):
    columns = sail(60.0)
    columns |= {"bow.command": np.full(columns[RUDDER].size, 70.0)}
    v = read_voyage(write_csv(columns))
    assert said_of(v).unusable and not said_of(v, ship_of("thrusters")).unusable


def test_a_rudder_beyond_what_one_can_turn_to_is_refused(tmp_path):
    """Test: the angles of two outboards as recorded, shown as 0 to 360 deg, with three samples beyond, and
    counted from astern; and those of azimuths, which turn all round. Expected: the fourth refused, the third
    told, the others not."""
    right, ship = sailed("outboards", SEED), ship_of("outboards")

    def turned(change) -> Voyage:
        return replace(right, columns={n: change(x) if "angle" in n else x for n, x in right.columns.items()})

    few = said_of(turned(lambda x: np.where(np.arange(x.size) < 3, 150.0, x)), ship)
    astern = said_of(turned(lambda x: 180.0 - x), ship)
    assert said_of(right, ship).ok and said_of(turned(lambda x: x % 360.0), ship).ok
    assert not few.ok and not few.unusable and "port.angle_deg: 3 of" in few.text
    assert astern.unusable and "151 to 210" in astern.text and "outboard" in astern.text
    assert said_of(sailed("azimuths", SEED), ship_of("azimuths")).ok
