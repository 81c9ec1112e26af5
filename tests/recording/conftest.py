"""A ship that exists only in kinematics: its columns agree, until a test plants a mistake."""

import os
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.read import read_voyage

STEP_S = 0.1
REQUIRED = (
    "time_s",
    "north_m",
    "east_m",
    "heading_true_north_deg",
    "rudder_angle_deg",
    "propeller_rate_rpm",
    "surge_velocity_mps",
    "sway_velocity_mps",
    "yaw_rate_degps",
)


def sail(
    duration_s: float = 900.0,
    length_m: float = 100.0,
    speed_mps: float = 7.0,
    noise: float = 1.0,
    seed: int = 0,
):
    """{column: (N,)} with `time_s`: 20 deg zigzags by Nomoto's equation, wind, a log in a current, noise.
    Whoever asks has arrays of its own."""
    return {name: x.copy() for name, x in once(duration_s, length_m, speed_mps, noise, seed).items()}


@lru_cache(maxsize=32)
def once(duration_s: float, length_m: float, speed_mps: float, noise: float, seed: int):
    """The same, sailed once."""
    t = np.arange(0.0, duration_s, STEP_S)
    rng = np.random.default_rng(seed)
    r, psi, rudder, order = (np.zeros(t.size) for _ in range(4))
    time_scale, gain = length_m / speed_mps, 0.8 * speed_mps / length_m
    side = 20.0
    for k in range(1, t.size):
        if np.degrees(psi[k - 1]) * np.sign(side) > 20.0:
            side = -side
        order[k] = side
        rudder[k] = rudder[k - 1] + np.clip(side - rudder[k - 1], -3.0 * STEP_S, 3.0 * STEP_S)
        r[k] = r[k - 1] + STEP_S * (gain * np.radians(rudder[k - 1]) - r[k - 1]) / time_scale
        psi[k] = psi[k - 1] + STEP_S * (r[k] + r[k - 1]) / 2.0
    psi = psi + np.radians(355.0)
    u = speed_mps * (1.0 - 0.1 * (np.degrees(psi - psi.mean()) / 30.0) ** 2 * 0.3)
    v = -0.4 * length_m * r
    over_ground = (u + 1j * v) * np.exp(1j * psi)
    place = np.r_[0.0, np.cumsum((over_ground[1:] + over_ground[:-1]) / 2.0 * STEP_S)]
    through_water = (over_ground - (0.3 - 0.4j)) * np.exp(-1j * psi)
    true_wind = 9.0 * np.exp(1j * np.radians(70.0 + 4.0 * np.sin(t / 40.0)))  # where it comes from
    apparent = true_wind * np.exp(-1j * psi) + u + 1j * v

    def with_noise(x: np.ndarray, sigma: float) -> np.ndarray:
        return x + noise * sigma * rng.normal(size=t.size)

    return {
        "time_s": t,
        "north_m": with_noise(place.real, 0.3),
        "east_m": with_noise(place.imag, 0.3),
        "heading_true_north_deg": np.mod(with_noise(np.degrees(psi), 0.1), 360.0),
        "surge_velocity_mps": with_noise(u, 0.05),
        "sway_velocity_mps": with_noise(v, 0.05),
        "surge_velocity_through_water_mps": with_noise(through_water.real, 0.05),
        "yaw_rate_degps": with_noise(np.degrees(r), 0.02),
        "rudder_angle_deg": with_noise(rudder, 0.1),
        "propeller_rate_rpm": with_noise(np.full(t.size, 110.0), 0.2),
        "true_wind_speed_mps": with_noise(np.abs(true_wind), 0.5),
        "true_wind_direction_deg": np.mod(with_noise(np.degrees(np.angle(true_wind)), 2.0), 360.0),
        "apparent_wind_speed_mps": with_noise(np.abs(apparent), 0.5),
        "apparent_wind_angle_deg": np.mod(with_noise(np.degrees(np.angle(apparent)), 2.0), 360.0),
    }


