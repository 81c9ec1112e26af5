"""One number for each effect, worked by hand from its source, with every component different from zero."""

from math import radians, sqrt

import pytest

from twin.physics import core
from twin.physics.effects import find
from twin.physics.effects.hull_asymmetry import HullAsymmetry
from twin.physics.effects.hull_damping import HullDamping
from twin.physics.effects.rudder_play import RudderPlay
from twin.physics.effects.swaying_mass import SwayingMass
from twin.physics.model import Model
from twin.physics.state import Situation


def force(name, ship, s, **values):
    return tuple(find(name)(**values).force(s, ship))


def test_wind_on_the_starboard_quarter_by_hand(ship):
    # 10 m/s to east, heading 30 deg: air past the ship 3 - 10 cos 60 = -2, 1 - 10 sin 60 = -7.660254; |.| =
    # 7.917040
    s = Situation(psi=radians(30), u=3.0, v=1.0, wind_speed=10.0, wind_to=radians(90))
    X, Y, N = force("Wind", ship, s, c_x=0.7, c_y=0.9, c_n=0.1, c_m=0.01)
    assert pytest.approx(0.5 * 1.225 * 200 * 0.7 * 7.917040 * 2.0, rel=1e-6) == X  # 1357.8 N ahead
    # 33 431 N to starboard
    assert pytest.approx(0.5 * 1.225 * 1000 * 0.9 * 7.917040 * 7.660254, rel=1e-6) == Y
    assert (
        pytest.approx(0.5 * 1.225 * 1000 * 100 * (2 * 0.1 * -2.0 + 0.01 * 7.917040) * 7.660254, rel=1e-6) == N
    )
    assert X > 0 and Y > 0


def test_waves_on_the_starboard_bow_by_hand(ship):
    # waves from 45 deg to starboard of the bow: chi = 225 deg; k = (2 pi/8)^2/9.80665 = 0.0628994, 1 - exp(-2
    # k 5) = 0.466875
    s = Situation(psi=0.0, H_s=2.0, T_p=8.0, wave_to=radians(225))
    X, Y, N = force("WaveDrift", ship, s, c_x=1.0, c_y=0.8, c_n=0.05)
    q = 1000 * 9.80665 * 4.0 / 16 * 0.466875  # 1144.6 N/m
    assert pytest.approx(-q * 20 * sqrt(0.2) * sqrt(0.5), rel=3e-5) == X  # slows it
    assert pytest.approx(-q * 100 * 0.8 * 0.5, rel=3e-5) == Y  # pushes it to port
    assert pytest.approx(q * 100**2 * 0.05 * 1.0, rel=3e-5) == N


def test_cross_flow_on_a_ship_that_drifts_and_turns_by_hand(ship):
    # v = 1, r = 0.01: strips at -45, -35 ... 45 m see 0.55, 0.65 ... 1.45 m/s; squares sum to 10.825, times x
    # to 1650
    Y, N = force("CrossFlowDrag", ship, Situation(v_r=1.0, r=0.01), c_d=0.4)[1:]
    assert pytest.approx(-0.5 * 1000 * 5 * 10 * 0.4 * 10.825) == Y
    assert pytest.approx(-0.5 * 1000 * 5 * 10 * 0.4 * 165.0) == N


def test_cross_flow_that_the_stern_holds_harder_by_hand(ship):
    # as above; twice 0.1 x/L more or less of it: squares times x/L sum to 1.65, times (x/L)^2 to 0.9459 (and
    # once more x 100 m in the moment)
    Y, N = force("CrossFlowDrag", ship, Situation(v_r=1.0, r=0.01), c_d=0.0, c_aft=0.1)[1:]
    assert pytest.approx(0.5 * 1000 * 5 * 10 * 0.2 * 1.65) == Y
    assert pytest.approx(0.5 * 1000 * 5 * 10 * 0.2 * 0.945863 * 100.0) == N


def test_cross_flow_that_holds_harder_amidships_by_hand(ship):
    # as above: squares times 1 - 12 (x/L)^2 sum to 10.825 - 12 x 0.9458625 = -0.52535; times x/L besides to
    # 1.65 - 12 x 0.241725 = -1.2507
    Y, N = force("CrossFlowDrag", ship, Situation(v_r=1.0, r=0.01), c_d=0.0, c_mid=0.1)[1:]
    assert pytest.approx(0.5 * 1000 * 5 * 10 * 0.1 * 0.52535) == Y
    assert pytest.approx(0.5 * 1000 * 5 * 10 * 0.1 * 1.2507 * 100.0) == N


