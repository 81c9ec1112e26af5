"""NMEA 2000 parameter groups as quantities: one function a group, of its bytes to (part, quantity, value).

Source: canboat's public table of parameter groups (github.com/canboat/canboat, docs/canboat.xml). Integers
    are
little-endian; the three largest values of a field mean "not available", "error" and "reserved".
"""

from collections.abc import Callable, Iterator

from twin.physics.maths import RAD

Part = tuple[str, str, float]
ANGLE = 1e-4 * RAD  # [deg] a step of most angles


def unsigned(d: bytes, at: int, size: int, scale: float) -> float | None:
    """None where the field is cut off or holds one of its three reserved codes."""
    if at + size > len(d):
        return None
    raw = int.from_bytes(d[at : at + size], "little")
    return None if raw >= (1 << 8 * size) - 3 else raw * scale


def signed(d: bytes, at: int, size: int, scale: float) -> float | None:
    """The signed number of so many bytes, times `scale`; None: it is past the end or not available."""
    if at + size > len(d):
        return None
    raw = int.from_bytes(d[at : at + size], "little", signed=True)
    return None if raw >= (1 << (8 * size - 1)) - 3 else raw * scale


def one(part: str, quantity: str, value: float | None) -> Iterator[Part]:
    """The part, if it has a value."""
    if value is not None:
        yield part, quantity, value


def rudder(d: bytes) -> Iterator[Part]:
    """Rudder angle, of the instance that sends it."""
    instance = d[0]
    name = "position" if instance in (0, 252, 253, 254, 255) else f"position{instance}"
    yield from one(name, "rudder_angle_deg", signed(d, 4, 2, ANGLE))


def heading(d: bytes) -> Iterator[Part]:
    """Heading, true or magnetic with its deviation, and the variation [deg]."""
    shown, reference = unsigned(d, 1, 2, ANGLE), d[7] & 3 if len(d) > 7 else 3
    if shown is not None and reference == 0:
        yield "heading_true", "heading_true_north_deg", shown
    elif shown is not None and reference == 1:
        yield "heading_magnetic", "heading_magnetic_deg", shown + (signed(d, 3, 2, ANGLE) or 0.0)
    yield from one("variation", "magnetic_variation_deg", signed(d, 5, 2, ANGLE))


def rate_of_turn(d: bytes) -> Iterator[Part]:
    """Yaw rate [deg/s]."""
    yield from one("rate", "yaw_rate_degps", signed(d, 1, 4, 1e-6 / 32.0 * RAD))


def attitude(d: bytes) -> Iterator[Part]:
    """Yaw as true heading, and roll [deg]."""
    yaw = signed(d, 1, 2, ANGLE)
    yield from one("yaw", "heading_true_north_deg", None if yaw is None else yaw % 360.0)
    yield from one("roll", "roll_deg", signed(d, 5, 2, ANGLE))


def variation(d: bytes) -> Iterator[Part]:
    """Magnetic variation [deg]."""
    yield from one("variation", "magnetic_variation_deg", signed(d, 4, 2, ANGLE))


def engine(d: bytes) -> Iterator[Part]:
    """Engine rate [rpm], of the instance that sends it."""
    yield from one(f"engine{d[0]}", "engine_rate_rpm", unsigned(d, 1, 2, 0.25))


def speed(d: bytes) -> Iterator[Part]:
    """Speed through the water [m/s], ahead."""
    yield from one("water", "surge_velocity_through_water_mps", unsigned(d, 1, 2, 0.01))


def speed_components(d: bytes) -> Iterator[Part]:
    """Speed through the water [m/s], ahead and aside."""
    yield from one("water_ahead", "surge_velocity_through_water_mps", signed(d, 0, 2, 0.001))
    yield from one("water_aside", "sway_velocity_through_water_mps", signed(d, 2, 2, 0.001))


def depth(d: bytes) -> Iterator[Part]:
    """Water depth [m]: below the transducer, and how far that is under the surface."""
    below, offset = unsigned(d, 1, 4, 0.01), signed(d, 5, 2, 0.001)
    if below is not None:
        yield "depth", "water_depth_m", below + max(offset or 0.0, 0.0)


