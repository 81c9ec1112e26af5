"""What contradicts a promise, what the instruments leave open, and whether places and headings confirm the motion:
on made-up numbers, at every limit."""

import random
from math import cos, degrees, hypot, inf, log, pi, sin
from types import SimpleNamespace

import pytest

from twin.live.contradiction import Contradiction, contradicted
from twin.live.left_open import LeftOpen, least
from twin.live.parity import Parity
from twin.live.signals.measured import Measured

NU = ("u", "v", "r")


def test_how_often_samples_lie_beyond_the_bound_is_a_share_of_the_last_hundred():
    test, share = Contradiction(), 0.0
    for k in range(200):
        gap = 1.31 if k % 5 == 3 else -1.3  # bound 1, noise 0.3: the first beyond, the other not
        accepted = k % 7 != 0
        test.feed(gap, 1.0, 0.3, accepted)
        if accepted and (share or abs(gap) > 1.3):
            share += ((abs(gap) > 1.3) - share) / 100.0
        assert test._share == pytest.approx(share) and test.at(0.0) is (share > 0.1), k
    assert share > 0.1
    test._share = 0.1
    assert not test.at(0.0)
    one = Contradiction()
    one.feed(1.3, 1.0, 0.3, True)
    assert one._share == 0.0
    one.feed(-1.4, 1.0, 0.3, False)
    assert one._share == 0.0
    one.feed(-1.4, 1.0, 0.3, True)
    assert one._share == 0.01


def test_how_far_samples_lie_beyond_the_bound_is_added_up_by_pages_test_for_a_minute():
    """Expected: 3 z - 4.5 a sample, z in third parts of the noise beyond the bound, half of the limit at most."""
    limit, dice, test, far, until = log(1e8), random.Random(4), Contradiction(), 0.0, -inf
    for k in range(400):
        gap = dice.gauss(0.0, 0.1) + (1.45 if 100 <= k < 130 else 9.0 if k == 200 else 1.0)
        gap = -gap if k % 3 else gap
        now_s = 0.5 * k
        test.fresh(gap, 1.0, 0.3, now_s)
        far = max(0.0, far + min(3.0 * (abs(gap) - 1.0) / 0.1 - 4.5, limit / 2.0))
        if far >= limit:
            far, until = limit, now_s + 60.0
        assert test._far == pytest.approx(far, abs=1e-9) and test._until_s == until, k
        assert test.at(now_s) is (now_s < until) or k == 0
    assert 100 * 0.5 + 60.0 < until < 130 * 0.5 + 61.0 and not test.at(until) and test.at(until - 0.01)
    one = Contradiction()
    one.fresh(1e9, 1.0, 0.3, 0.0)
    assert one._far == pytest.approx(limit / 2.0) and not one.at(0.0)
    one.fresh(1e9, 1.0, 0.3, 1.0)
    assert one.at(1.0) and one.at(60.9) and not one.at(61.0)


def test_the_first_row_that_is_contradicted_has_the_word():
    tests = [Contradiction() for _ in NU]
    assert contradicted(NU, tests, 0.0) == ""
    tests[2]._until_s = 10.0
    assert (
        contradicted(NU, tests, 9.0).startswith("rate of turn is measured farther")
        and contradicted(NU, tests, 10.0) == ""
    )
    tests[1]._share = 0.2
    assert (
        contradicted(NU, tests, 9.0)
        == "sway speed is measured farther from the estimate than its bound allows"
    )


TUBE = SimpleNamespace(oldest_s=0.625, noise=(0.1, 0.2, 0.01), way=(0.5, 0.4, 0.03), heading_noise=0.02)
OBSERVER = SimpleNamespace(
    estimate=SimpleNamespace(u=5.0, v=0.3, r=0.02, psi=3.1), most=(6.0, 2.0, 0.05),
)  # fmt: skip