def test_fouling_by_hand(ship):
    # X_uu = -0.02 x 1/2 1000 100 5 = -5000, X_u = -0.0005 x 250 000 x sqrt(9.80665 x 100) = -3914.45; at 4
    # m/s
    assert force("HullFouling", ship, Situation(u_r=4.0), extra=0.3)[0] == pytest.approx(
        -0.3 * (3914.45 + 5000 * 4) * 4, rel=1e-6
    )
    waves = ship.with_derivatives(X_uuu=-0.03)  # -0.03 x 250 000/sqrt(980.665) = -239.496
    assert force("HullFouling", waves, Situation(u_r=4.0), extra=0.3)[0] == pytest.approx(
        -0.3 * (3914.45 + 5000 * 4 + 239.496 * 16) * 4, rel=1e-6
    )


def test_more_of_the_flow_from_one_side_turns_her_alike_whichever_way_she_drifts(ship):
    # as below: q = 29.3718, sqrt(q) = 5.41958; w = 0.4 x -0.4 - 0.3 x 100 x 0.01 = -0.46, corner 0.02 x
    # 5.41958 = 0.108392 even(w) = sqrt(0.2116 + 0.0117488) - 0.108392 = 0.364206; more across: 5.41958 x
    # -0.25 x 0.364206 = -0.493464 amidships F = -12 500 x 0.493464 = -6168.3 N more, whatever the sign of w:
    # Y = 1.2 x 6168.3, N = -58 x 6168.3
    uneven = ship.with_derivatives(gamma_a=-0.25)
    for v, r in ((-0.4, 0.01), (0.4, -0.01)):
        s = Situation(u_r=4.0, v_r=v, r=r, n=2.0)
        more = [a - b for a, b in zip(rudder_force(uneven, s), rudder_force(ship, s), strict=True)]
        assert more == pytest.approx([0.0, 7401.96, -357761.0], rel=1e-4)


def rudder_force(ship, s):
    thrust = core.thrust(s.u_r, s.n, ship.c)
    return core.rudder(s.u_r, s.v_r, s.r, s.delta, thrust, ship.c)


def test_rudder_and_what_wear_and_offset_do_to_it_by_hand(ship):
    # u_a = 0.75 x 4 = 3; T = 1000 x 4^4 x 0.4 x 2^2 - 1000 x 4^3 x 0.4 x 2 x 3 = 409 600 - 153 600 = 256 000
    # N q = 9 + 0.5 x 8 x 256 000/(pi 1000 16) = 9 + 20.3718 = 29.3718; across = sqrt(q) (0.4 x -0.4 - 0.3 x
    # 100 x 0.01) = -2.49300 F = 1/2 1000 10 2.5 (q sin 20 deg - 2.49300 cos 20 deg) = 12 500 (10.04575 -
    # 2.34266) = 96 288.6 N
    s = Situation(u_r=4.0, v_r=-0.4, r=0.01, n=2.0, delta=radians(20))
    F = 96288.6
    rudder = (-0.7 * F * 0.342020, -1.2 * F * 0.939693, -(-0.5 + 0.2 * -0.4) * 100 * F * 0.939693)
    worn = force("RudderWear", ship, s, loss=0.25)
    assert worn == pytest.approx([-0.25 * f for f in rudder], rel=1e-4)
    # 1 deg more: F = 12 500 (29.3718 sin 21 deg - 2.49300 cos 21 deg) = 12 500 (10.52590 - 2.32742) = 102
    # 481.0 N
    G = 102481.0
    offset = force("RudderOffset", ship, s, offset=radians(1))
    assert offset[0] == pytest.approx(-0.7 * (G * 0.358368 - F * 0.342020), rel=2e-3)
    assert offset[1] == pytest.approx(-1.2 * (G * 0.933580 - F * 0.939693), rel=2e-3)
    assert offset[2] == pytest.approx(58.0 * (G * 0.933580 - F * 0.939693), rel=2e-3)
    assert offset[1] < 0 < offset[2]  # to starboard: stern to port, bow to starboard