@pytest.fixture(name="sail", scope="session")
def sail_fixture():
    return sail


@pytest.fixture
def write_csv(tmp_path):
    """Writes {column: values} as a CSV and gives its path."""

    def write(columns, name="voyage.csv", separator=",", decimal=".", encoding="utf-8", digits=10):
        path = tmp_path / name
        rows = zip(*(np.asarray(c).tolist() for c in columns.values()), strict=True)
        lines = [separator.join(columns)]
        for row in rows:
            cells = ["" if x != x else x if isinstance(x, str) else f"{x:.{digits}g}" for x in row]
            lines.append(separator.join(c.replace(".", decimal) for c in cells))
        path.write_bytes(("\n".join(lines) + "\n").encode(encoding))
        return path

    return write


@pytest.fixture
def required():
    """The columns that no voyage can do without."""
    return REQUIRED


@pytest.fixture
def columns(sail):
    full = sail(60.0)
    return {name: full[name] for name in REQUIRED}


@pytest.fixture(name="refused")
def refused_fixture():
    return refused


def refused(path, *words, by=None):
    """The message of the DataError, which is one line that names the file and holds the words."""
    with pytest.raises(DataError) as caught:
        read_voyage(path, by)
    message = str(caught.value)
    assert str(path) in message and "\n" not in message
    for word in words:
        assert word in message, message
    return message


KNOT = 1852.0 / 3600.0


def motion(seconds=120, hz=1.0):
    """A ship at 6 m/s that swings about 45 deg, the truth of every log here."""
    t = np.arange(0.0, seconds, 1.0 / hz)
    psi = 45.0 + 20.0 * np.sin(t / 15.0)
    rate = 20.0 / 15.0 * np.cos(t / 15.0)
    way = 6.0 * np.exp(1j * np.radians(psi))
    place = np.r_[0.0, np.cumsum((way[1:] + way[:-1]) / 2.0 / hz)]
    latitude = 57.0 + place.real / 111_360.0
    longitude = 11.0 + place.imag / (111_360.0 * np.cos(np.radians(57.0)))
    return {
        "t": t,
        "psi": psi,
        "rate": rate,
        "place": place,
        "latitude": latitude,
        "longitude": longitude,
        "rudder": 5.0 * np.cos(t / 15.0 + 0.5),
        "rpm": np.full(t.size, 84.0),
        "sog": np.full(t.size, 6.0),
    }


@pytest.fixture
def sailed():
    return motion()


@pytest.fixture
def data():
    """The folder of real logs; without it the test is skipped and says so."""
    place = os.environ.get("SHIPTWIN_DATA")
    if not place or not (Path(place) / "logs").is_dir():
        pytest.skip("set SHIPTWIN_DATA to the folder of real logs to run this")
    return Path(place)


def sentence(body):
    total = 0
    for c in body.encode():
        total ^= c
    return f"${body}*{total:02X}"


def ddmm(degrees, digits):
    whole = int(degrees)
    return f"{whole:0{digits}d}{(degrees - whole) * 60:07.4f}"


def nmea_lines(m, i):
    """The sentences of one second."""
    k = int(m["t"][i])
    clock = f"{12 + k // 3600:02d}{k // 60 % 60:02d}{k % 60:02d}.00"
    psi = m["psi"][i]
    return [
        sentence(
            f"GPRMC,{clock},A,{ddmm(m['latitude'][i], 2)},N,{ddmm(m['longitude'][i], 3)},E,{6 / KNOT:.3f},{psi:.2f},251126,,,A"
        ),
        sentence(f"HEHDT,{psi:.2f},T"),
        sentence(f"TIROT,{m['rate'][i] * 60:.2f},A"),
        sentence(f"IIRSA,{m['rudder'][i]:.2f},A,,V"),
        sentence("ERRPM,S,1,84.0,,A"),
        sentence("WIMWV,30.0,R,12.0,N,A"),
        "!AIVDM,1,1,,A,13aI8e?P00PGpU:NR6s00?vT2000,0*1C",
    ]
