"""Signs and units by pairs of signals, on made-up measurements: what is summed, when it is judged, what is said."""

import random
from dataclasses import replace
from math import copysign, exp, sqrt

import pytest

from twin.live.gates import plausible
from twin.live.gates.plausible import SPEEDS, TURNS, Pair, Plausibility
from twin.live.signals.measured import Measured

TURNING, MOVING = "yaw_rate_degps against the turning heading", "speed over ground against the positions"
HELM = (
    "yaw_rate_degps against rudder_angle_deg: it turns against its rudder; one of the two has the wrong sign"
)


def test_a_pair_is_three_slow_sums_and_their_factor():
    pair, ab, bb, aa = Pair(10.0, 0.5), 0.0, 0.0, 0.0
    assert pair.correlation() == 0.0
    for k, (a, b, dt) in enumerate(((2.0, -1.0, 1.0), (1.0, -1.5, 2.0), (-3.0, 2.0, 8.0), (0.5, -1.0, 4.0))):
        w = min(dt / 10.0, 0.5)
        ab, bb, aa = ab + w * (a * b - ab), bb + w * (b * b - bb), aa + w * (a * a - aa)
        pair.feed(a, b, dt)
        assert (pair.ab, pair.bb, pair.aa) == pytest.approx((ab, bb, aa))
        assert pair.heard_s == pytest.approx((1.0, 3.0, 11.0, 15.0)[k]) and not pair.judged
    pair.feed(0.5, -1.0, 0.1)
    assert pair.judged and pair.factor() < 0.0
    assert pair.factor() == pytest.approx(copysign(sqrt(pair.aa / pair.bb), pair.ab))
    assert pair.correlation() == pytest.approx(pair.ab / sqrt(pair.aa * pair.bb))
    pair.enough = sqrt(pair.bb)
    pair.bb = pair.enough**2
    assert not pair.judged


@pytest.mark.parametrize(
    "factor, mistakes, word",
    (
        (1.0, TURNS, ""), (1.55, TURNS, ""), (0.65, TURNS, ""), (-1.0, TURNS, "has the wrong sign"),
        (-1.19, TURNS, "has the wrong sign"), (-1.3, TURNS, "does not fit"), (58.0, TURNS, "is in degrees where radians were meant"),
        (60.5, TURNS, "is per minute"), (0.0175, TURNS, "is in radians where degrees were meant"), (0.5, TURNS, "does not fit"),
        (1.6, TURNS, "does not fit"), (0.6, TURNS, "does not fit"), (1.94, SPEEDS, "is in knots"), (0.514, SPEEDS, "was converted from knots twice"),
        (1.59, SPEEDS, "is in knots"), (3.0, SPEEDS, "does not fit"),
    ),
)  # fmt: skip
def test_the_nearest_mistake_within_a_fifth_has_its_name(factor, mistakes, word):
    assert plausible._word(factor, (factor, factor), mistakes) == word


@pytest.mark.parametrize("noise, said", ((0.0, "does not fit"), (0.3, "does not fit"), (2.0, "")))
def test_a_factor_that_noise_of_the_compass_explains_is_no_mistake(noise, said):
    """Test: a gyro that says a third (noise 0 and 0.3 of the turning) or, in 2.0, all of a turning that the compass sees
    with that noise. Expected by hand: k between rho k and k/rho, times exp(5 sqrt((1 - rho^2) w/(2 - w))), w = 0.05."""
    pair, dice = Pair(20.0, 0.1), random.Random(2)
    for _ in range(400):
        true = dice.gauss(0.0, 1.0)
        pair.feed(true / (1.0 if noise > 1.0 else 3.0), true + dice.gauss(0.0, noise), 1.0)
    rho, k = pair.correlation(), pair.factor()
    by = exp(5.0 * sqrt(max(1.0 - rho * rho, 0.0) * 0.05 / 1.95)) / rho
    assert pair.factors() == pytest.approx((k / by, k * by)) and k < 0.6
    assert plausible._word(k, pair.factors(), TURNS) == said
    assert plausible._word(-k, (-k * by, -k / by), TURNS) == "does not fit"