def test_a_worn_propeller_by_hand(ship):
    # thrust 256 000 N as above, less 10 %: -0.8 x 25 600 N of drive; q = 9 + 18.33462 = 27.33462, sqrt
    # 5.228252
    s = Situation(u_r=4.0, v_r=-0.4, r=0.01, n=2.0, delta=radians(20))
    X, Y, N = force("PropellerWear", ship, s, loss=0.1)
    F, G = 96288.6, 12500 * (27.33462 * 0.342020 - 5.228252 * 0.46 * 0.939693)
    assert pytest.approx(-0.8 * 25600 - 0.7 * 0.342020 * (G - F), rel=1e-4) == X
    assert pytest.approx(-1.2 * 0.939693 * (G - F), rel=1e-3) == Y
    assert pytest.approx(58.0 * 0.939693 * (G - F), rel=1e-3) == N


def test_deeper_and_heavier_by_hand(ship):
    loaded = find("Loading")(mass=0.1, draught=0.2, x_G=2.0).alter(ship)
    assert (loaded.m, loaded.T, loaded.x_G) == (pytest.approx(7.7e6), pytest.approx(6.0), pytest.approx(1.0))
    assert loaded.I_z == pytest.approx(1.1 * 4.4e9 + 7.7e6 * (1.0**2 - 1.0**2))
    # a slender body's added mass goes with T^2
    assert loaded.c.N_vdot == pytest.approx(1.2**2 * ship.c.N_vdot)
    # with a B/T = 0.16 x 0.7 x 4 = 0.448 beside it
    assert loaded.c.Y_vdot == pytest.approx(1.2 * (1.2 + 0.448) / 1.448 * ship.c.Y_vdot)
    assert loaded.c.X_udot == pytest.approx(1.1 * ship.c.X_udot)
    assert loaded.c.Y_vv == pytest.approx(1.2 * ship.c.Y_vv)
    assert loaded.c.X_uu == pytest.approx((1.7 * 6 + 0.7 * 20) / (1.7 * 5 + 0.7 * 20) * ship.c.X_uu)
    assert (pytest.approx(200 - 20 * 1.0), pytest.approx(1000 - 100 * 1.0)) == (loaded.A_F, loaded.A_L)
    # C_wp = 0.8, C_IL = 0.224 - 0.324 + 0.146 = 0.046: 2 m ahead trim it by -2 x 0.7/(0.046 x 100) =
    # -0.304348 draughts, by the head
    assert loaded.c.Y_uv == pytest.approx(
        (lift := 1.2 * (1.2 + 1.12) / 2.12) * (1 - 0.67 * 0.304348) * ship.c.Y_uv, rel=1e-5
    )
    assert loaded.c.N_uv == pytest.approx(
        1.44 * ship.c.N_uv + lift * 0.27 * 0.304348 * 100 * ship.c.Y_uv, rel=1e-5
    )
    turn = 1.2 * (1.2 + 0.64) / 1.64
    assert loaded.c.Y_ur == pytest.approx(turn * (1 - 0.8 * 0.304348) * ship.c.Y_ur, rel=1e-5)
    assert loaded.c.N_ur == pytest.approx(turn * (1 - 0.3 * 0.304348) * ship.c.N_ur, rel=1e-5)
    assert loaded.c.N_uv < 1.44 * ship.c.N_uv  # and it turns across more


def test_a_bank_to_starboard_by_hand(ship):
    # eta = 20/(20 + 2 x 30) = 0.25 and 20/(20 + 2 x 90) = 0.1; half steep 0.25 (1 - 0.125) - 0.1 (1 - 0.35) =
    # 0.15375; 1/2 1000 100 5 x 4^2 = 4 MN
    Y, N = force(
        "Bank",
        ship,
        Situation(u_r=4.0, bank_port=90.0, bank_starboard=30.0),
        suction=0.03,
        bow_out=0.008,
        steep=0.5,
    )[1:]
    assert (pytest.approx(4e6 * 0.03 * 0.15375), pytest.approx(-4e8 * 0.008 * 0.15375)) == (Y, N)