def opened(ages, since_late_s=inf, inside_s=0.0, without=(), derived=()):
    si = {"u": 5.4, "v": -0.1, "r": 0.015, "psi": -3.1}
    now_s = 50.0
    measured = Measured(
        now_s, {a: x for a, x in si.items() if a not in without}, derived=set(derived),
        time={a: now_s - age for a, age in zip(si, ages, strict=True)},
    )  # fmt: skip
    return LeftOpen(OBSERVER, measured, TUBE, since_late_s, inside_s)


def test_what_is_measured_leaves_open_its_gap_its_noise_and_its_ages_way():
    nu, psi = opened((0.0, 0.25, 0.5, 0.625)).bounds
    assert nu == pytest.approx((0.4 + 0.1, 0.4 + 0.2 + 0.1, 0.005 + 0.01 + 0.015))
    assert psi == pytest.approx(2.0 * pi - 6.2 + 0.02 + 0.625 * 0.05)


@pytest.mark.parametrize("how", ("without", "derived", "old"))
def test_what_is_not_measured_leaves_open_all_that_a_ship_can_do(how):
    for i, a in enumerate((*NU, "psi")):
        ages = [0.1] * 4
        if how == "old":
            ages[i] = 0.63
        one = opened(ages, **({} if how == "old" else {how: (a,)}))
        assert (*one.bounds[0], one.bounds[1])[i] == (12.0, 4.0, 0.1, pi)[i]
        assert not one.in_time(a) and not one.known(a)
        assert all(one.in_time(b) and one.known(b) for b in (*NU, "psi") if b != a)


def test_a_late_tick_shortens_and_being_inside_lengthens_what_counts():
    one = opened((0.3, 0.5, 2.0, 2.1), since_late_s=0.4, inside_s=2.0)
    assert one.oldest_s == 0.4
    assert [one.in_time(a) for a in (*NU, "psi")] == [True, False, False, False]
    assert [one.known(a) for a in (*NU, "psi")] == [True, True, True, False]
    assert one.bounds[0][2] == pytest.approx(0.005 + 0.01 + 2.0 * 0.03) and one.bounds[1] == pi
    assert opened((0.625,) * 4).in_time("u") and opened((0.625,) * 4).oldest_s == 0.625


def test_why_nothing_is_known_of_a_speed():
    one = opened((0.1, 0.1, 3.0, 0.1))
    assert one.unknown((), set()) == ""
    assert one.unknown(("r", "u"), set()) == "rate of turn is not measured yet"
    said = one.unknown(("r",), {"r"})
    assert said == "rate of turn is not measured often enough, age = 3.0 s where at most 0.62 s are certified"
    assert opened((0.1,) * 4, without=("v",)).unknown(("v",), {"v"}).endswith("is not measured")
    assert opened((0.1,) * 4, derived=("v",)).unknown(("v",), {"v"}).endswith("is not measured")


def test_of_two_bounds_the_lesser_row_by_row():
    assert least(((1.0, 5.0, 3.0), 0.4), ((2.0, 4.0, 1.0), 0.3)) == ((1.0, 4.0, 1.0), 0.3)
    assert least(((1.0, 5.0, 3.0), 0.2), ((0.5, 6.0, 4.0), 0.3)) == ((0.5, 5.0, 3.0), 0.2)


class Estimated:
    """A constant estimate, and instruments that say something else."""

    def __init__(
        self, u=4.0, v=0.5, r=0.0, psi=0.7, beta=(0.1, 0.05, 0.001), heading_noise=0.005, age_s=0.25
    ):
        self.e = SimpleNamespace(u=u, v=v, r=r, psi=psi)
        c, s = cos(psi), sin(psi)
        self.ned = u * c - v * s, u * s + v * c
        self.e.velocity_ned = lambda: self.ned
        self.beta, self.age_s, self.k, self.parity = beta, age_s, 0, Parity(heading_noise)
        self.ever = set()

    def run(self, seconds, off=(0.0, 0.0), turned=0.0, every=1, dt=0.5, steps=None, lost=()):
        for _ in range(round(seconds / dt)):
            self.k += 1
            now_s = dt * self.k
            t = now_s - self.age_s
            si = {
                "x": (self.ned[0] + off[0]) * t,
                "y": (self.ned[1] + off[1]) * t,
                "psi": 3.0 + (self.e.r + turned) * t,
            }
            si = {a: x for a, x in si.items() if a not in lost}
            fresh = {} if self.k % every else dict.fromkeys(si, dt)
            measured = Measured(now_s, si, fresh, steps or {}, time=dict.fromkeys(si, t))
            self.why = self.parity.feed(measured, self.e, self.beta, dt)
            self.ever |= {self.why} - {""}
        return self.why


