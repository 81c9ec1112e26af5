"""What is shipped for others says what the tables say, and Keelson's SDK decodes every message of ours with
it."""

import importlib.util
import re
import tomllib
from importlib.resources import files
from pathlib import Path

import keelson
import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorSet

from twin.live.keelson import meanings, messages
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.topics import INPUTS, OUTPUTS
from twin.live.outbox import Outbox
from twin.live.signals.chart import Chart
from twin.live.signals.geodesy import datum

ROOT = Path(__file__).parents[3]
spec = importlib.util.spec_from_file_location("bus_page", ROOT / "docs" / "bus_page.py")
bus_page = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bus_page)
SHIPPED = files("twin.live.keelson")


@pytest.fixture
def sdk(monkeypatch):
    """Keelson's SDK as a stranger sets it up, for this test only."""
    monkeypatch.setattr(keelson, "_SUBJECTS", dict(keelson._SUBJECTS))
    monkeypatch.setattr(keelson, "_PROTO_TYPES", dict(keelson._PROTO_TYPES))
    keelson.add_well_known_subjects_and_proto_definitions(
        SHIPPED / "subjects.yaml", SHIPPED / "shiptwin.desc"
    )
    return keelson


def decoded(sdk, key, envelope):
    _, _, payload = sdk.uncover(envelope)
    type_name = sdk.get_subject_schema(sdk.get_subject_from_pubsub_key(key))
    return sdk.decode_protobuf_payload_from_type_name(payload, type_name)


@pytest.mark.parametrize("path", bus_page.made(), ids=lambda path: path.name)
def test_what_is_shipped_and_documented_is_what_the_tables_say(path):
    assert path.read_bytes() == bus_page.made()[path], "run: python docs/bus_page.py"


def test_an_installation_gets_the_shipped_files():
    packages = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]
    assert {"*.proto", "*.desc", "*.yaml"} <= set(packages["twin.live.keelson"])


def test_keelsons_sdk_decodes_everything_the_twin_says(make_bridge, sdk):
    """Test: ten seconds of a twin on a bus, each message by its key. Expected: every subject of the table,
    with the numbers of the wide record."""
    bridge, bus = make_bridge(), MemoryBus()
    bridge.loop.voice = Outbox(bridge.loop.publisher, "fleet", "alma", bus)
    bridge.ears.decoder.chart = Chart(datum(57.6, 11.6))
    ticks = bridge.run(10.0)
    found = {}
    for key, envelope in bus.sent:
        place = sdk.parse_pubsub_key(key)
        found.setdefault((place["subject"], place["source_id"]), []).append(decoded(sdk, key, envelope))
    assert set(found) == {(o.subject, o.source) for o in OUTPUTS}
    said = found[("twin_tick", "twin")]
    assert [t.SerializeToString() for t in said] == [t.SerializeToString() for t in ticks]
    assert any(p.horizon_s == 120.0 and p.state.HasField("north_m") for t in said for p in t.predictions)
    headings = [m.value for m in found[("heading_true_north_deg", "twin/estimate")]]
    assert headings[-1] == pytest.approx(ticks[-1].estimate.heading_true_north_deg, abs=1.0)


def test_keelsons_sdk_decodes_the_rows_of_a_voyage(sdk):
    row = messages.Row(time_s=3.0, rudder_angle_deg=-5.0)
    read = sdk.decode_protobuf_payload_from_type_name(row.SerializeToString(), "shiptwin.Row")
    assert (read.time_s, read.rudder_angle_deg, read.HasField("roll_deg")) == (3.0, -5.0, False)


def test_the_sdk_knows_every_subject_in_and_out(sdk):
    for item in (*INPUTS, *OUTPUTS):
        assert sdk.get_subject_schema(item.subject) == item.type_name


def test_the_proto_file_has_the_fields_of_the_descriptor_set():
    """Test: the text, read line by line. Expected: the same names, numbers, types and labels."""
    text = (SHIPPED / "shiptwin.proto").read_text()
    (file,) = FileDescriptorSet.FromString((SHIPPED / "shiptwin.desc").read_bytes()).file
    kinds = {1: "double", 3: "int64", 5: "int32", 8: "bool", 9: "string"}
    for message in file.message_type:
        body = re.search(rf"message {message.name} {{\n(.*?)\n}}", text, re.S)[1]
        written = re.findall(r"^  (optional |repeated |)(\w+) (\w+) = (\d+);", body, re.M)
        meant = [
            (
                "optional " if f.proto3_optional else "repeated " if f.label == f.LABEL_REPEATED else "",
                kinds.get(f.type) or f.type_name.rpartition(".")[2],
                f.name,
                str(f.number),
            )
            for f in file.message_type[list(file.message_type).index(message)].field
        ]
        assert written == meant, message.name


def test_no_meaning_stands_for_a_field_that_is_not_there():
    known = {f"{name}.{field}" for name, fields in messages.TABLE.items() for field, _ in fields}
    known |= {field for fields in messages.TABLE.values() for field, _ in fields}
    assert not set(meanings.MEANINGS) - known


@pytest.mark.parametrize(
    "name, unit",
    [("yaw_rate_degps", "deg/s"), ("X_N", "N"), ("N_Nm", "N m"), ("slack_us", "us"), ("mode", "")],
)
def test_the_unit_is_the_suffix_of_the_name(name, unit):
    assert meanings.unit_of(name) == unit
