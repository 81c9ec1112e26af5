"""ROS bags and logs of autopilots: frames and units of each brought to north, east, down and degrees."""

import tomllib
from struct import pack

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.formats import recognised
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.recording.suggest_map import suggestion

rosbags = pytest.importorskip("rosbags", reason="needs the extra io")
START_NS = 1795608000_000000000


def quaternion(types, yaw_deg):
    half = np.radians(yaw_deg) / 2.0
    return types["geometry_msgs/msg/Quaternion"](0.0, 0.0, float(np.sin(half)), float(np.cos(half)))


def write_bag(path, m, frame="odom", storage=None):
    """A ROS 2 folder with one odometry topic (ENU and FLU as REP 103 has them, or NED and FRD), rudder and
    shaft."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    T, down = store.types, frame == "ned"
    header, time = T["std_msgs/msg/Header"], T["builtin_interfaces/msg/Time"]
    vector, twist = T["geometry_msgs/msg/Vector3"], T["geometry_msgs/msg/Twist"]
    plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
    with Writer(path, version=9, storage_plugin=plugin) as writer:
        odometry = writer.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=store)
        for i, t in enumerate(m["t"]):
            at = START_NS + int(t * 1e9)
            north, east, psi, r = (
                m["place"][i].real,
                m["place"][i].imag,
                m["psi"][i],
                np.radians(m["rate"][i]),
            )
            point = T["geometry_msgs/msg/Point"](
                float(north if down else east), float(east if down else north), 0.0
            )
            pose = T["geometry_msgs/msg/Pose"](point, quaternion(T, psi if down else 90.0 - psi))
            moving = twist(
                vector(6.0, 0.5 if down else -0.5, 0.0), vector(0.0, 0.0, float(r if down else -r))
            )
            message = T["nav_msgs/msg/Odometry"](
                header(time(at // 10**9, at % 10**9), frame),
                "base_link_frd" if down else "base_link",
                T["geometry_msgs/msg/PoseWithCovariance"](pose, np.zeros(36)),
                T["geometry_msgs/msg/TwistWithCovariance"](moving, np.zeros(36)),
            )
            writer.write(odometry, at, store.serialize_cdr(message, "nav_msgs/msg/Odometry"))
    return path


def write_boat(path, m):
    """A ROS 2 bag of a boat with two thrusters: odometry, and orders without a unit or a word of their own."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    write_bag(path / "way", m, storage="mcap")
    with Writer(path / "boat", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        copy_of(path / "way", writer, store)
        for side, push in (("port", 0.6), ("starboard", 0.4)):
            topic = writer.add_connection(f"/thrusters/{side}/cmd", "std_msgs/msg/Float32", typestore=store)
            for t in m["t"]:
                order = store.types["std_msgs/msg/Float32"](push)
                writer.write(topic, START_NS + int(t * 1e9), store.serialize_cdr(order, order.__msgtype__))
    return path / "boat"


def copy_of(path, writer, store):
    from rosbags.rosbag2 import Reader

    with Reader(path) as reader:
        topic = writer.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=store)
        for _, stamp, raw in reader.messages():
            writer.write(topic, stamp, raw)


def test_what_a_map_takes_of_a_log_is_not_called_unused(tmp_path, sailed):
    """Test: thrusters that only a map can name, in a bag. Expected: without a map they are named as not used;
    the proposed map takes them and says of nothing that it is not used, nor does the voyage read by it; a map
    that takes one of them names the other."""
    path = write_boat(tmp_path, sailed)
    with pytest.raises(DataError, match=r"or the channels of actuators.*not used: /thrusters/port/cmd"):
        read_voyage(path)
    text = suggestion([path], {})
    by = parse_map(tomllib.loads(text), "proposed")
    assert "port.command" in by.columns and "not used" not in text
    assert not [n for n in read_voyage(path, by).meta["notes"] if "not used" in n]
    one = parse_map({"columns": {"port.command": "/thrusters/port/cmd.data"}}, "one")
    said = [n for n in read_voyage(path, one).meta["notes"] if "not used" in n]
    assert said == ["not used: /thrusters/starboard/cmd.data"]


