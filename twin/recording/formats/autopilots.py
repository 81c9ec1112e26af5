"""Logs of autopilots: ArduPilot DataFlash (.BIN) and MAVLink telemetry (.tlog) by pymavlink, PX4 ULog by
pyulog."""

from collections.abc import Callable, Iterator
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.recording.formats.extra import library, one_line
from twin.recording.formats.signals import Signals

FLASH, TLOG, ULOG = "an ArduPilot DataFlash log", "a MAVLink telemetry log", "a PX4 ULog"
Part = tuple[str, str, float]
HEADING, RATE, ROLL = "heading_true_north_deg", "yaw_rate_degps", "roll_deg"
NORTH, EAST = "velocity_north_mps", "velocity_east_mps"
GROUND_STATIONS = frozenset((0, 255))


def looks_flash(lines: list[str], start: bytes) -> bool:
    """Whether a file starts as a DataFlash log does."""
    return start.startswith(b"\xa3\x95\x80")


def looks_tlog(lines: list[str], start: bytes) -> bool:
    """A stamp of eight bytes [us since 1970] in front of a MAVLink packet, twice."""
    return len(start) > 16 and start[8] in (0xFD, 0xFE) and 1e15 < int.from_bytes(start[:8], "big") < 5e15


def looks_ulog(lines: list[str], start: bytes) -> bool:
    """Whether a file starts as a ULog does."""
    return start.startswith(b"ULog\x01\x12\x35")


def ekf(m: Any) -> Iterator[Part]:
    """Heading, velocity and position of the state estimate."""
    yield "yaw", HEADING, m.Yaw
    yield "vn", NORTH, m.VN
    yield "ve", EAST, m.VE


def gps(m: Any) -> Iterator[Part]:
    """Position, speed and course of a receiver that has a fix."""
    if m.Status >= 2:
        yield "latitude", "latitude_deg", m.Lat
        yield "longitude", "longitude_deg", m.Lng
        yield "speed", "speed_over_ground_mps", m.Spd
        yield "course", "course_over_ground_deg", m.GCrs


def att(m: Any) -> Iterator[Part]:
    """Heading and roll [deg]."""
    yield "yaw", HEADING, m.Yaw
    yield "roll", ROLL, m.Roll


def outputs(m: Any) -> Iterator[Part]:
    """The servo outputs as they are written, of no channel yet."""
    for i in range(1, 9):
        if hasattr(m, f"C{i}"):
            yield f"C{i}", "", float(getattr(m, f"C{i}"))


FLASHED: dict[str, tuple[int, Callable[[Any], Iterator[Part]]]] = {
    "ATT": (0, att),
    "GPS": (0, gps),
    "XKF1": (1, ekf),
    "NKF1": (2, ekf),
    "RCOU": (9, outputs),
    "IMU": (0, lambda m: iter([("rate", RATE, degrees(m.GyrZ))])),
    "RPM": (0, lambda m: iter([("rpm1", "propeller_rate_rpm", m.rpm1)])),
    "WIND": (
        0,
        lambda m: iter(
            [("speed", "apparent_wind_speed_mps", m.SpdA), ("angle", "apparent_wind_angle_deg", m.DirA)]
        ),
    ),
    "DPTH": (0, lambda m: iter([("depth", "water_depth_m", m.Depth)])),
}


def position_int(m: Any) -> Iterator[Part]:
    """Position [deg] and velocity [m/s] of the estimate, which are sent in 1e-7 deg and cm/s."""
    if m.lat or m.lon:
        yield "latitude", "latitude_deg", m.lat * 1e-7
        yield "longitude", "longitude_deg", m.lon * 1e-7
        yield "vn", NORTH, m.vx * 0.01
        yield "ve", EAST, m.vy * 0.01


def raw_int(m: Any) -> Iterator[Part]:
    """Position, speed and course of a receiver that has a fix."""
    if m.fix_type >= 2:
        yield "latitude", "latitude_deg", m.lat * 1e-7
        yield "longitude", "longitude_deg", m.lon * 1e-7
    if m.fix_type >= 2 and m.vel != 65535 and m.cog != 65535:
        yield "speed", "speed_over_ground_mps", m.vel * 0.01
        yield "course", "course_over_ground_deg", m.cog * 0.01


