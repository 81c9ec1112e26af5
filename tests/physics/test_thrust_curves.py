"""The curve of one actuator's thrust: at rest, at speed, astern, against the water and overrun by it."""

import math

import pytest

from tests.physics.test_actuators import PORT, ship_with
from twin.physics.maths import positive
from twin.physics.ship import text, to_table


def screw(**numbers):
    """A thruster of which turns are recorded: 0.2 m across."""
    table = {"name": "port", "kind": "fixed_thruster", "channels": ["rate_rev_s"], "diameter_m": 0.2}
    ship = ship_with(table | {"K_T0": 0.4, "K_T1": -0.4} | numbers)
    a = ship.actuator("port")
    return lambda n, u: a.force({"port.rate": n}, u, 0.0, 0.0, ship)[0] / (ship.rho * a.D**4)


def test_astern_a_propeller_gives_its_own_share_of_what_it_gives_ahead_by_hand():
    thrust = screw(reverse=0.7)
    assert thrust(10.0, 0.0) == pytest.approx(0.4 * 100.0)
    assert thrust(-10.0, 0.0) == pytest.approx(-0.7 * 0.4 * 100.0)
    assert thrust(10.0, 1.0) == pytest.approx(100.0 * (0.4 - 0.4 * 0.5))  # J = 1/(10 0.2) = 0.5


def test_where_the_water_runs_against_it_a_propeller_stalls_by_hand():
    thrust, steady = screw(stall=4.0), screw()
    # J = 0.5 against it: 1/(1 + 4 0.5^2) = half of 0.4 + 0.4 0.5 is left, in both of these quadrants
    assert thrust(-10.0, 1.0) == pytest.approx(-0.5 * 60.0) and steady(-10.0, 1.0) == pytest.approx(-60.0)
    assert thrust(10.0, -1.0) == pytest.approx(0.5 * 60.0)
    for n, u in ((10.0, 1.0), (-10.0, -1.0), (10.0, 0.0)):
        assert thrust(n, u) == pytest.approx(steady(n, u), rel=1e-6)


def test_a_commanded_thruster_stalls_and_pushes_less_astern_by_hand():
    table = PORT | {"reverse": 0.8, "stall": 4.0, "slow": 0.5, "y_m": 0.0}
    ship = ship_with(table)
    a, U = ship.actuator("port"), ship.U_0
    # half astern: a quarter of 0.8 25 N at rest; at a quarter of U_0 ahead J^2 = 0.25^2/0.5^2
    at_rest, moving = (a.force({"port.command": -0.5}, u, 0.0, 0.0, ship)[0] for u in (0.0, 0.25 * U))
    assert at_rest == pytest.approx(-0.8 * 25.0 * 0.25, abs=1e-3)
    assert moving == pytest.approx(-0.8 * 25.0 * (0.25 + 0.5 * 0.5 * 0.25) / (1.0 + 4.0 * 0.25), abs=1e-3)


def test_a_thruster_as_ship_files_had_it_gives_the_same_to_the_last_digit():
    """`reverse`, `stall`, `sag` and `drag` at their nulls, in all four quadrants, as the sum was written before them."""
    ship = ship_with(PORT | {"slow": 0.4, "linear": 0.3, "y_m": 0.0})
    a = ship.actuator("port")
    for c in (0.6, -0.6, 0.0):
        for u in (1.3, -1.3, 0.0):
            ahead, astern = (positive(x, 1e-8) for x in (c, -c))
            curve = [(0.3 + (1.0 - 0.3) * e) * e for e in (ahead, astern)]
            before = 50.0 * curve[0] - 25.0 * curve[1] - 0.4 * (50.0 * ahead + 25.0 * astern) * u / ship.U_0
            assert a.force({"port.command": c}, u, 0.0, 0.0, ship)[0] == before
    assert "stall" not in text(to_table(ship)) and "reverse" not in text(to_table(ship))


def test_thrust_over_speed_sags_below_its_line_by_hand():
    thrust = screw(sag=0.5)
    # J_0 = 0.4/0.4 = 1; at J = u/(n D) = 0.5 half of the line's half less 0.5 0.5 of it, 0.75
    assert thrust(10.0, 1.0) == pytest.approx(100.0 * 0.4 * 0.5 * 0.75, rel=1e-4)
    assert thrust(-10.0, -1.0) == pytest.approx(-100.0 * 0.4 * 0.5 * 0.75, rel=1e-4)
    # KVLCC2's parabola [Yasukawa & Yoshimura 2015]: K_T = 0.2931 - 0.2753 J - 0.1385 J^2, none at J_0 = 0.769
    J_0 = (-0.2753 + (0.2753**2 + 4.0 * 0.1385 * 0.2931) ** 0.5) / (2.0 * 0.1385)
    kvlcc2 = screw(K_T0=0.2931, K_T1=-0.2931 / J_0, sag=-0.1385 * J_0**2 / 0.2931)
    for J in (0.1, 0.3, 0.6):
        assert kvlcc2(10.0, 2.0 * J) == pytest.approx(100.0 * (0.2931 - 0.2753 * J - 0.1385 * J**2), rel=1e-3)
    steady = screw()
    for n, u in ((10.0, 0.0), (10.0, -1.0), (-10.0, 1.0)):  # at rest, and where the water runs against it
        assert thrust(n, u) == pytest.approx(steady(n, u), rel=1e-4)


