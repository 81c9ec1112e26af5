"""Logs of ArduPilot and of any autopilot that speaks MAVLink: DataFlash (.BIN) and telemetry (.tlog), by
pymavlink."""

from collections.abc import Callable, Iterator
from contextlib import redirect_stdout
from io import StringIO
from math import atan2, degrees
from pathlib import Path
from typing import Any

from twin.errors import DataError
from twin.recording.formats.autopilot_settings import by_function, setting
from twin.recording.formats.extra import library, one_line, silent
from twin.recording.formats.signals import Signals

FLASH, TLOG = "an ArduPilot DataFlash log", "a MAVLink telemetry log"
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
    """The servo outputs as they are written [us], of no channel yet; early versions call them otherwise."""
    for i in range(1, 15):
        value = next((getattr(m, f"{c}{i}") for c in ("C", "Ch", "Chan") if hasattr(m, f"{c}{i}")), None)
        if value is not None:
            yield f"C{i}", "", float(value)


def wind(m: Any) -> Iterator[Part]:
    """Wind on the boat, and over ground where it is written."""
    yield "speed", "apparent_wind_speed_mps", m.SpdA
    yield "angle", "apparent_wind_angle_deg", m.DirA % 360.0
    if hasattr(m, "SpdT") and hasattr(m, "DirT"):
        yield "true_speed", "true_wind_speed_mps", m.SpdT
        yield "direction", "true_wind_direction_deg", m.DirT % 360.0


def turns(m: Any) -> Iterator[Part]:
    """Rates of two sensors in one message, or of the one that the message names."""
    if hasattr(m, "rpm1"):
        yield "rpm1", "propeller_rate_rpm", m.rpm1
        if m.rpm2 > 0.0:
            yield "rpm2", "", m.rpm2
    else:
        yield "rpm", "propeller_rate_rpm" if getattr(m, "I", 0) == 0 else "", m.RPM


def esc(m: Any) -> Iterator[Part]:
    """The rate of one motor, by its controller."""
    no = getattr(m, "Instance", getattr(m, "I", None))
    no = int(m.get_type()[3:] or 1) - 1 if no is None else int(no)
    yield f"motor{no + 1}", f"motor_{no + 1}.rate_rpm", float(m.RPM)


def place(m: Any) -> Iterator[Part]:
    """Position of the estimate."""
    yield "latitude", "latitude_deg", m.Lat
    yield "longitude", "longitude_deg", m.Lng


def second_attitude(m: Any) -> Iterator[Part]:
    """Heading and roll of the estimate that stands by."""
    yield "yaw", HEADING, m.Yaw % 360.0
    yield "roll", ROLL, m.Roll


FLASHED: dict[str, tuple[int, Callable[[Any], Iterator[Part]]]] = {
    "ATT": (0, att),
    "AHR2": (4, second_attitude),
    "GPS": (0, gps),
    "GPS2": (1, gps),
    "POS": (1, place),
    "XKF1": (1, ekf),
    "NKF1": (2, ekf),
    "EKF1": (3, ekf),
    "RCOU": (9, outputs),
    "IMU": (0, lambda m: iter([("rate", RATE, degrees(m.GyrZ))])),
    "RPM": (0, turns),
    "ESC": (0, esc),
    **{f"ESC{i}": (0, esc) for i in range(1, 9)},
    "WIND": (0, wind),
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
    for i in range(1, 17):
        if value := getattr(m, f"servo{i}_raw", 0):
            yield f"servo{i}", "", float(value)


def by_quaternion(m: Any) -> Iterator[Part]:
    """Heading, roll [deg] and rate of turn [deg/s] of a quaternion from earth to body."""
    w, x, y, z = m.q1, m.q2, m.q3, m.q4
    yield "yaw", HEADING, degrees(atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))) % 360.0
    yield "roll", ROLL, degrees(atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)))
    yield "rate", RATE, degrees(m.yawspeed)


def local(m: Any) -> Iterator[Part]:
    """Position [m] and velocity [m/s] in the local frame, north and east."""
    yield "north", "north_m", m.x
    yield "east", "east_m", m.y
    yield "vn", NORTH, m.vx
    yield "ve", EAST, m.vy


def escs(first: int) -> Callable[[Any], Iterator[Part]]:
    """The rates of four motors, from `first` on; one that never turned is not there."""

    def parts(m: Any) -> Iterator[Part]:
        for i, rate in enumerate(m.rpm):
            if rate:
                yield f"motor{first + i}", f"motor_{first + i}.rate_rpm", float(rate)

    return parts


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
    "GPS2_RAW": (1, raw_int),
    "ATTITUDE_QUATERNION": (1, by_quaternion),
    "LOCAL_POSITION_NED": (2, local),
    "VFR_HUD": (
        3,
        lambda m: iter(
            [("heading", HEADING, m.heading % 360.0), ("speed", "speed_over_ground_mps", m.groundspeed)]
        ),
    ),
    "ESC_TELEMETRY_1_TO_4": (0, escs(1)),
    "ESC_TELEMETRY_5_TO_8": (0, escs(5)),
    "WATER_DEPTH": (0, lambda m: iter([("depth", "water_depth_m", m.distance)])),
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
    settings: dict[str, float] = {}
    try:
        with silent(), redirect_stdout(StringIO()):
            log = opened()
            while (m := log.recv_msg()) is not None:
                if m.get_type() in ("PARM", "PARAM_VALUE"):
                    setting(settings, m)
                else:
                    keep(out, m, known, source_of)
    except MemoryError:
        raise
    except Exception as error:
        if not out.series:
            raise DataError(
                f"{out.path}: this is {out.says}, and it cannot be read: {one_line(error)}."
            ) from None
        out.notes.append(f"it is damaged and was read up to there: {one_line(error)}")
    by_function(out, settings)
    out.without_strays()
    return out.finish()


def keep(
    out: Signals,
    m: Any,
    known: dict[str, tuple[int, Callable[[Any], Iterator[Part]]]],
    source_of: Callable[[Any], str | None],
) -> None:
    """One message's values into their series; one of another kind, or with other parts, is counted."""
    kind = m.get_type()
    source = source_of(m) if kind in known else None
    if source is None:
        out.skipped["messages of other kinds"] += 1
        return
    rank, parts = known[kind]
    try:
        values = list(parts(m))
    except (AttributeError, TypeError, ValueError):  # another version names its parts otherwise
        out.skipped[f"{kind} messages that hold other parts"] += 1
        return
    for part, quantity, value in values:
        out.put(f"{kind}{source}.{part}", source, quantity, float(m._timestamp), float(value), rank)