def servos(m: Any) -> Iterator[Part]:
    """The servo outputs as they are sent [us], of no channel yet."""
    for i in range(1, 9):
        yield f"servo{i}", "", float(getattr(m, f"servo{i}_raw", 0))


SENT: dict[str, tuple[int, Callable[[Any], Iterator[Part]]]] = {
    "ATTITUDE": (
        0,
        lambda m: iter(
            [
                ("yaw", HEADING, degrees(m.yaw) % 360.0),
                ("roll", ROLL, degrees(m.roll)),
                ("rate", RATE, degrees(m.yawspeed)),
            ]
        ),
    ),
    "GPS_RAW_INT": (0, raw_int),
    "GLOBAL_POSITION_INT": (1, position_int),
    "SERVO_OUTPUT_RAW": (9, servos),
    "RPM": (0, lambda m: iter([("rpm1", "propeller_rate_rpm", m.rpm1)])),
    "WIND": (
        9,
        lambda m: iter(
            [
                ("speed", "true_wind_speed_mps", m.speed),
                ("direction", "true_wind_direction_deg", m.direction % 360.0),
            ]
        ),
    ),
}


def read_flash(path: Path) -> Signals:
    """Series named message, instance and part (`GPS0.latitude`); degE7 and centidegrees are scaled by the
    log's own table."""
    reader = library("pymavlink.DFReader", path, FLASH)
    return collect(Signals(path, FLASH), lambda: reader.DFReader_binary(str(path)), FLASHED, flash_source)


def flash_source(m: Any) -> str | None:
    """The instance that a message of a DataFlash log belongs to; never None."""
    instance = getattr(m, "I", getattr(m, "C", 0))
    return str(instance if isinstance(instance, int) else 0)


def read_tlog(path: Path) -> Signals:
    """Series named message, vehicle and part; what ground stations sent is left out."""
    link = library("pymavlink.mavutil", path, TLOG)
    return collect(
        Signals(path, TLOG), lambda: link.mavlogfile(str(path), notimestamps=False), SENT, tlog_source
    )


def tlog_source(m: Any) -> str | None:
    """The system and component that sent a message; None for a ground station."""
    system = m.get_srcSystem()
    return None if system in GROUND_STATIONS else f"{system}.{m.get_srcComponent()}"


def collect(
    out: Signals,
    opened: Callable[[], Any],
    known: dict[str, tuple[int, Callable[[Any], Iterator[Part]]]],
    source_of: Callable[[Any], str | None],
) -> Signals:
    """All known messages; what the library cannot read ends the log there, and is said. DataError: nothing
    of it can be read."""
    try:
        log = opened()
        while (m := log.recv_msg()) is not None:
            kind = m.get_type()
            source = source_of(m) if kind in known else None
            if source is None:
                out.skipped["messages of other kinds"] += 1
                continue
            rank, parts = known[kind]
            for part, quantity, value in parts(m):
                out.put(f"{kind}{source}.{part}", source, quantity, float(m._timestamp), float(value), rank)
    except MemoryError:
        raise
    except Exception as error:
        if not out.series:
            raise DataError(
                f"{out.path}: this is {out.says}, and it cannot be read: {one_line(error)}."
            ) from None
        out.notes.append(f"it is damaged and was read up to there: {one_line(error)}")
    return out.finish()