def test_tow_and_shore_line_by_hand(ship):
    assert force("TowForce", ship, Situation(), ahead=-1e4, starboard=2e3, turning=3e5) == (-1e4, 2e3, 3e5)
    # heading 30 deg; 1000 N to north and 500 N to east; lever 10 m ahead: moments 10 000 and 5000 N m
    X, Y, N = force(
        "ExternalForce", ship, Situation(psi=radians(30)), north=1e3, east=5e2, turn_north=1e4, turn_east=5e3
    )
    assert (
        pytest.approx(1000 * 0.866025 + 250, rel=1e-6),
        pytest.approx(-500 + 500 * 0.866025, rel=1e-5),
    ) == (X, Y)
    assert pytest.approx(10.0 * Y) == N


def test_propeller_walk_by_hand(ship):
    X, Y, N = force("PropellerWalk", ship, Situation(n=-2.0), c_y=0.01, c_n=-0.005)  # going astern
    assert (0.0, pytest.approx(-1000 * 256 * 4 * 0.01), pytest.approx(1000 * 256 * 4 * 100 * 0.005)) == (
        X,
        Y,
        N,
    )


def test_heel_by_hand(ship):
    s = Situation(u_r=4.0, v_r=-3.0, r=0.02, phi=0.1)  # U^2 = 25, (L r)^2 = 4; 1/2 1000 100 5 x 0.1 = 25 000
    Y, N = force("RollCoupling", ship, s, c_y=0.02, c_n=-0.01, c_yr=0.2, c_nr=-0.1)[1:]
    assert (pytest.approx(25e3 * (0.5 + 0.8)), pytest.approx(-25e5 * (0.25 + 0.4))) == (Y, N)


def test_current_and_tide_by_hand(ship):
    s = Situation(psi=radians(30), t=900.0)
    water = find("Current")(north=1.0, east=0.5).water(s, ship)
    assert (water.u, water.v) == (pytest.approx(0.866025 + 0.25), pytest.approx(-0.5 + 0.433013, rel=1e-5))
    tide = (
        find("VaryingCurrent")
        .absent(ship)
        .but(north=0.1, north_c1=0.2, north_s1=0.3, east_c2=0.4, east_s3=0.5)
    )
    # a quarter of an hour's wave
    assert tide.toward(900.0) == (pytest.approx(0.1 + 0.3), pytest.approx(-0.4 - 0.5))
    again = tide.water(s, ship)
    assert again.u == pytest.approx(0.4 * 0.866025 - 0.9 * 0.5, rel=1e-5)


def test_shallow_water_by_hand(ship):
    # T/h = 5/7.5 = 2/3: g = (4/9)/(1/3) = 4/3
    water = find("ShallowWater")(surge=0.09, sway=0.75, yaw=0.3, heavier=0.6, slower=0.3, thrust=0.45).water(
        Situation(depth=7.5), ship
    )
    assert water == (0.0, 0.0, *(pytest.approx(k) for k in (0.12, 1.0, 0.4, 0.8, 0.4, 0.2)))
    aground = find("ShallowWater")(surge=0.09, sway=0.75, yaw=0.3, heavier=0.6).water(
        Situation(depth=1.0), ship
    )
    assert aground.k_v == pytest.approx(0.75 * (1 / 1.05) ** 2 / (1 - 1 / 1.05))


def test_a_bottom_takes_thrust_from_the_ship_and_none_from_her_rudder(ship):
    model = Model(ship, (find("ShallowWater")(thrust=0.45),))
    deep, shallow = (model.known(Situation(u=5.0, n=1.5, delta=0.2, depth=h)) for h in (1e4, 7.5))
    assert pytest.approx(0.8 * deep["propeller"].X, rel=1e-4) == shallow["propeller"].X
    assert shallow["rudder"] == deep["rudder"]


def test_heavier_water_slows_every_answer_by_the_mass_it_adds(ship):
    c = ship.c
    light, heavy = (core.accelerations(1e4, 2e4, 3e5, c, grown) for grown in ((0.0, 0.0), (0.8, 0.4)))
    m_v, m_r = c.m_v + 0.8 * -c.Y_vdot, c.m_r + 0.4 * -c.N_rdot
    assert m_v * heavy[1] + c.m_vr * heavy[2] == pytest.approx(2e4) and c.m_rv * heavy[1] + m_r * heavy[
        2
    ] == pytest.approx(3e5)
    assert heavy[0] == light[0]


