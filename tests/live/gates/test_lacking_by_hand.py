"""What shaft and rudder are judged by, on made-up motions whose answer is known: the force that the equations lack, a
second time, number by number."""

from math import inf, pi, radians
from types import SimpleNamespace

import pytest

from twin.live.gates.lacking import FAST, RUDDER_SAID, SHAFT_SAID, SLOW, CorrectedTick, Lacking
from twin.live.signals.measured import Measured
from twin.physics.ship import load

STEP_S, GAIN = 0.25, 0.5  # [s], [1/s]: it settles for 6 s
THRUST, A_RADIAN, U_0 = 2.0e6, 4.0e8, 8.0  # of the made-up ship [N], [N m/rad], [m/s]
MASS, INERTIA = 3.0e8, 2.0e12


class Told:
    """In a test's place: takes down what it is fed with."""

    def __init__(self):
        self.fed, self.alarm = [], False

    def feed(self, x, allowed=0.0):
        self.fed.append((x, allowed))


class Afloat:
    """A ship whose estimate, equations and forces are chosen, and the check that listens to it."""

    def __init__(self, block_s=2.0):
        self.check = Lacking(load("kvlcc2"))
        self.check.block_s, self.check.thrust, self.check.per_rad, self.check.U_0 = (
            block_s, THRUST, A_RADIAN, U_0,
        )  # fmt: skip
        self.shaft, self.rudder = self.check._shaft, self.check._rudder = Told(), Told()
        self.nu, self.restarts, self.now_s, self.delta = [7.0, 0.3, 0.01], 0, 0.0, 0.1
        self.grown = []

    def run(
        self, seconds, rates=(0.0, 0.0, 0.0), true=(0.0, 0.0, 0.0), hull=(0.0, 0.0), propeller=0.0,
        rudder=0.0, ready=True, lost=(), derived=(), steps=None, dt=STEP_S,
    ):  # fmt: skip
        """`rates`: what the equations say, `true`: how the estimate goes."""
        for _ in range(round(seconds / dt)):
            self.now_s += dt
            self.nu = [x + dt * x_dot for x, x_dot in zip(self.nu, true, strict=True)]
            u, v, r = self.nu
            si = dict.fromkeys(set("urnx") | {"delta", "psi"}, 1.0)
            measured = Measured(
                self.now_s, {a: x for a, x in si.items() if a not in lost}, {}, steps or {}, set(derived)
            )
            observer = SimpleNamespace(
                estimate=SimpleNamespace(ready=ready, u=u, v=v, r=r), gain=GAIN, restarts=self.restarts,
                rates=SimpleNamespace(u=rates[0], v=rates[1], r=rates[2]),
            )  # fmt: skip
            physics = SimpleNamespace(force_for=self.force_for)
            forces = ((hull[0], 0.0, hull[1]), (9e9, 9e9, 9e9), (propeller, 0.0, 9e9), (9e9, 0.0, rudder))
            s = SimpleNamespace(delta=self.delta, grown="grown")
            self.check.feed(CorrectedTick(measured, observer, s, physics, forces, dt))

    def force_for(self, u_dot, v_dot, r_dot, grown):
        self.grown.append(grown)
        return MASS * u_dot, 7.0 * v_dot, INERTIA * r_dot + 1e5 * v_dot


def settled(**of):
    ship = Afloat(**of)
    ship.run(6.0 + STEP_S)  # settles, and one tick more begins the block
    return ship


def test_the_force_that_the_equations_lack_is_what_the_motion_did_beyond_them_over_a_block():
    """Test: it speeds up, slips and turns faster than its equations say. Expected: inertia times the difference over
    thrust; allowed is 0.35 of the forces at work, in thrusts."""
    ship = settled()
    rates, true = (0.01, 0.002, 1e-5), (0.016, 0.006, 4e-5)
    ship.run(2.0, rates, true, hull=(-1.2e6, 3e7), propeller=0.8e6, rudder=-5e7)
    (fed,) = ship.shaft.fed
    assert fed == pytest.approx((MASS * 0.006 / THRUST, 0.35 * (1.2e6 + 0.8e6) / THRUST))
    assert ship.grown == ["grown"]
    # the rudder's share: its feedback has just been met, so it counts as moving, and an eighth of it is usual
    speed = sum(7.0 + 0.016 * STEP_S * k for k in range(1, 9)) / 8.0
    per_rad = A_RADIAN * (speed / U_0) ** 2
    lacks = (INERTIA * 3e-5 + 1e5 * 0.004) / per_rad
    assert ship.rudder.fed == [(pytest.approx(lacks - lacks / 8.0), inf)]
    ship.run(2.0, rates, true, hull=(-1.2e6, 3e7), propeller=0.8e6, rudder=-5e7)
    speed += 0.016 * 2.0
    per_rad = A_RADIAN * (speed / U_0) ** 2
    lacks_2 = (INERTIA * 3e-5 + 1e5 * 0.004) / per_rad
    allowed = radians(4.0) + 0.15 * (3e7 + 5e7) / per_rad
    assert ship.rudder.fed[1] == pytest.approx((lacks_2 - lacks / 8.0, allowed))
    assert ship.shaft.fed[1] == pytest.approx(fed)


