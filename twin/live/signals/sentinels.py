"""Numbers that are not measurements: what NMEA 2000, AIS and old loggers send for "not available".

NMEA 2000 marks "not available / error / reserved" by the three largest values of the field's integer type, so
a converter that forgets this publishes 375.49 deg for a heading. AIS says 511 deg, 102.3 kn, 181 deg E, 91
deg N. Sources: NMEA 2000 appendix B.1; ITU-R M.1371-5, table 48.
"""

from twin.live.signals.channels import CHANNELS
from twin.physics.maths import RAD

Field = tuple[tuple[int, ...], float]  # (raw codes, resolution in border units)
KNOT = 1852.0 / 3600.0

UINT16 = (65535, 65534, 65533)
INT16 = (32767, 32766, 32765)
INT32 = (2147483647, 2147483646, 2147483645)
UINT32 = (4294967295, 4294967294, 4294967293)
DIRECTION: list[Field] = [(UINT16, 1e-4 * RAD)]  # 0 to 360: [deg]
ANGLE: list[Field] = [(INT16, 1e-4 * RAD)]  # to either side: [deg]
SPEED: list[Field] = [(UINT16, 0.01), (INT16, 0.01), (UINT16, 0.01 * KNOT), ((1023,), 0.1 * KNOT)]  # [m/s]

FIELDS: dict[str, list[Field]] = {
    "heading_true_north_deg": [*DIRECTION, ((511,), 1.0)],
    "true_wind_direction_deg": DIRECTION,
    "apparent_wind_angle_deg": DIRECTION,
    "wave_direction_deg": DIRECTION,
    "rudder_angle_deg": ANGLE,
    "roll_deg": ANGLE,
    "yaw_rate_degps": [(INT32, 1e-6 / 32 * RAD), ((-1,), (128 / 4.733) ** 2 / 60.0)],
    "propeller_rate_rpm": [(UINT16, 0.25), (INT16, 0.25)],
    "water_depth_m": [(UINT32, 0.01), (UINT16, 0.1)],
    "draught_mean_m": [(UINT16, 0.01), (INT16, 0.01)],
    **{c.name: SPEED for c in CHANNELS if c.name.endswith("_mps")},
}
GENERIC = (-999.0, -9999.0, 9999.0, -32768.0, 32767.0, 65535.0, 99999.0, 1e20)  # only out of range
IN_RANGE_TOO = 2e-5  # relative width of a channel's own code (float32, or rounded to two decimals)


def _codes(channel: str) -> tuple[float, ...]:
    return tuple(raw * resolution for codes, resolution in FIELDS.get(channel, []) for raw in codes)


CODES: dict[str, tuple[float, ...]] = {c.name: _codes(c.name) for c in CHANNELS}


def is_sentinel(channel: str, value: float, out_of_range: bool) -> bool:
    """Whether a value is a "not available" code of this channel; the generic ones only when out of range."""
    if out_of_range and value in GENERIC:
        return True
    width = abs(value) * IN_RANGE_TOO
    for code in CODES.get(channel, ()):  # noqa: SIM110 (called for each sample: three times as fast as any())
        if -width <= value - code <= width:
            return True
    return False


def is_no_position(latitude_deg: float, longitude_deg: float) -> bool:
    """AIS 91/181, NMEA 2000's largest integers, and exactly 0/0: an empty message more often than a ship."""
    return (
        (latitude_deg == 0.0 and longitude_deg == 0.0)
        or abs(latitude_deg) in (91.0, 214.7483647)
        or abs(longitude_deg) in (181.0, 214.7483647)
    )
