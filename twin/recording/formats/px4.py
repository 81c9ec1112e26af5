"""Logs of PX4: ULog, by pyulog."""

from collections.abc import Callable, Iterator
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import DataError
from twin.recording.formats.extra import library, one_line
from twin.recording.formats.signals import Signals

ULOG = "a PX4 ULog"
HEADING, RATE, ROLL = "heading_true_north_deg", "yaw_rate_degps", "roll_deg"
NORTH, EAST = "velocity_north_mps", "velocity_east_mps"
Parts = Iterator[tuple[str, str, Any]]


def looks_ulog(lines: list[str], start: bytes) -> bool:
    """Whether a file starts as a ULog does."""
    return start.startswith(b"ULog\x01\x12\x35")


def read_ulog(path: Path) -> Signals:
    """Series named topic, instance and part (`vehicle_attitude0.heading`), on the UTC of the receiver
    where it knows one. DataError: it cannot be read."""
    module, out = library("pyulog", path, ULOG), Signals(path, ULOG)
    try:
        with redirect_stdout(StringIO()):  # the library prints what it stumbles over
            log = module.ULog(str(path), list(TOPICS))
    except MemoryError:
        raise
    except Exception as error:
        raise DataError(f"{path}: this is {ULOG}, and it cannot be read: {one_line(error)}.") from None
    start_s = utc_of_zero(log)
    for topic in log.data_list:
        rank, parts = TOPICS[topic.name]
        t = topic.data["timestamp"].astype(float) * 1e-6 + start_s
        try:
            found = list(parts(topic.data))
        except KeyError as lacking:  # another version names its parts otherwise
            out.notes.append(f"{topic.name} is not read: it has no {lacking.args[0]}")
            continue
        for part, quantity, values in found:
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


def ulog_attitude(d: Any) -> Parts:
    """Heading and roll [deg] of the quaternion, from earth (NED) to body."""
    w, x, y, z = (d[f"q[{i}]"].astype(float) for i in range(4))
    yield "heading", HEADING, np.degrees(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))) % 360.0
    yield "roll", ROLL, np.degrees(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)))
    if "yawspeed" in d:
        yield "rate", RATE, np.degrees(d["yawspeed"].astype(float))


def ulog_gps(d: Any) -> Parts:
    """Position and velocity of a receiver; NaN where it has no fix."""
    fixed = d["fix_type"] >= 2 if "fix_type" in d else np.ones(d["timestamp"].size, bool)
    lat, lon = (
        (d["latitude_deg"], d["longitude_deg"]) if "latitude_deg" in d else (d["lat"] * 1e-7, d["lon"] * 1e-7)
    )
    yield "latitude", "latitude_deg", np.where(fixed, lat, np.nan)
    yield "longitude", "longitude_deg", np.where(fixed, lon, np.nan)
    if "vel_n_m_s" in d:
        yield "vn", NORTH, np.where(fixed, d["vel_n_m_s"], np.nan)
        yield "ve", EAST, np.where(fixed, d["vel_e_m_s"], np.nan)
    elif "vel_m_s" in d and "cog_rad" in d:
        yield "speed", "speed_over_ground_mps", np.where(fixed, d["vel_m_s"], np.nan)
        yield "course", "course_over_ground_deg", np.where(fixed, np.degrees(d["cog_rad"]) % 360.0, np.nan)


def ulog_local(d: Any) -> Parts:
    """Position [m] and velocity [m/s] in the local frame, north and east."""
    yield "north", "north_m", d["x"]
    yield "east", "east_m", d["y"]
    yield "vn", NORTH, d["vx"]
    yield "ve", EAST, d["vy"]


def ulog_global(d: Any) -> Parts:
    """Position of the estimate."""
    yield "latitude", "latitude_deg", d["lat"]
    yield "longitude", "longitude_deg", d["lon"]


def ulog_rates(d: Any) -> Parts:
    """Rates of the motors, by their controllers; one that never turned is not there."""
    for i in range(8):
        rate = d.get(f"esc[{i}].esc_rpm", np.zeros(1)).astype(float)
        if np.any(rate):
            yield f"motor{i + 1}", f"motor_{i + 1}.rate_rpm", rate


def numbered(stem: str) -> Callable[[Any], Parts]:
    """The outputs of a topic, of no channel yet; those that are never set are not there."""

    def parts(d: Any) -> Parts:
        for i in range(16):
            values = d.get(f"{stem}[{i}]", np.zeros(1)).astype(float)
            if np.any(np.isfinite(values) & (values != 0.0)):
                yield f"{stem}{i}", "", values

    return parts


def ulog_wind(d: Any) -> Parts:
    """True wind: its speed [m/s], and where it comes from [deg]."""
    north, east = d["windspeed_north"].astype(float), d["windspeed_east"].astype(float)
    yield "speed", "true_wind_speed_mps", np.hypot(north, east)
    yield "from", "true_wind_direction_deg", np.degrees(np.arctan2(-east, -north)) % 360.0


TOPICS: dict[str, tuple[int, Callable[[Any], Parts]]] = {
    "vehicle_attitude": (0, ulog_attitude),
    "vehicle_gps_position": (0, ulog_gps),
    "sensor_gps": (1, ulog_gps),
    "vehicle_global_position": (2, ulog_global),
    "vehicle_local_position": (1, ulog_local),
    "sensor_combined": (2, lambda d: iter([("rate", RATE, np.degrees(d["gyro_rad[2]"].astype(float)))])),
    "esc_status": (0, ulog_rates),
    "actuator_motors": (9, numbered("control")),
    "actuator_servos": (9, numbered("control")),
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
    "actuator_outputs": (9, numbered("output")),
}