def test_a_rudder_that_moves_teaches_what_is_usual_and_one_that_stands_is_held_against_it():
    """Expected: moved is more than half a degree from where it stood, and not half a degree; slow ships count as a tenth
    of the pressure."""
    ship = settled()
    ship.nu[0], turned = 0.8, 3e-5
    per_rad, usual, stands = 0.1 * A_RADIAN, 0.0, None
    for k, delta_deg in enumerate((5.0, 5.49, 4.51, 5.51, 5.6, 5.02, 5.0, -3.0, -3.0)):
        ship.delta = radians(delta_deg)
        ship.run(2.0, true=(0.0, 0.0, turned), rudder=2e6)
        lacks = INERTIA * turned / per_rad
        moved = stands is None or abs(delta_deg - stands) > 0.5
        if moved:
            stands = delta_deg
            usual += (lacks - usual) / 8.0
        allowed = inf if moved else radians(4.0) + 0.15 * 2e6 / per_rad
        assert ship.rudder.fed[k] == pytest.approx((lacks - usual, allowed)), k
    assert [allowed == inf for _, allowed in ship.rudder.fed] == [
        True, False, False, True, False, False, True, True, False,
    ]  # fmt: skip


def test_half_a_degree_is_no_movement():
    ship = settled()
    for delta, moved in ((0.0, True), (radians(0.5), False), (-radians(0.5), False), (radians(0.51), True)):
        ship.delta = delta
        ship.run(2.0)
        assert (ship.rudder.fed[-1][1] == inf) is moved, delta


@pytest.mark.parametrize("restarts", (0, 1))
def test_an_estimate_that_began_anew_settles_for_three_time_constants_before_anything_counts(restarts):
    ship = Afloat()
    ship.restarts = restarts
    ship.run(6.0 + 2.0)
    assert not ship.shaft.fed  # the tick at which it has settled begins the block
    ship.run(STEP_S)
    assert len(ship.shaft.fed) == 1
    ship.run(1.0)
    ship.restarts += 1
    ship.run(6.0 + 2.0, true=(1.0, 0.0, 0.0))
    assert len(ship.shaft.fed) == 1
    ship.run(STEP_S)
    assert len(ship.shaft.fed) == 2
    # what pulled it to its place is no force: two seconds at 1 m/s2, then one tick of none
    assert ship.shaft.fed[1][0] == pytest.approx(MASS * (2.0 - STEP_S) / 2.0 / THRUST)


@pytest.mark.parametrize("without", [{"lost": (a,)} for a in ("u", "r", "delta", "n", "psi")] + [
    {"derived": (a,)} for a in ("u", "r", "psi")
] + [{"ready": False}, {"steps": {"u": 1.0}}])  # fmt: skip
def test_without_what_it_needs_for_one_tick_the_block_begins_anew(without):
    ship = settled()
    ship.run(1.5)
    ship.run(STEP_S, **without)
    ship.run(2.0)
    assert not ship.shaft.fed and not ship.rudder.fed
    ship.run(STEP_S)
    assert len(ship.shaft.fed) == len(ship.rudder.fed) == 1
    ship.run(1.0)
    ship.check.pause()
    ship.run(2.0)
    assert len(ship.shaft.fed) == 1


def test_what_no_check_rests_on_may_be_derived_or_lost():
    ship = settled()
    ship.run(2.0, derived=("n", "x", "delta"), lost=("x",))
    assert len(ship.shaft.fed) == 1


def test_each_alarm_has_its_word():
    ship = settled()
    assert ship.check.reasons == []
    ship.shaft.alarm = True
    assert ship.check.reasons == [SHAFT_SAID]
    ship.rudder.alarm = True
    assert ship.check.reasons == [SHAFT_SAID, RUDDER_SAID]
    ship.shaft.alarm = False
    assert ship.check.reasons == [RUDDER_SAID]


def test_blocks_and_scales_follow_from_the_ship():
    """Expected: a sixteenth and a fourth of the time for its own length, half a second and four at least; the thrust
    that holds its service speed; the moment of a radian of its rudder, by the slope between no helm and 0.1 rad."""
    ship, boat = load("kvlcc2"), load("usv")
    time_s = ship.L_pp / ship.U_0
    assert Lacking(ship).block_s == Lacking(ship, FAST).block_s == pytest.approx(time_s / 16.0)
    assert Lacking(ship, SLOW).block_s == pytest.approx(time_s / 4.0)
    assert Lacking(boat).block_s == 0.5 and Lacking(boat, SLOW).block_s == 4.0
    check = Lacking(ship)
    assert check.U_0 == ship.U_0 and (check._shaft.least, check._shaft.most) == (0.03, 0.3)
    assert (check._rudder.least, check._rudder.most) == (pytest.approx(pi / 180.0), 0.0)
    assert check._usual == 0.0
    # at service speed the propeller carries the hull, less what the rudder in its wash takes
    from twin.live.observer.operating import propeller_rate
    from twin.physics.model import Model
    from twin.physics.state import Situation

    model = Model(ship, ())
    s = Situation(u=model.loaded.U_0, n=propeller_rate(model))
    by_name = dict(zip(model.names, model.forces(s, model.water(Situation())), strict=True))
    assert check.thrust == pytest.approx(abs(float(by_name["propeller"][0])))
    s.delta = 0.1
    by_name = dict(zip(model.names, model.forces(s, model.water(Situation())), strict=True))
    assert check.per_rad == pytest.approx(abs(float(by_name["rudder"][2])) / 0.1)