class Sailed:
    """A ship that turns and moves as told; its instruments say what the factors make of it."""

    def __init__(self, ship, turn_factor=1.0, speed_factor=1.0, helm=1.0):
        self.T, self.U = ship.L_pp / ship.U_0, ship.U_0
        self.one = Plausibility(ship)
        self.turn_factor, self.speed_factor, self.helm = turn_factor, speed_factor, helm
        self.k, self.psi, self.x = 0, 0.0, 0.0

    def run(self, seconds, alter=lambda k, measured: None, dt=0.5):
        for _ in range(round(seconds / dt)):
            r = 0.4 / self.T * (1.0 if self.k // 200 % 2 else -1.0)
            now_s = 100.0 + dt * self.k
            self.psi, self.x, self.k = self.psi + r * dt, self.x + 0.8 * self.U * dt, self.k + 1
            si = {"psi": self.psi, "r": self.turn_factor * r, "x": self.x, "y": 3.0, "u": self.speed_factor * 0.64 * self.U,
                  "v": self.speed_factor * 0.48 * self.U, "delta": self.helm * r * self.T * 0.3, "n": 1.0}  # fmt: skip
            measured = Measured(now_s, si, dict.fromkeys(si, dt), time=dict.fromkeys(si, now_s))
            alter(self.k, measured)
            self.one.feed(measured, dt)
        return self.one.reasons()


def test_healthy_instruments_are_not_spoken_of_and_each_mistake_is(kvlcc2):
    for factors, said in (
        ({}, []),
        ({"turn_factor": -1.0, "helm": -1.0}, [f"{TURNING}: it has the wrong sign"]),
        ({"turn_factor": 60.0, "helm": 1.0}, [f"{TURNING}: it is per minute"]),
        ({"speed_factor": 1.943844}, [f"{MOVING}: it is in knots"]),
        ({"speed_factor": 0.514444}, [f"{MOVING}: it was converted from knots twice"]),
        ({"helm": -1.0}, [HELM]),
        ({"turn_factor": -1.0, "speed_factor": 1.943844}, [f"{TURNING}: it has the wrong sign", f"{MOVING}: it is in knots", HELM]),
    ):  # fmt: skip
        sailed = Sailed(kvlcc2, **factors)
        assert sailed.run(2.5 * sailed.T) == [], factors
        assert sailed.run(6.0 * sailed.T) == said, factors


def test_the_sums_of_turning_and_speed_are_those_of_half_a_ship_length_each(kvlcc2):
    """Expected: turning in a fifth of L/U_0; factor and pace of each pair as they were made, exactly."""
    sailed = Sailed(kvlcc2, turn_factor=2.0, speed_factor=3.0)
    fed = {"_turn": [], "_speed": [], "_helm": []}
    for name, into in fed.items():
        pair = getattr(sailed.one, name)
        pair.feed = lambda a, b, dt, into=into: into.append((a, b, dt))
    sailed.run(1.9 * sailed.T)
    over_s = 0.2 * sailed.T
    assert over_s > 2.0 and sailed.one.over_s == pytest.approx(over_s)
    span_s = 0.5 * -(-over_s // 0.5)
    r = 0.4 / sailed.T
    assert len(fed["_turn"]) == len(fed["_speed"]) >= 8
    a, b, dt = fed["_turn"][0]
    assert (abs(b), dt) == pytest.approx((r, span_s)) and a == pytest.approx(2.0 * b)
    assert fed["_speed"][0] == pytest.approx((2.4 * sailed.U, 0.8 * sailed.U, span_s))
    a, low, dt = fed["_helm"][0]
    assert dt == 0.5 and a == pytest.approx(-0.8) and low == pytest.approx(0.5 / sailed.T * -0.4 * 0.3)
    low_before = low
    a, low, dt = fed["_helm"][1]
    assert low == pytest.approx(low_before + 0.5 / sailed.T * (-0.12 - low_before))


@pytest.mark.parametrize(
    "name, without, derived, still",
    (
        ("_turn", ("psi", "r"), ("r",), ("x", "y", "u", "v", "delta", "n")), ("_speed", ("x", "y", "u", "v"), ("u",), ("delta", "n")),
        ("_helm", ("delta", "r", "n"), (), ("psi", "x", "y", "v")),
    ),
)  # fmt: skip
def test_a_pair_is_fed_only_while_both_sides_are_measured(kvlcc2, name, without, derived, still):
    def heard(alter):
        sailed = Sailed(kvlcc2)
        sailed.run(100.0, alter)
        return getattr(sailed.one, name).heard_s > 0.0

    def lose(attribute):
        return lambda k, measured: (measured.si.pop(attribute), measured.fresh.pop(attribute))

    assert heard(lambda k, measured: None)
    for attribute in without:
        assert not heard(lose(attribute)), attribute
    for attribute in derived:
        assert not heard(lambda k, measured, a=attribute: measured.derived.add(a)), attribute
    for attribute in still:
        assert heard(lose(attribute)), attribute


@pytest.mark.parametrize("attribute", ("n", "u"))
def test_astern_or_without_way_the_rudder_says_nothing(kvlcc2, attribute):
    for value in (0.0, -1.0):
        sailed = Sailed(kvlcc2)
        sailed.run(50.0, lambda k, measured, value=value: measured.si.update({attribute: value}))
        assert sailed.one._helm.heard_s == 0.0


def test_no_way_is_measured_across_a_hole_or_a_step(kvlcc2):
    sailed = Sailed(kvlcc2)
    sailed.run(2.0)
    assert set(sailed.one._last) == {"psi", "x"}
    sailed.run(0.5, lambda k, measured: measured.steps.update(x=1.0))
    assert sailed.one._last == {} and sailed.one._helm.heard_s == pytest.approx(2.0)
    sailed.run(2.0)
    sailed.run(1.5, dt=1.5)
    assert sailed.one._last == {}


def test_scales_of_a_ship_and_of_a_small_boat(kvlcc2):
    one, T = Plausibility(kvlcc2), kvlcc2.L_pp / kvlcc2.U_0
    assert [one._turn.time_s, one._speed.time_s, one._helm.time_s, one.time_s] == pytest.approx(
        [2 * T, 2 * T, 3 * T, T]
    )
    assert [one._turn.enough, one._speed.enough, one._helm.enough] == pytest.approx(
        [0.02 / T, 0.15 * kvlcc2.U_0, 0.04]
    )
    boat = Plausibility(replace(kvlcc2, L_pp=8.0))
    assert boat.over_s == 2.0 and boat._turn.time_s == boat._speed.time_s == 20.0


def test_what_goes_half_together_is_not_named(kvlcc2):
    one = Plausibility(kvlcc2)
    for ab, said in ((-0.79, []), (-0.81, [f"{TURNING}: it has the wrong sign"])):
        one._turn.ab, one._turn.aa, one._turn.bb, one._turn.heard_s, one._turn.enough = ab, 1.0, 1.0, 1e6, 0.1
        assert one.reasons() == said
    one._turn.heard_s = 0.0
    for ab, said in ((-0.49, []), (-0.5, []), (-0.51, [HELM])):
        one._helm.ab, one._helm.aa, one._helm.bb, one._helm.heard_s = ab, 1.0, 1.0, 1e6
        assert one.reasons() == said
