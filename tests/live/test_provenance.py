"""Each log says who wrote it: ship, hash of the model, settings, version; and no secret."""

import json
from importlib.metadata import version

import pytest
from mcap.reader import make_reader

from twin import __version__
from twin.live.keelson.messages import encode_float
from twin.live.learning.residual import ship_hash
from twin.live.log.mcap_index import PROVENANCE
from twin.live.log.mcap_read import McapReader
from twin.live.log.record import Recorder
from twin.live.log.recover import recover
from twin.live.provenance import identity, provenance
from twin.live.signals.config import Settings
from twin.live.signals.keys import KEYS

TOPIC, FLOAT = "twin/@v0/ship/pubsub/rudder_angle_deg/s", "keelson.TimestampedFloat"


def told(path):
    """The provenance of a log as the mcap package reads it."""
    with open(path, "rb") as stream:
        return {m.name: m.metadata for m in make_reader(stream).iter_metadata()}[PROVENANCE]


def record(folder, about, **limits):
    with Recorder(folder, **limits) as recorder:
        recorder.about = about
        for i in range(400):
            recorder.write(TOPIC, FLOAT, encode_float(1.0, i), i)
    return sorted(folder.glob("*.mcap"))


def test_each_file_of_the_log_says_ship_hash_settings_and_version(tmp_path, kvlcc2):
    about = provenance(Settings({"loop.rate_hz": 20.0}), kvlcc2)
    for path in record(tmp_path, about):
        said = told(path)
        assert (said["ship"], said["ship_hash"]) == (kvlcc2.name, ship_hash(kvlcc2))
        assert said["version"] == __version__ == version("shiptwin")
        settings = json.loads(said["settings"])
        assert settings["loop.rate_hz"] == 20.0 and {key.name for key in KEYS} < set(settings)
        assert float(said["length_m"]) == kvlcc2.L_pp and float(said["beam_m"]) == kvlcc2.B


def test_a_log_that_a_crash_left_open_still_says_who_wrote_it(tmp_path, kvlcc2):
    """Test: a log cut in its last chunk, then repaired. Expected: the words at its head are there."""
    (path,) = record(tmp_path, provenance(Settings(), kvlcc2))
    path.write_bytes(path.read_bytes()[:-200])
    assert "repaired" in recover(path)
    assert told(path)["ship"] == kvlcc2.name
    reader = McapReader(path)
    assert list(reader.messages()) and reader.metadata[PROVENANCE]["ship_hash"] == ship_hash(kvlcc2)


@pytest.mark.parametrize("name", ["bus.listen", "bus.router", "bus.connect"])
def test_what_stands_behind_an_address_is_told_to_nobody(name, kvlcc2):
    place = "tls/10.0.0.2:7447#password=hunter2"
    settings = Settings({name: [place] if name == "bus.connect" else place})
    said = json.dumps(provenance(settings, kvlcc2))
    assert "hunter2" not in said and "tls/10.0.0.2:7447" in said


def test_another_number_in_the_ship_is_another_hash(kvlcc2):
    from dataclasses import replace

    other = replace(kvlcc2, L_pp=kvlcc2.L_pp * 1.01)
    assert json.loads(identity(kvlcc2))["ship_hash"] != json.loads(identity(other))["ship_hash"]
