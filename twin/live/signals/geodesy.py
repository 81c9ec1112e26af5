"""WGS84 to the flat chart of a voyage and back: the plane that touches the earth at the datum.

    north, east = rows of R(datum) (ecef(lat, lon) - ecef(datum))

Exact geometry, so the antimeridian needs no care. What a plane cannot hold: at 100 km a distance reads 4 m
short, and the meridians turn against the chart's north by `convergence_deg` (1.3 deg at 100 km east of 55 N,
nothing at the datum). Within MAX_LATITUDE_DEG of a pole, and farther than MAX_DISTANCE_M, a position is
refused. Source: Hofmann-Wellenhof et al., GNSS (2008), sections 8.2 and 8.4.
"""

from math import atan2, cos, degrees, hypot, isfinite, radians, sin, sqrt
from typing import NamedTuple

from twin.errors import SettingsError

A = 6378137.0  # WGS84 semi-major axis [m]
F = 1.0 / 298.257223563  # flattening
E2 = F * (2.0 - F)  # eccentricity squared
MAX_LATITUDE_DEG = 89.5
MAX_DISTANCE_M = 200e3


class Datum(NamedTuple):
    """Where north_m = east_m = 0; made by `datum()`. Angles as sines and cosines, x y z earth-centred [m]."""

    latitude_deg: float
    longitude_deg: float
    sin_lat: float
    cos_lat: float
    sin_lon: float
    cos_lon: float
    x: float
    y: float
    z: float


def datum(latitude_deg: float, longitude_deg: float) -> Datum:
    """The chart that touches the earth here; refuses what has no chart. SettingsError: it is no position,
    or too near a pole."""
    if not (isfinite(latitude_deg) and isfinite(longitude_deg)) or not -180.0 <= longitude_deg <= 360.0:
        raise SettingsError(f"Datum ({latitude_deg}, {longitude_deg}) is not a position in degrees.")
    if abs(latitude_deg) > MAX_LATITUDE_DEG:
        raise SettingsError(
            f"Datum latitude {latitude_deg} deg is within {90 - MAX_LATITUDE_DEG} deg of a pole: a flat "
            "chart has no north there. Sail, or simulate, at a lower latitude."
        )
    lat, lon = radians(latitude_deg), radians(longitude_deg)
    place = _ecef(lat, lon, 0.0)
    return Datum(latitude_deg, longitude_deg, sin(lat), cos(lat), sin(lon), cos(lon), *place)


def to_chart(at: Datum, latitude_deg: float, longitude_deg: float) -> tuple[float, float] | None:
    """(north_m, east_m) of a WGS84 position on the sea surface; None where the flat chart may not be used."""
    if not (abs(latitude_deg) <= MAX_LATITUDE_DEG and -180.0 <= longitude_deg <= 360.0):
        return None
    x, y, z = _ecef(radians(latitude_deg), radians(longitude_deg), 0.0)
    dx, dy, dz = x - at.x, y - at.y, z - at.z
    if dx * dx + dy * dy + dz * dz > MAX_DISTANCE_M**2:
        return None
    north = -at.sin_lat * (at.cos_lon * dx + at.sin_lon * dy) + at.cos_lat * dz
    return north, -at.sin_lon * dx + at.cos_lon * dy


def from_chart(at: Datum, north_m: float, east_m: float) -> tuple[float, float]:
    """(latitude_deg, longitude_deg) of the sea under a point of the chart; to a millimetre within 200 km."""
    up = 0.0
    for _ in range(4):  # sink from the plane to the ellipsoid: the height shrinks 30-fold or more each time
        latitude, longitude, height = _geodetic(*_lifted(at, north_m, east_m, up))
        up -= height
    return degrees(latitude), degrees(longitude)


def convergence_deg(at: Datum, longitude_deg: float) -> float:
    """Direction of true north on the chart [deg, clockwise]: heading on the chart = true heading + this."""
    turn = (longitude_deg - at.longitude_deg + 180.0) % 360.0 - 180.0
    return -turn * at.sin_lat


def _ecef(lat: float, lon: float, height_m: float) -> tuple[float, float, float]:
    s, c = sin(lat), cos(lat)
    n = A / sqrt(1.0 - E2 * s * s)
    return (n + height_m) * c * cos(lon), (n + height_m) * c * sin(lon), (n * (1.0 - E2) + height_m) * s


def _lifted(at: Datum, north: float, east: float, up: float) -> tuple[float, float, float]:
    """The earth-centred place of a point of the chart, `up` metres above the plane."""
    away = -at.sin_lat * north + at.cos_lat * up  # from the earth's axis, in the datum's meridian
    return (
        at.x + at.cos_lon * away - at.sin_lon * east,
        at.y + at.sin_lon * away + at.cos_lon * east,
        at.z + at.cos_lat * north + at.sin_lat * up,
    )


def _geodetic(x: float, y: float, z: float) -> tuple[float, float, float]:
    """Latitude, longitude [rad], height [m] near the surface (Bowring's formula)."""
    p = hypot(x, y)
    b = A * (1.0 - F)
    t = atan2(z * A, p * b)
    lat = atan2(z + E2 / (1.0 - E2) * b * sin(t) ** 3, p - E2 * A * cos(t) ** 3)
    n = A / sqrt(1.0 - E2 * sin(lat) ** 2)
    return lat, atan2(y, x), p * cos(lat) + z * sin(lat) - n * (1.0 - E2 * sin(lat) ** 2)