def position(d: bytes) -> Iterator[Part]:
    """Latitude and longitude [deg]."""
    yield from _place(signed(d, 0, 4, 1e-7), signed(d, 4, 4, 1e-7))


def gnss(d: bytes) -> Iterator[Part]:
    """Latitude and longitude [deg], in full resolution."""
    yield from _place(signed(d, 7, 8, 1e-16), signed(d, 15, 8, 1e-16))


def _place(latitude: float | None, longitude: float | None) -> Iterator[Part]:
    if latitude is not None and longitude is not None:
        yield "latitude", "latitude_deg", latitude
        yield "longitude", "longitude_deg", longitude


def course(d: bytes) -> Iterator[Part]:
    """Course over ground, if it is true, and speed."""
    if d[1] & 3 == 0:
        yield from one("cog", "course_over_ground_deg", unsigned(d, 2, 2, ANGLE))
    yield from one("sog", "speed_over_ground_mps", unsigned(d, 4, 2, 0.01))


def wind(d: bytes) -> Iterator[Part]:
    """Wind speed and angle, by the reference that the message names."""
    speed_mps, angle, reference = unsigned(d, 1, 2, 0.01), unsigned(d, 3, 2, ANGLE), d[5] & 7
    if speed_mps is None or angle is None:
        return
    kind = {
        0: "true_wind_direction_deg",
        2: "apparent_wind_angle_deg",
        3: "true_wind_angle_deg",
        4: "true_wind_angle_deg",
    }.get(reference)
    if kind in ("true_wind_direction_deg", "apparent_wind_angle_deg"):
        yield f"wind{reference}_angle", kind, angle
        yield f"wind{reference}_speed", kind.split("_")[0] + "_wind_speed_mps", speed_mps
    elif kind:
        yield f"wind{reference}_angle", kind, angle


GROUPS: dict[int, tuple[int, int, Callable[[bytes], Iterator[Part]]]] = {
    127245: (0, 6, rudder), 127250: (0, 8, heading), 127251: (0, 5, rate_of_turn), 127257: (0, 7, attitude),
    127258: (1, 6, variation), 127488: (0, 3, engine), 128259: (0, 3, speed), 128267: (0, 5, depth),
    129025: (0, 8, position), 129026: (0, 6, course), 129029: (1, 23, gnss), 130306: (0, 6, wind),
    130578: (1, 4, speed_components),
}  # fmt: skip
"""{group: (rank among groups of the same quantity, the fewest bytes, what it holds)}."""
FAST = frozenset(
    (
        126996,
        127237,
        127489,
        127506,
        128275,
        129029,
        129038,
        129039,
        129040,
        129044,
        129284,
        129285,
        129540,
        129794,
        129809,
        129810,
        130577,
        130578,
        130820,
        130842,
    )
)
AIS = frozenset((129038, 129039, 129040, 129041, 129793, 129794, 129798, 129801, 129802, 129809, 129810))


class FastPackets:
    """Messages of more than eight bytes, put together from their frames."""

    def __init__(self) -> None:
        self._open: dict[tuple[int, int], tuple[int, int, int, bytearray]] = {}

    def add(self, pgn: int, source: int, frame: bytes) -> bytes | None:
        """The whole message when this frame completes it; a lost frame loses the message, never the next."""
        if len(frame) < 2:
            return None
        sequence, number, key = frame[0] >> 5, frame[0] & 31, (pgn, source)
        if number == 0:
            self._open[key] = (sequence, 1, frame[1], bytearray(frame[2:]))
        else:
            begun = self._open.get(key)
            if begun is None or begun[:2] != (sequence, number):
                self._open.pop(key, None)
                return None
            begun[3].extend(frame[1:])
            self._open[key] = (sequence, number + 1, begun[2], begun[3])
        _, _, size, data = self._open[key]
        if len(data) < size:
            return None
        del self._open[key]
        return bytes(data[:size])
