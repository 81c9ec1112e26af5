"""Messages made from tables: they cannot drift from the channels, and others can read them."""

import keelson
import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass

from twin.live.keelson import messages
from twin.live.signals.channels import CHANNELS

NS = 1_750_000_000_123_456_789


def test_a_row_has_one_optional_number_for_each_channel() -> None:
    fields = messages.Row.DESCRIPTOR.fields_by_name
    assert list(fields) == ["time_s", *(c.name for c in CHANNELS)]
    assert all(fields[c.name].has_presence for c in CHANNELS)


def test_what_was_not_measured_is_absent_and_a_zero_is_not() -> None:
    row = messages.Row(time_s=1.0)
    messages.fill(row, {"rudder_angle_deg": 0.0})
    back = messages.Row.FromString(row.SerializeToString())
    assert back.HasField("rudder_angle_deg") and not back.HasField("north_m")


def test_a_tick_comes_back_whole() -> None:
    tick = messages.Tick(time_s=3.0, wall_s=1.75e9, mode="hybrid", reasons=["all well"])
    tick.known.add(name="Wind", X_N=1.0, Y_N=-2.0, N_Nm=3.0)
    tick.parameters.add(name="X_u", value=1.0, low=0.5, high=2.0, status="estimated")
    prediction = tick.predictions.add(horizon_s=60.0)
    messages.fill(prediction.state, {"north_m": 12.0})
    messages.fill(tick.quality, {"heading_true_north_deg": 4})
    assert messages.Tick.FromString(tick.SerializeToString()) == tick


@pytest.mark.parametrize("type_name", sorted(messages.CLASSES))
def test_every_schema_stands_alone(type_name: str) -> None:
    """A viewer builds the type from the log's schema record and nothing else."""
    pool = DescriptorPool()
    for file in FileDescriptorSet.FromString(messages.schema_bytes(type_name)).file:
        pool.Add(file)
    assert GetMessageClass(pool.FindMessageTypeByName(type_name)).DESCRIPTOR.full_name == type_name


def test_schemas_are_the_same_bytes_each_time() -> None:
    assert messages.schema_bytes("shiptwin.Tick") == messages.schema_bytes("shiptwin.Tick")


def test_keelson_opens_our_envelope_and_we_open_keelsons() -> None:
    _, enclosed_at, payload = keelson.uncover(messages.wrap(b"abc", NS))
    assert (enclosed_at, payload) == (NS, b"abc")
    assert messages.unwrap(keelson.enclose(b"abc", NS)) == (NS, b"abc")


def test_keelson_reads_our_scalars_and_positions() -> None:
    value = keelson.decode_protobuf_payload_from_type_name(
        messages.encode_float(12.5, NS), "keelson.TimestampedFloat"
    )
    assert (value.value, value.timestamp.ToNanoseconds()) == (12.5, NS)
    fix = keelson.decode_protobuf_payload_from_type_name(
        messages.encode_fix(57.7, 11.9, NS), "foxglove.LocationFix"
    )
    assert (fix.latitude, fix.longitude, fix.timestamp.ToNanoseconds()) == (57.7, 11.9, NS)
    force = keelson.decode_protobuf_payload_from_type_name(
        messages.encode_vector(1.0, 2.0, 3.0, NS), "keelson.Decomposed3DVector"
    )
    assert (force.vector.x, force.vector.y, force.vector.z) == (1.0, 2.0, 3.0)
    words = keelson.decode_protobuf_payload_from_type_name(
        messages.encode_string("all well", NS), "keelson.TimestampedString"
    )
    assert words.value == "all well"
