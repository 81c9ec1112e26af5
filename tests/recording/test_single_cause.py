"""One mistake is told once, by its own check, with what to write in the map; and what is no mistake is not
proved one."""

from pathlib import Path

import numpy as np
import pytest

from twin.recording.checks import run_checks
from twin.recording.map_file import parse_map
from twin.recording.raw import Raw, through
from twin.recording.table import Table
from twin.recording.timebase import TimeAxis
from twin.recording.voyage import Voyage

KNOT = 1852.0 / 3600.0
H, R, D, N = "heading_true_north_deg", "yaw_rate_degps", "rudder_angle_deg", "propeller_rate_rpm"
COURSE = {
    "surge_velocity_mps": {"column": "sog", "unit": "kn", "frame": "course"},
    "sway_velocity_mps": {"column": "cog", "frame": "course"},
}
BRIDGE = {
    "north_m": "n",
    "east_m": "e",
    H: "hdg",
    R: {"column": "rot", "unit": "deg/min"},
    D: "rud",
    N: "rpm",
    **COURSE,
}


def bridge(sail, north=0.0):
    """What a bridge writes once a second of the kinematic ship; `north`: the course that is made north."""
    c = {name: x[::10] for name, x in sail().items()}
    psi = np.radians(c[H] - north)
    way = (c["surge_velocity_mps"] + 1j * c["sway_velocity_mps"]) * np.exp(1j * psi)
    place = np.r_[0.0, np.cumsum((way[1:] + way[:-1]) / 2.0)]
    return {
        "t": c["time_s"],
        "n": place.real,
        "e": place.imag,
        "hdg": np.round((c[H] - north) % 360, 2),
        "rot": c[R] * 60,
        "rud": c[D],
        "rpm": c[N],
        "sog": np.round(np.abs(way) / KNOT, 2),
        "cog": np.round(np.degrees(np.angle(way)) % 360, 2),
    }


def voyage(d, entries=BRIDGE):
    names = {c if isinstance(c, str) else c["column"] for c in entries.values()}
    table = Table(Path("b.csv"), np.arange(2, d["t"].size + 2), {n: np.array(d[n], float) for n in names}, {})
    return Voyage.of(
        through(
            table.path, table, TimeAxis(np.array(d["t"], float)), parse_map({"columns": entries}, "b"), [], {}
        )
    )


def told(d, entries=BRIDGE):
    return {c.name: c for c in run_checks(voyage(d, entries)) if not c.ok}


def in_turn(d):
    return np.where(np.isin(np.arange(d["hdg"].size) % 7, (1, 2, 5)), d["hdg"] - 12, d["hdg"])


def averaged(d):
    k = np.arange(d["hdg"].size) // 5
    return (np.bincount(k, d["hdg"]) / np.bincount(k))[k]


MISTAKES = {
    "180 deg off": (
        lambda d: d | {"hdg": d["hdg"] + 180},
        "velocity_frame",
        "offset = 180 for heading_true_north_deg",
    ),
    "as ROS has them": (
        lambda d: d | {"hdg": 90 - d["hdg"], "rot": -d["rot"]},
        "velocity_frame",
        "sign = -1 and offset = 90 for heading_true_north_deg; sign = -1 for yaw_rate_degps",
    ),
    "in m/s, read as knots": (
        lambda d: d | {"sog": d["sog"] * KNOT},
        "velocity_frame",
        'unit = "m/s" for surge_velocity_mps (speed_over_ground_mps where the map has that)',
    ),
    "east is positive to the west": (lambda d: d | {"e": -d["e"]}, "velocity_frame", "sign = -1 for east_m"),
    "in deg/s": (lambda d: d | {"rot": d["rot"] / 60}, "yaw_rate", 'unit = "deg/s" for yaw_rate_degps'),
    "the rudder is positive to port": (
        lambda d: d | {"rud": -d["rud"]},
        "rudder_sign",
        "sign = -1 for rudder_angle_deg",
    ),
    "two headings in turn, 12.0 deg apart": (lambda d: d | {"hdg": in_turn(d)}, "heading_steps", "--source"),
    "the heading is the course over ground": (lambda d: d | {"hdg": d["cog"]}, "copies", "Give the compass"),
    "jumps by +90": (
        lambda d: d | {"hdg": d["hdg"] + np.where(d["t"] > 450, 90, 0)},
        "heading_steps",
        "at 451 s",
    ),
    "an hour": (lambda d: d | {"t": d["t"] + np.where(d["t"] > 450, 3600, 0)}, "clock_steps", "at 450 s"),
}


def test_a_healthy_bridge_log_is_quiet(sail):
    assert told(bridge(sail)) == {}


@pytest.mark.parametrize("words", MISTAKES)
def test_a_mistake_is_proved_once_and_by_its_own_check(sail, words):
    plant, check, remedy = MISTAKES[words]
    found = told(plant(bridge(sail)))
    assert [name for name, c in found.items() if c.unusable] == [check], {n: c.text for n, c in found.items()}
    assert words in found[check].text and remedy in found[check].text


