"""NMEA 0183 sentences as quantities: one function a sentence, of its fields to (part, quantity, value).

Source: IEC 61162-1:2016; E. S. Raymond, "NMEA Revealed" (gpsd.gitlab.io/gpsd/NMEA.html). Fields count from 1
after the address. Knots, feet and deg/min leave here as m/s, m and deg/s.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence

KNOT = 1852.0 / 3600.0
Fields = Sequence[str]
Part = tuple[str, str, float]  # name within the sentence, quantity, value
SPEED = {"N": KNOT, "K": 1.0 / 3.6, "M": 1.0, "S": 0.44704}
HEADING, MAGNETIC, VARIATION = "heading_true_north_deg", "heading_magnetic_deg", "magnetic_variation_deg"
SOG, COG = "speed_over_ground_mps", "course_over_ground_deg"
AHEAD_WATER, ASIDE_WATER = "surge_velocity_through_water_mps", "sway_velocity_through_water_mps"


def number(f: Fields, i: int) -> float | None:
    """Field i as a number; None when it is empty or absent."""
    return float(f[i]) if i < len(f) and f[i] else None


def letter(f: Fields, i: int) -> str:
    """A field in capitals; "" where the sentence is shorter."""
    return f[i].strip().upper() if i < len(f) else ""


def degrees(f: Fields, i: int) -> float | None:
    """ddmm.mmm in field i, its hemisphere in the next."""
    if i + 1 >= len(f) or not f[i]:
        return None
    point = f[i].find(".")
    whole = (len(f[i]) if point < 0 else point) - 2
    value = (float(f[i][:whole]) if whole > 0 else 0.0) + float(f[i][whole:]) / 60.0
    return -value if f[i + 1][:1] in "SWsw" and f[i + 1] else value


def one(name: str, quantity: str, value: float | None, scale: float = 1.0) -> tuple[Part, ...]:
    """The part, if it has a value, times `scale`."""
    return () if value is None else ((name, quantity, value * scale),)


def place(f: Fields, i: int) -> Iterator[Part]:
    """Latitude and longitude [deg], if both are there, from field `i` on."""
    latitude, longitude = degrees(f, i), degrees(f, i + 2)
    if latitude is not None and longitude is not None:
        yield "latitude", "latitude_deg", latitude
        yield "longitude", "longitude_deg", longitude


def signed(f: Fields, i: int, negative: str = "W") -> float | None:
    """A number in field i that the letter after it makes negative."""
    value = number(f, i)
    return -value if value is not None and letter(f, i + 1) == negative else value


def rmc(f: Fields) -> Iterator[Part]:
    """RMC: position, speed, course and variation, if valid."""
    if letter(f, 2) != "A":
        return
    yield from place(f, 3)
    yield from one("sog", SOG, number(f, 7), KNOT)
    yield from one("cog", COG, number(f, 8))
    yield from one("variation", VARIATION, signed(f, 10))


def gll(f: Fields) -> Iterator[Part]:
    """GLL: position, if valid."""
    if letter(f, 6) in ("A", ""):
        yield from place(f, 1)


def gga(f: Fields) -> Iterator[Part]:
    """GGA: position, if there is a fix."""
    if letter(f, 6) not in ("", "0"):
        yield from place(f, 2)


def gns(f: Fields) -> Iterator[Part]:
    """GNS: position, if any of the systems has a fix."""
    if letter(f, 6).strip("N"):
        yield from place(f, 2)


def vtg(f: Fields) -> Iterator[Part]:
    """VTG: true course and speed over ground."""
    yield from one("cog", COG, number(f, 1))
    knots = number(f, 5)
    yield from one("sog", SOG, knots, KNOT) if knots is not None else one("sog", SOG, number(f, 7), 1.0 / 3.6)


def hdt(f: Fields) -> Iterable[Part]:
    """HDT: true heading."""
    return one("heading", HEADING, number(f, 1))


def ths(f: Fields) -> Iterator[Part]:
    """THS: true heading, unless simulated or not valid."""
    if letter(f, 2) in ("A", "E", "M", ""):
        yield from one("heading", HEADING, number(f, 1))


def hdm(f: Fields) -> Iterable[Part]:
    """HDM: magnetic heading."""
    return one("heading", MAGNETIC, number(f, 1))


def hdg(f: Fields) -> Iterator[Part]:
    """HDG: magnetic heading with its deviation, and the variation."""
    value = number(f, 1)
    if value is not None:
        yield "heading", MAGNETIC, value + (signed(f, 2) or 0.0)
    yield from one("variation", VARIATION, signed(f, 4))


def vhw(f: Fields) -> Iterator[Part]:
    """VHW: heading, true and magnetic, and speed through the water."""
    yield from one("heading", HEADING, number(f, 1))
    yield from one("magnetic", MAGNETIC, number(f, 3))
    knots = number(f, 5)
    yield from (
        one("speed", AHEAD_WATER, knots, KNOT)
        if knots is not None
        else one("speed", AHEAD_WATER, number(f, 7), 1.0 / 3.6)
    )


def vbw(f: Fields) -> Iterator[Part]:
    """VBW: speed through the water and over ground, ahead and aside, each if valid."""
    if letter(f, 3) == "A":
        yield from one("ahead", AHEAD_WATER, number(f, 1), KNOT)
        yield from one("aside", ASIDE_WATER, number(f, 2), KNOT)
    if letter(f, 6) == "A":
        yield from one("ground_ahead", "surge_velocity_mps", number(f, 4), KNOT)
        yield from one("ground_aside", "sway_velocity_mps", number(f, 5), KNOT)


def rot(f: Fields) -> Iterable[Part]:
    """ROT: rate of turn [deg/s]."""
    return one("rate", "yaw_rate_degps", number(f, 1), 1.0 / 60.0) if letter(f, 2) in ("A", "") else ()


def rsa(f: Fields) -> Iterator[Part]:
    """RSA: rudder angle, of the starboard (or only) and of the port rudder."""
    if letter(f, 2) == "A":
        yield from one("starboard", "rudder_angle_deg", number(f, 1))
    if letter(f, 4) == "A":
        yield from one("port", "rudder_angle_deg", number(f, 3))


def rpm(f: Fields) -> Iterator[Part]:
    """RPM: rate of a shaft or an engine [rpm], and its pitch [%]."""
    shaft, no = letter(f, 1) == "S", letter(f, 2) or "0"
    if letter(f, 5) in ("A", ""):
        part, quantity = ("shaft", "propeller_rate_rpm") if shaft else ("engine", "engine_rate_rpm")
        yield from one(f"{part}{no}", quantity, number(f, 3))
        yield from one(f"pitch{no}", "propeller_pitch_pct", number(f, 4))


def mwv(f: Fields) -> Iterator[Part]:
    """MWV: wind angle and speed, apparent or true, if valid."""
    angle, speed, scale = number(f, 1), number(f, 3), SPEED.get(letter(f, 4))
    if letter(f, 5) not in ("A", "") or angle is None or speed is None or scale is None:
        return
    if letter(f, 2) == "R":
        yield "angle", "apparent_wind_angle_deg", angle
        yield "speed", "apparent_wind_speed_mps", speed * scale
    else:
        yield "true_angle", "true_wind_angle_deg", angle
        yield "true_speed", "", speed * scale


def mwd(f: Fields) -> Iterator[Part]:
    """MWD: where the true wind comes from, and its speed."""
    direction, knots, metres = number(f, 1), number(f, 5), number(f, 7)
    if direction is not None and (metres is not None or knots is not None):
        yield "direction", "true_wind_direction_deg", direction
        yield "speed", "true_wind_speed_mps", metres if metres is not None else (knots or 0.0) * KNOT


def vwr(f: Fields) -> Iterator[Part]:
    """VWR: apparent wind angle, positive to starboard, and speed."""
    angle, knots, metres = signed(f, 1, "L"), number(f, 3), number(f, 5)
    if angle is not None and (knots is not None or metres is not None):
        yield "angle", "apparent_wind_angle_deg", angle
        yield "speed", "apparent_wind_speed_mps", metres if knots is None else knots * KNOT  # type: ignore[misc]


def dpt(f: Fields) -> Iterator[Part]:
    """DPT: water depth, from the surface where the transducer's offset says how far that is."""
    depth = number(f, 1)
    if depth is not None:
        yield "depth", "water_depth_m", depth + max(number(f, 2) or 0.0, 0.0)