def test_places_may_part_from_the_motion_by_their_noise_the_bounds_way_and_the_headings():
    """Expected: of a constant motion, over the longest window of 65 s, 6 m + heading noise of the path + the way of
    the bound, in the direction in which it is first exceeded; not said a hair below."""
    for psi, off in ((0.7, (1.0, 0.0)), (0.0, (0.0, 1.0)), (-2.0, (-0.6, 0.8)), (1.2, (0.2, -0.9))):
        c, s, sizes = cos(psi), sin(psi), []
        for k in range(8):
            a, b = cos(k * pi / 8.0), sin(k * pi / 8.0)
            rate = 0.005 * hypot(4.0, 0.5) + 0.1 * abs(c * a + s * b) + 0.05 * abs(c * b - s * a)
            sizes.append((6.0 / 65.0 + rate) / max(abs(off[0] * a + off[1] * b), 1e-9))
        for factor in (0.999, 1.001):
            one, size = Estimated(psi=psi), factor * min(sizes)
            one.run(300.0, (size * off[0], size * off[1]))
            assert bool(one.ever) is (factor > 1.0), (psi, factor)
            assert all(why.startswith("positions against the estimated speed, off = ") for why in one.ever)


def test_what_is_said_of_places_tells_how_far_they_are_off_in_what_time_and_what_is_allowed():
    said = Estimated(psi=0.0, v=0.0)
    assert said.run(55.0, (1.0, 0.0)) == ""
    why = said.run(0.5, (1.0, 0.0))
    assert (
        why
        == "positions against the estimated speed, off = 55.0 m in 55 s, allowed 12.6 m"
        == said.parity.why
    )
    said.run(100.0, (1.0, 0.0))
    assert "positions against the estimated speed, off = 65.0 m in 65 s, allowed 13.8 m" in said.ever


def test_headings_may_part_from_the_turning_by_their_noise_and_the_bounds_way():
    for r in (0.0, 0.02):
        for sign in (1.0, -1.0):
            most = (2.0 * 0.005 + 65.0 * 0.001) / 65.0
            assert Estimated(r=r).run(300.0, turned=0.999 * sign * most) == ""
            one = Estimated(r=r)
            one.run(300.0, turned=1.001 * sign * most)
            assert one.ever == {
                f"headings against the estimated rate of turn, off = {degrees(65.0 * 1.001 * most):.2f} deg in 65 s, "
                f"allowed {degrees(65.0 * most):.2f} deg"
            }


def test_a_step_or_a_pause_begins_anew_and_rare_measurements_count_too():
    one = Estimated()
    one.run(50.0, (2.0, 0.0))
    one.run(0.5, (2.0, 0.0), steps={"x": 1.0})
    assert one.run(54.0, (2.0, 0.0)) == "" != one.run(4.0, (2.0, 0.0))
    one.parity.begin()
    assert one.parity.why == "" and one.run(50.0, (2.0, 0.0)) == ""
    assert "positions" in Estimated().run(120.0, (2.0, 0.0), every=16)
    assert (
        Estimated().run(120.0, (2.0, 0.0), lost=("y",))
        == ""
        == Estimated().run(120.0, (2.0, 0.0), lost=("x",))
    )
    assert Estimated().run(120.0, turned=1.0, lost=("psi",)) == ""
