"""A ship that goes astern is no ship whose heading is 180 deg off: what it is propelled by tells which end
leads, and where nothing does, nothing is proved.

Astern are here voyages sailed ahead, as they would be recorded with bow and stern in each other's place."""

from pathlib import Path

import numpy as np
import pytest

from bench.small_boats import ship_of
from twin.recording.checks import run_checks
from twin.recording.raw import Raw
from twin.recording.voyage import Voyage

HEADING, RUDDER, SHAFT = "heading_true_north_deg", "rudder_angle_deg", "propeller_rate_rpm"
PLACE = ("north_m", "east_m", HEADING, "yaw_rate_degps")
PORT, STARBOARD = "port.pwm_us", "starboard.pwm_us"


def recorded(time_s, columns):
    """The voyage of these, its velocity a slope of the positions."""
    rows = np.arange(2, time_s.size + 2)
    v = Voyage.of(Raw(Path("b.csv"), rows, time_s, columns, {}), controls=False)
    assert "surge_velocity_mps" in v.meta["derived"]
    return v


def turned(c):
    return c | {HEADING: (c[HEADING] + 180.0) % 360.0}


def reversed_thrusters(c):
    return c | {name: 3000.0 - c[name] for name in (PORT, STARBOARD)}


def boat(seed):
    """A boat that its two thrusters drive ahead, by equations of its own: faster and slower, a little to either
    side, ten samples a second."""
    rng, t = np.random.default_rng(seed), np.arange(0.0, 120.0, 0.1)

    def held(low, high):
        return np.repeat(rng.uniform(low, high, 24), 50)

    power, more = held(0.3, 0.8), held(-0.08, 0.08)
    port, starboard = power + more, power - more
    (x, psi, u, v, r), rows = (0j, 1.0, 0.0, 0.0, 0.0), []
    for left, right in zip(port, starboard, strict=True):
        rows.append((x.real, x.imag, psi, r))
        x += 0.1 * (u + 1j * v) * np.exp(1j * psi)
        psi += 0.1 * r
        du = 1.2 * (left + right) - 0.25 * abs(u) * u - 0.1 * u + v * r
        dv, dr = -0.8 * v - u * r, 3.0 * (left - right) - 2.0 * r
        u, v, r = u + 0.1 * du, v + 0.1 * dv, r + 0.1 * dr
    x, y, psi, r = np.array(rows).T
    noise = rng.standard_normal((4, t.size))
    columns = {
        "north_m": x + 0.01 * noise[0],
        "east_m": y + 0.01 * noise[1],
        HEADING: (np.degrees(psi) + 0.2 * noise[2]) % 360.0,
        "yaw_rate_degps": np.degrees(r) + 0.2 * noise[3],
    }
    return t, columns | {PORT: 1500.0 + 400.0 * port, STARBOARD: 1500.0 + 400.0 * starboard}


def boat_astern(c):
    other_end = reversed_thrusters(turned(c))
    return other_end | {PORT: other_end[STARBOARD], STARBOARD: other_end[PORT]}


def ship(sail, seconds):
    c = {name: x[::5] for name, x in sail().items()}
    first = c["time_s"] < seconds
    return c["time_s"][first], {name: c[name][first] for name in (*PLACE, RUDDER, SHAFT)}


def ship_astern(c):
    return turned(c) | {RUDDER: -c[RUDDER], SHAFT: -c[SHAFT]}


def told(time_s, columns, of=None):
    return {c.name: c for c in run_checks(recorded(time_s, columns), of)}


def proved(found):
    return {name: c.text for name, c in found.items() if c.unusable}


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("with_file", [True, False])
def test_of_a_boat_whose_thrusters_drive_it_astern_nothing_is_proved(seed, with_file):
    """Expected: a look that names both ways, and with the ship file thrust that agrees with it as it is."""
    t, c = boat(seed)
    found = told(t, boat_astern(c), ship_of("thrusters") if with_file else None)
    assert proved(found) == {}
    assert "so it does if the ship goes astern" in found["velocity_frame"].text
    assert found["actuators"].ok and found["actuators"].informative == with_file


@pytest.mark.parametrize("seconds", [100.0, 900.0])
def test_of_a_ship_whose_propeller_turns_astern_nothing_is_proved(sail, seconds):
    """Test: too short for its shaft or its rudder to tell, and long enough."""
    t, c = ship(sail, seconds)
    found = told(t, ship_astern(c))
    assert proved(found) == {} and not found["velocity_frame"].ok


@pytest.mark.parametrize("seed", range(4))
def test_of_a_boat_that_goes_ahead_a_heading_180_deg_off_is_proved_by_its_thrusters(seed):
    t, c = boat(seed)
    found = told(t, turned(c), ship_of("thrusters"))
    assert list(proved(found)) == ["velocity_frame"]
    assert "if the heading is 180 deg off all of it agrees" in found["velocity_frame"].text
    assert proved(told(t, c, ship_of("thrusters"))) == {}


@pytest.mark.parametrize("without", [(), (SHAFT,), (RUDDER,)])
def test_of_a_ship_that_goes_ahead_a_heading_180_deg_off_is_proved_by_rudder_or_shaft(sail, without):
    t, c = ship(sail, 900.0)
    left = {name: x for name, x in turned(c).items() if name not in without}
    assert list(proved(told(t, left))) == ["velocity_frame"]
    assert proved(told(t, {name: x for name, x in c.items() if name not in without})) == {}


def test_a_heading_180_deg_off_beside_neither_rudder_nor_shaft_is_a_look(sail):
    t, c = ship(sail, 900.0)
    found = told(t, {name: x for name, x in turned(c).items() if name not in (RUDDER, SHAFT)})
    assert proved(found) == {} and "if the ship goes astern" in found["velocity_frame"].text


@pytest.mark.parametrize("seed", range(4))
def test_reversed_thrusters_of_a_boat_that_goes_ahead_are_proved(seed):
    t, c = boat(seed)
    found = proved(told(t, reversed_thrusters(c), ship_of("thrusters")))
    assert list(found) == ["actuators"] and "all actuators are reversed" in found["actuators"]


def test_of_a_boat_that_is_set_aside_as_it_goes_astern_nothing_is_proved():
    """Test: a drift angle of 43 deg, as wind and waves may give a small boat, and velocities by the earth, on
    the one heading on which a compass that counts anticlockwise from south would show no drift."""
    t, drift = np.arange(0.0, 100.0), 43.0
    psi = np.radians(-drift / 2.0 + np.sin(t / 5.0))
    way = np.full(t.size, 2.0) * np.exp(1j * np.radians(180.0 + drift / 2.0))
    place, own = np.cumsum(way), way * np.exp(-1j * psi)
    columns = {
        "north_m": place.real,
        "east_m": place.imag,
        HEADING: np.degrees(psi) % 360.0,
        "surge_velocity_mps": own.real,
        "sway_velocity_mps": own.imag,
    }
    raw = Raw(Path("b.csv"), np.arange(2, t.size + 2), t, columns, {})
    found = {c.name: c for c in run_checks(Voyage.of(raw, controls=False).with_meta(velocity_frame="earth"))}
    assert proved(found) == {} and "if the ship goes astern" in found["velocity_frame"].text