def dbt(f: Fields) -> Iterator[Part]:
    """DBT: water depth below the transducer."""
    feet, metres = number(f, 1), number(f, 3)
    yield from (
        one("depth", "water_depth_m", metres)
        if metres is not None
        else one("depth", "water_depth_m", feet, 0.3048)
    )


def xdr(f: Fields) -> Iterator[Part]:
    """XDR: roll, by the transducer names that are in use."""
    for i in range(1, len(f) - 3, 4):
        if letter(f, i) == "A" and letter(f, i + 3) in ("ROLL", "PTCH_ROLL", "HEEL"):
            yield from one("roll", "roll_deg", number(f, i + 1))


def shr(f: Fields) -> Iterator[Part]:
    """PASHR: true heading and roll of an inertial unit."""
    if letter(f, 3) == "T":
        yield from one("heading", HEADING, number(f, 2))
        yield from one("roll", "roll_deg", number(f, 4))


def trd(f: Fields) -> Iterator[Part]:
    """TRD: what a thruster does: its rate or share of full, and its angle, of no channel yet."""
    no = letter(f, 1) or "0"
    if letter(f, 3) in ("R", "P"):
        rate = letter(f, 3) == "R"
        yield from one(
            f"thruster{no}_{'rpm' if rate else 'command'}", "", number(f, 2), 1.0 if rate else 0.01
        )
    if letter(f, 5) in ("P", "D"):
        yield from one(f"thruster{no}_pitch", "", number(f, 4))
    yield from one(f"thruster{no}_angle", "", number(f, 6))


SENTENCES: dict[str, tuple[int, Callable[[Fields], Iterable[Part]]]] = {
    "RMC": (1, rmc), "GGA": (0, gga), "GNS": (0, gns), "GLL": (2, gll), "VTG": (0, vtg), "HDT": (0, hdt),
    "THS": (0, ths), "HDG": (0, hdg), "HDM": (1, hdm), "VHW": (3, vhw), "VBW": (1, vbw), "ROT": (0, rot),
    "RSA": (0, rsa), "RPM": (0, rpm), "MWV": (0, mwv), "MWD": (0, mwd), "VWR": (1, vwr), "DPT": (1, dpt),
    "DBT": (2, dbt), "DBS": (0, dbt), "XDR": (0, xdr), "SHR": (1, shr), "TRD": (9, trd),
}  # fmt: skip
"""{sentence: (rank among sentences of the same quantity, the fields it gives)}."""
CLOCKS = {
    "RMC": 0,
    "ZDA": 1,
    "GGA": 2,
    "GNS": 2,
    "GLL": 3,
}  # which sentence sets the clock: the lower, the sooner