def test_a_screw_that_the_water_overruns_holds_against_the_motion_by_hand():
    thrust, steady = screw(drag=0.2), screw()
    # over rho D^4: 0.2 of the square of what the water is faster than J_0 n D = 1 n 0.2, over D^2 = 0.04
    assert thrust(0.0, 3.0) == pytest.approx(-0.2 * 9.0 / 0.04, rel=1e-3)
    assert thrust(0.0, -3.0) == pytest.approx(0.2 * 9.0 / 0.04, rel=1e-3)
    assert thrust(5.0, 3.0) - steady(5.0, 3.0) == pytest.approx(-0.2 * 4.0 / 0.04, rel=1e-3)
    assert thrust(20.0, 3.0) == pytest.approx(steady(20.0, 3.0), rel=1e-3)


def test_a_commanded_thruster_sags_and_drags_by_hand():
    ship = ship_with(PORT | {"slow": 0.5, "sag": 0.6, "drag": 0.3, "y_m": 0.0})
    a, U = ship.actuator("port"), ship.U_0
    still, half, full = (a.force({"port.command": c}, U, 0.0, 0.0, ship)[0] for c in (0.0, 0.5, 1.0))
    # full at U_0: j = 0.5; half ahead: 0.5 0.5 is just what 0.5^2 gives; stopped: 0.3 of the 50 N ahead
    assert full == pytest.approx(50.0 * 0.5 * (1.0 - 0.6 * 0.5), rel=1e-3)
    assert half == pytest.approx(0.0, abs=0.02)
    assert still == pytest.approx(-0.3 * 50.0, rel=1e-3)


def test_a_stalling_thruster_has_a_finite_slope_everywhere():
    torch = pytest.importorskip("torch")
    bent = {"reverse": 0.8, "stall": 4.0, "sag": 0.5, "drag": 0.3}
    tables = (
        PORT | bent,
        PORT | {"channels": ["rate_rpm"], "diameter_m": 0.2} | bent,
    )
    for table in tables:
        ship = ship_with(table)
        a = ship.actuator("port")
        for push in (0.0, 0.5, -0.5):
            for u in (0.0, 1.0, -1.0):
                x = torch.tensor([push, u], dtype=torch.float64, requires_grad=True)
                a.force({f"port.{a.attributes[0]}": x[0]}, x[1], 0.0, 0.0, ship)[0].backward()
                assert bool(torch.isfinite(x.grad).all()), (table["channels"], push, u)


def test_the_leg_of_an_azimuth_or_an_outboard_is_a_fin_that_turns_with_it_by_hand():
    turned = {"channels": ["thrust_n", "angle_deg"], "x_m": -0.4, "y_m": 0.0, "diameter_m": 0.2, "strut": 1.5}
    for kind, aside in (("azimuth", 1.0), ("outboard", -1.0)):
        ship = ship_with(PORT | turned | {"kind": kind})
        a = ship.actuator("port")
        X, Y, N = a.force({"port.thrust": 0.0, "port.angle": 0.5}, 2.0, 0.0, 0.0, ship)
        # water at 2 m/s from ahead: 2 sin(0.5) across, and the force on 1.5 0.2^2 m2 across the leg
        F = 0.5 * ship.rho * 1.5 * 0.04 * 2.0 * math.sin(0.5) * 2.0
        assert pytest.approx(-F * math.sin(0.5), rel=1e-6) == X
        assert aside * Y == pytest.approx(F * math.cos(0.5), rel=1e-6)
        assert pytest.approx(-0.4 * Y) == N
        assert "strut" in a.estimated()
    # of a command T_ahead/(rho U_0^2) stands for D^2; what has no leg has no fin
    plain = {k: v for k, v in turned.items() if k != "diameter_m"} | {"channels": ["command", "angle_deg"]}
    ship = ship_with(PORT | plain | {"kind": "azimuth"})
    a = ship.actuator("port")
    _, Y, _ = a.force({"port.command": 0.0, "port.angle": 0.0}, 0.0, 1.0, 0.0, ship)
    assert pytest.approx(-0.5 * 1.5 * 50.0 / ship.U_0**2, rel=1e-4) == Y
    jet = ship_with(PORT | plain | {"kind": "waterjet"}).actuator("port")
    assert "strut" not in jet.estimated() and "strut" not in ship_with(PORT).actuator("port").estimated()