def test_means_across_north_are_seen_and_no_rudder_is_blamed(sail):
    d = bridge(sail, north=355.0)
    found = told(d | {"hdg": averaged(d)})
    assert [name for name, c in found.items() if c.unusable] == ["heading_steps"]
    assert "across north" in found["heading_steps"].text


def test_a_late_compass_is_told_with_its_seconds_and_the_map_takes_it_back(sail):
    d = bridge(sail)
    late = d | {"hdg": np.r_[np.full(3, d["hdg"][0]), d["hdg"][:-3]]}
    found = told(late)["compass"]
    assert not found.unusable and "the heading is 3.0 s late" in found.text and "late_s = 3.0" in found.text
    assert told(late, BRIDGE | {H: {"column": "hdg", "late_s": 3.0}}) == {}


def test_a_magnetic_heading_is_told_and_not_refused(sail):
    d = bridge(sail)
    found = told(d | {"hdg": d["hdg"] - 14.0})
    assert (
        set(found) == {"compass"}
        and not found["compass"].unusable
        and "off the course over ground" in found["compass"].text
    )


def test_a_stopped_shaft_proves_no_unit(sail):
    """Test: the ship runs out with its shaft stopped (a quarter of a turn a minute of noise). Expected: the
    unit of the turns cannot be told."""
    d = bridge(sail)
    rng = np.random.default_rng(1)
    assert "propeller_rate" not in told(d | {"rpm": 0.25 * rng.standard_normal(d["t"].size)})


def test_a_ship_at_her_berth_proves_no_rudder(sail):
    rng = np.random.default_rng(2)
    n = 900
    t, d = np.arange(float(n)), np.repeat(rng.uniform(-20, 20, n // 30), 30)
    swing = 0.05 * np.cumsum(rng.standard_normal(n)) - 0.01 * np.cumsum(d - d.mean()) / 20.0
    columns = {
        "north_m": 0.3 * rng.standard_normal(n),
        "east_m": 0.3 * rng.standard_normal(n),
        H: 45 + swing,
        D: d,
        N: np.zeros(n),
        "surge_velocity_mps": 0.02 * rng.standard_normal(n),
        "sway_velocity_mps": 0.02 * rng.standard_normal(n),
        R: np.gradient(swing),
    }
    v = Voyage.of(Raw(Path("b.csv"), np.arange(2, n + 2), t, columns, {}))
    assert not [c.text for c in run_checks(v) if c.unusable]


def test_a_light_wind_that_veers_while_she_circles_is_not_counted_from_the_bow():
    t = np.arange(0.0, 900.0)
    psi = 0.4 * t
    way = 2.0 * np.exp(1j * np.radians(psi))
    place = np.cumsum(way)
    rng = np.random.default_rng(3)
    columns = {
        "north_m": place.real,
        "east_m": place.imag,
        H: psi % 360,
        D: 20 + rng.standard_normal(900),
        N: 100 + rng.standard_normal(900),
        "surge_velocity_mps": 0 * t + 2,
        "sway_velocity_mps": 0.02 * rng.standard_normal(900),
        R: 0.4 + 0.02 * rng.standard_normal(900),
        "true_wind_direction_deg": (300 - 0.4 * t + 5 * rng.standard_normal(900)) % 360,
    }
    # light, and stronger: one circle after the other cannot tell a veering wind from one off the bow
    for speed in (1.0, 6.0):
        v = Voyage.of(
            Raw(
                Path("b.csv"),
                np.arange(2, 902),
                t,
                columns | {"true_wind_speed_mps": speed + 0.1 * rng.standard_normal(900)},
                {},
            )
        )
        assert not [c.text for c in run_checks(v) if c.unusable]


def test_a_constant_of_the_map_is_no_instrument_that_repeats_its_stamps(sail):
    d = bridge(sail)
    rows = {"t": np.repeat(d["t"], 2), **{n: np.repeat(x, 2) for n, x in d.items() if n != "t"}}
    even = np.arange(rows["t"].size) % 2 == 0
    for name in ("hdg", "rot", "rud"):
        rows[name] = np.where(even, rows[name], np.nan)
    for name in ("n", "e", "sog", "cog"):
        rows[name] = np.where(even, np.nan, rows[name])
    entries = {k: v for k, v in BRIDGE.items() if k != N}
    table = Table(
        Path("b.csv"),
        np.arange(2, rows["t"].size + 2),
        {n: rows[n] for n in ("n", "e", "hdg", "rot", "rud", "sog", "cog")},
        {},
    )
    by = parse_map({"columns": entries, "constant": {N: 77}}, "b")
    v = Voyage.of(through(table.path, table, TimeAxis(rows["t"]), by, [], {}))
    assert {c.name: c for c in run_checks(v)}["time_stamps"].ok
