"""Channels of a ship's actuators: named, read, written and read back like every other."""

import numpy as np
import pytest

from twin.errors import DataError
from twin.live.signals.channels import BY_NAME
from twin.physics.ship import from_table, load, to_table
from twin.recording.read import read_voyage
from twin.recording.samples import spikes
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage
from twin.study.track.track import track

TIME = np.arange(0.0, 120.0, 0.5)
PORT = {"name": "port", "kind": "fixed_thruster", "channels": ["command"], "ahead_n": 50.0, "astern_n": 25.0}


def voyage(**columns):
    made = {
        "north_m": 1.2 * TIME,
        "east_m": 0.0 * TIME,
        "heading_true_north_deg": 0.0 * TIME,
        "port.command": 0.4 + 0.1 * np.sin(0.1 * TIME),
        "pod_2.angle_deg": 30.0 * np.cos(0.1 * TIME),
    }
    return Voyage("two hulls", TIME, made | columns)


def test_a_voyage_with_actuators_is_written_and_read_back_the_same(tmp_path):
    write_voyage(voyage(), tmp_path / "v.mcap")
    again = read_voyage(tmp_path / "v.mcap")
    for name in ("port.command", "pod_2.angle_deg", "north_m"):
        assert np.array_equal(again[name], voyage()[name])


def test_a_table_with_the_channels_of_actuators_needs_no_rudder(tmp_path):
    text = "time_s,north_m,east_m,heading_true_north_deg,port.command\n"
    text += "".join(f"{t},{t},0,0,{0.4 + 0.001 * t}\n" for t in TIME)
    (tmp_path / "v.csv").write_text(text)
    assert read_voyage(tmp_path / "v.csv").has("port.command")


def test_an_angle_that_passes_ahead_goes_the_short_way_between_its_samples():
    """Test: a pod that swings about ahead, shown as 0 to 360 deg every second, and a rudder beside it, both
    brought to the times of every half second. Expected: no sample lies astern, the rudder stays on its side,
    and nobody calls the passage a spike."""
    seconds = np.arange(0.0, 300.0)
    swing = 8.0 * np.sin(0.15 * seconds)
    shown = Voyage(
        "ferry",
        seconds,
        {
            "north_m": seconds,
            "east_m": 0.0 * seconds,
            "heading_true_north_deg": 0.0 * seconds,
            "pod.angle_deg": swing % 360.0,
            "rudder.angle_deg": swing,
        },
    )
    between = shown.on_grid(0.5)
    assert np.cos(between.si("pod.angle_deg")).min() > 0.98
    assert np.allclose(between["rudder.angle_deg"][::2], swing)
    ahead = np.random.default_rng(1).normal(0.8, 0.3, 300) % 360.0  # now and then a little to port
    assert spikes(ahead).size and not spikes(ahead, BY_NAME["pod.angle_deg"].period).size


def test_what_is_no_channel_of_an_actuator_is_none():
    assert "port.rate_rpm" in BY_NAME and BY_NAME["port.rate_rpm"].to_si == pytest.approx(1.0 / 60.0)
    assert not any(n in BY_NAME for n in ("port.colour", "Port.command", ".command"))


def test_the_track_holds_what_the_ship_file_lists_and_names_what_is_not_there():
    ship = from_table(to_table(load("usv")) | {"actuators": [PORT]})
    found = track(voyage(), ship)
    assert set(found.orders) == {"port.command"} and not found.delta.any()
    other = from_table(to_table(load("usv")) | {"actuators": [PORT | {"name": "stern"}]})
    with pytest.raises(DataError, match=r"what drives .* is stern\.command"):
        track(voyage(), other)