def test_steering_gear_by_hand():
    gear = find("SteeringLag")(delay=1.5, travel_time=26.0)  # 2.5 deg/s
    assert gear.dead_time() == 1.5
    assert gear.step(0.0, radians(35), 2.0) == pytest.approx(radians(5))
    assert gear.step(0.0, radians(-1), 2.0) == pytest.approx(radians(-1))
    easing = find("SteeringLag")(delay=1.5, travel_time=26.0, ease=3.0)
    assert easing.step(radians(2), radians(4), 1.0) == pytest.approx(radians(2.5))  # a quarter of the way
    assert easing.step(0.0, radians(35), 2.0) == pytest.approx(radians(5))


def test_a_rudder_that_hangs_loose_by_hand():
    loose = RudderPlay(gap=radians(2))
    assert loose.dead_time() == 0.0
    assert loose.step(0.0, radians(10), 1.0) == pytest.approx(radians(8))  # shown 10 deg, and two behind
    # turned back inside the play: nothing moves
    assert loose.step(radians(8), radians(7), 1.0) == pytest.approx(radians(8))
    assert loose.step(radians(8), radians(3), 1.0) == pytest.approx(radians(5))
    assert loose.step(radians(8), radians(-10), 1.0) == pytest.approx(radians(-8))


def test_what_swings_aside_with_her_by_hand(ship):
    """Test: a tenth of its mass, swinging about a fifth of its length ahead. Expected: Y and N of that mass,
    carried along aside; nothing ahead."""
    s, c, L = Situation(u=5.0, v=0.6, r=0.02, n=1.5, delta=0.2), ship.c, ship.L_pp
    tau = [sum(force) for force in zip(*Model(ship).known(s).values(), strict=True)]
    u_dot, v_dot, r_dot = Model(ship, (SwayingMass(share=0.1, place=0.2 * L, inertia=0.005),)).nu_dot(s)
    aside = v_dot + 5.0 * 0.02
    assert c.m_u * u_dot == pytest.approx(tau[0])
    assert c.m_v * v_dot + c.m_vr * r_dot == pytest.approx(tau[1] - ship.m * (0.1 * aside + 0.02 * L * r_dot))
    assert c.m_rv * v_dot + c.m_r * r_dot == pytest.approx(
        tau[2] - ship.m * (0.02 * L * aside + 0.005 * L**2 * r_dot)
    )


def test_a_hull_that_is_not_alike_on_both_sides_by_hand(ship):
    """Test: the flow along the hull, ahead and astern. Expected: side force and moment with its square, to the
    other side when going astern."""
    f = 0.5 * ship.rho * ship.L_pp * ship.T * 5.0**2
    bent = HullAsymmetry(Y_0=0.01, N_0=-0.002)
    for u_r, way in ((5.0, 1.0), (-5.0, -1.0)):
        push = bent.force(Situation(u_r=u_r), ship)
        assert push.X == 0.0 and pytest.approx(way * 0.01 * f) == push.Y
        assert pytest.approx(way * -0.002 * f * ship.L_pp) == push.N


def test_another_damping_of_the_hull_by_hand(ship):
    """Test: a moment of drifting and turning. Expected: Y less by sway u v, N less by yaw u r, nothing else."""
    s, c, L = Situation(u=5.0, v=0.6, r=0.02, n=1.5, delta=0.2), ship.c, ship.L_pp
    tau = [sum(force) for force in zip(*Model(ship).known(s).values(), strict=True)]
    u_dot, v_dot, r_dot = Model(ship, (HullDamping(sway=0.1, yaw=-0.01),)).nu_dot(s)
    f = 0.5 * ship.rho * L * ship.T
    assert c.m_u * u_dot == pytest.approx(tau[0])
    assert c.m_v * v_dot + c.m_vr * r_dot == pytest.approx(tau[1] - 0.1 * f * 5.0 * 0.6)
    assert c.m_rv * v_dot + c.m_r * r_dot == pytest.approx(tau[2] + 0.01 * f * L**2 * 5.0 * 0.02)
