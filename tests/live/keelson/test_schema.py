"""Protobuf files written and read as bytes are what google's own classes make of them."""

import subprocess
import sys

import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorProto, FileDescriptorSet

from twin.errors import TwinError
from twin.live.keelson import messages, proto_file
from twin.live.keelson.schema import keelson_class

FIELDS = [
    ("time_s", "double"),
    ("name", "string?"),
    ("state", "State"),
    ("parts", "State*"),
    ("n", "int64?"),
    ("on", "bool"),
]


def test_a_file_written_by_hand_is_the_file_googles_classes_would_write():
    """Test: a message with every kind of field. Expected: parsed by google's own class it says what the table
    says."""
    data = proto_file.file(
        "x.proto",
        "x",
        ("y.proto",),
        [proto_file.message("All", FIELDS, "x"), proto_file.message("State", [], "x")],
    )
    found = FileDescriptorProto.FromString(data)
    assert (found.name, found.package, found.syntax, list(found.dependency)) == (
        "x.proto",
        "x",
        "proto3",
        ["y.proto"],
    )
    message = found.message_type[0]
    assert [f.name for f in message.field] == [name for name, _ in FIELDS]
    assert [f.number for f in message.field] == [1, 2, 3, 4, 5, 6]
    assert [f.proto3_optional for f in message.field] == [False, True, False, False, True, False]
    assert [o.name for o in message.oneof_decl] == ["_name", "_n"] and message.field[4].oneof_index == 1
    kinds = FileDescriptorProto.DESCRIPTOR.file.message_types_by_name[
        "FieldDescriptorProto"
    ].enum_types_by_name["Type"]
    said = [kinds.values_by_number[f.type].name for f in message.field]
    assert said == ["TYPE_DOUBLE", "TYPE_STRING", "TYPE_MESSAGE", "TYPE_MESSAGE", "TYPE_INT64", "TYPE_BOOL"]
    assert (
        message.field[3].label == message.field[3].LABEL_REPEATED and message.field[3].type_name == ".x.State"
    )
    assert (
        found.SerializeToString(deterministic=True)
        == FileDescriptorProto.FromString(found.SerializeToString()).SerializeToString()
    )


@pytest.mark.parametrize("name", ["shiptwin.Tick", "keelson.TimestampedFloat", "foxglove.LocationFix"])
def test_a_set_of_files_is_read_as_google_reads_it(name):
    data = messages.schema_bytes(name)
    theirs = FileDescriptorSet.FromString(data).file
    ours = proto_file.files_of(data)
    assert [(f.name, f.package, f.needs, f.messages) for f in ours] == [
        (f.name, f.package, list(f.dependency), [m.name for m in f.message_type]) for f in theirs
    ]
    assert [f.data for f in ours] == [f.SerializeToString() for f in theirs]


@pytest.mark.parametrize("garbage", [b"\x0a\x7f", b"\x0a", b"\x09", b"\xff" * 40, b"\x0a\x02\x0a\x7f"])
def test_bytes_that_are_no_file_set_are_refused(garbage):
    with pytest.raises((ValueError, KeyError)):
        proto_file.files_of(garbage)


def test_a_type_that_keelson_does_not_have_is_named():
    with pytest.raises(TwinError, match=r"keelson\.Nothing"):
        keelson_class("keelson.Nothing")


def test_another_build_of_protobuf_serves_as_well():
    """Test: a protobuf without its C core. Expected: the same bytes by the front door."""
    program = (
        "import sys; sys.modules['google._upb._message'] = None\n"
        "from twin.live.keelson import messages as m\n"
        "t = m.Tick(index=3, mode='hybrid', known=[{'name': 'hull', 'X_N': 2.0}], measured={'roll_deg': "
        "1.5})\n"
        "print(m.wrap(t.SerializeToString(), 5).hex(), len(m.schema_bytes('shiptwin.Tick')))"
    )
    env = {"PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION": "python", "PATH": "/usr/bin:/bin"}
    said = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, env=env, check=True
    ).stdout.split()
    tick = messages.Tick(
        index=3, mode="hybrid", known=[{"name": "hull", "X_N": 2.0}], measured={"roll_deg": 1.5}
    )
    assert said == [
        messages.wrap(tick.SerializeToString(), 5).hex(),
        str(len(messages.schema_bytes("shiptwin.Tick"))),
    ]