def read_ulog(path: Path) -> Signals:
    """Series named topic, instance and part (`vehicle_attitude0.heading`), on the UTC of the receiver
    where it knows one. DataError: it cannot be read."""
    module, out = library("pyulog", path, ULOG), Signals(path, ULOG)
    try:
        log = module.ULog(str(path), list(TOPICS))
    except MemoryError:
        raise
    except Exception as error:
        raise DataError(f"{path}: this is {ULOG}, and it cannot be read: {one_line(error)}.") from None
    start_s = utc_of_zero(log)
    for topic in log.data_list:
        rank, parts = TOPICS[topic.name]
        t = topic.data["timestamp"].astype(float) * 1e-6 + start_s
        for part, quantity, values in parts(topic.data):
            series = out.of(f"{topic.name}{topic.multi_id}.{part}", str(topic.multi_id), quantity, rank)
            series.times.frombytes(t.astype(float).tobytes())
            series.values.frombytes(np.asarray(values, float).tobytes())
    if getattr(log, "file_corruption", False):
        out.notes.append("it is damaged; what could be read was read")
    return out.finish()


def utc_of_zero(log: Any) -> float:
    """UTC [s] of the log's zero, from the receiver; 0 when it never knew."""
    for topic in log.data_list:
        if "time_utc_usec" in topic.data:
            known = topic.data["time_utc_usec"] > 1e15
            if known.any():
                return (
                    float(
                        np.median(
                            topic.data["time_utc_usec"][known].astype(float) - topic.data["timestamp"][known]
                        )
                    )
                    * 1e-6
                )
    return 0.0


def ulog_attitude(d: Any) -> Iterator[tuple[str, str, Any]]:
    """Heading and roll [deg] of the quaternion, from earth (NED) to body."""
    w, x, y, z = (d[f"q[{i}]"].astype(float) for i in range(4))
    yield "heading", HEADING, np.degrees(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))) % 360.0
    yield "roll", ROLL, np.degrees(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)))


def ulog_gps(d: Any) -> Iterator[tuple[str, str, Any]]:
    """Position and velocity of a receiver; NaN where it has no fix."""
    fixed = d["fix_type"] >= 2 if "fix_type" in d else np.ones(d["timestamp"].size, bool)
    lat, lon = (
        (d["latitude_deg"], d["longitude_deg"]) if "latitude_deg" in d else (d["lat"] * 1e-7, d["lon"] * 1e-7)
    )
    yield "latitude", "latitude_deg", np.where(fixed, lat, np.nan)
    yield "longitude", "longitude_deg", np.where(fixed, lon, np.nan)
    yield "vn", NORTH, np.where(fixed, d["vel_n_m_s"], np.nan)
    yield "ve", EAST, np.where(fixed, d["vel_e_m_s"], np.nan)


def ulog_local(d: Any) -> Iterator[tuple[str, str, Any]]:
    """Position [m] and velocity [m/s] in the local frame, north and east."""
    yield "north", "north_m", d["x"]
    yield "east", "east_m", d["y"]
    yield "vn", NORTH, d["vx"]
    yield "ve", EAST, d["vy"]


def ulog_wind(d: Any) -> Iterator[tuple[str, str, Any]]:
    """True wind: its speed [m/s], and where it comes from [deg]."""
    north, east = d["windspeed_north"].astype(float), d["windspeed_east"].astype(float)
    yield "speed", "true_wind_speed_mps", np.hypot(north, east)
    yield "from", "true_wind_direction_deg", np.degrees(np.arctan2(-east, -north)) % 360.0


TOPICS: dict[str, tuple[int, Callable[[Any], Iterator[tuple[str, str, Any]]]]] = {
    "vehicle_attitude": (0, ulog_attitude),
    "vehicle_gps_position": (0, ulog_gps),
    "sensor_gps": (1, ulog_gps),
    "vehicle_local_position": (1, ulog_local),
    "wind": (0, ulog_wind),
    "wind_estimate": (1, ulog_wind),
    "vehicle_angular_velocity": (0, lambda d: iter([("rate", RATE, np.degrees(d["xyz[2]"].astype(float)))])),
    "rpm": (
        0,
        lambda d: iter(
            [
                (
                    "rpm",
                    "propeller_rate_rpm",
                    d.get("rpm_estimate", d.get("indicated_frequency_rpm", np.nan * d["timestamp"])),
                )
            ]
        ),
    ),
    "actuator_outputs": (
        9,
        lambda d: ((f"output{i}", "", d[f"output[{i}]"]) for i in range(8) if f"output[{i}]" in d),
    ),
}