@pytest.mark.parametrize("frame", ["odom", "ned"])
@pytest.mark.parametrize("storage", ["sqlite3", "mcap"])
def test_a_ros_2_odometry_is_turned_into_north_east_down(tmp_path, sailed, frame, storage):
    folder = write_bag(tmp_path / "bag", sailed, frame, storage)
    single = next(p for p in folder.iterdir() if p.suffix in (".db3", ".mcap"))
    for path in (folder, single):
        assert recognised(path).name == "ros"
        v = read_voyage(path, controls=False)
        np.testing.assert_allclose(v["north_m"], sailed["place"].real, atol=1e-6)
        np.testing.assert_allclose(v["east_m"], sailed["place"].imag, atol=1e-6)
        np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"], atol=1e-6)
        np.testing.assert_allclose(v["yaw_rate_degps"], sailed["rate"], atol=1e-6)
        np.testing.assert_allclose(v["sway_velocity_mps"], 0.5)


def dataflash(m):
    """The bytes of a DataFlash log: FMT of each message, then position (1e-7 deg) and attitude (0.01 deg)."""

    def fmt(kind, size, name, form, labels):
        return b"\xa3\x95\x80" + pack("<BB4s16s64s", kind, size, name, form, labels)

    out = fmt(128, 89, b"FMT", b"BBnNZ", b"Type,Length,Name,Format,Columns")
    out += fmt(
        130,
        3 + 8 + 1 + 4 + 2 + 1 + 4 + 4 + 4 + 4,
        b"GPS",
        b"QBIHBLLff",
        b"TimeUS,Status,GMS,GWk,NSats,Lat,Lng,Spd,GCrs",
    )
    out += fmt(131, 3 + 8 + 2 + 2 + 2, b"ATT", b"QccC", b"TimeUS,Roll,Pitch,Yaw")
    for i, t in enumerate(m["t"]):
        us = int(t * 1e6) + 1_000_000
        out += b"\xa3\x95\x82" + pack(
            "<QBIHBiiff",
            us,
            3,
            300_000_000 + int(t * 1000),
            2400,
            9,
            round(m["latitude"][i] * 1e7),
            round(m["longitude"][i] * 1e7),
            6.0,
            m["psi"][i],
        )
        out += b"\xa3\x95\x83" + pack("<QhhH", us, 150, 0, round(m["psi"][i] * 100))
    return out


def test_an_ardupilot_log_has_its_degrees_scaled(tmp_path, sailed):
    pytest.importorskip("pymavlink", reason="needs the extra io")
    path = tmp_path / "00000001.BIN"
    path.write_bytes(dataflash(sailed))
    assert recognised(path).name == "dataflash"
    v = read_voyage(path, controls=False)
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"], atol=0.01)
    np.testing.assert_allclose(v["roll_deg"], 1.5)
    np.testing.assert_allclose(v["surge_velocity_mps"][5:-5], 6.0, atol=0.01)
    np.testing.assert_allclose(v["north_m"], sailed["place"].real, atol=1.0)


def test_a_telemetry_log_is_read_and_the_ground_station_left_out(tmp_path, sailed):
    pytest.importorskip("pymavlink", reason="needs the extra io")
    from pymavlink.dialects.v20 import common

    out = bytearray()
    for system in (1, 255):
        link = common.MAVLink(None, srcSystem=system, srcComponent=1)
        for i, t in enumerate(sailed["t"]):
            psi = np.radians((sailed["psi"][i] + 180.0) % 360.0 - 180.0)
            position = link.global_position_int_encode(
                int(t * 1000),
                round(sailed["latitude"][i] * 1e7),
                round(sailed["longitude"][i] * 1e7),
                0,
                0,
                round(600 * np.cos(psi)),
                round(600 * np.sin(psi)),
                0,
                round(sailed["psi"][i] * 100),
            )
            for message in (
                link.attitude_encode(
                    int(t * 1000), 0.0, 0.0, float(psi), 0.0, 0.0, float(np.radians(sailed["rate"][i]))
                ),
                position,
            ):
                out += int((1795608000 + t) * 1e6).to_bytes(8, "big") + message.pack(link)
    path = tmp_path / "flight.tlog"
    path.write_bytes(bytes(out))
    assert recognised(path).name == "tlog"
    v = read_voyage(path, controls=False)
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"], atol=1e-3)
    np.testing.assert_allclose(v["surge_velocity_mps"], 6.0, atol=0.02)
    np.testing.assert_allclose(v["yaw_rate_degps"], sailed["rate"], atol=1e-4)
