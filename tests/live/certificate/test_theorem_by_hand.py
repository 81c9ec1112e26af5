"""The theorem's numbers against its equations (docs/stability.md, section 4), written a second time with
matrices, for ships made up of slopes that are all different."""

import numpy as np
import pytest
from scipy.linalg import expm

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.periods import TABLE, TOO_LONG, of_certificate
from twin.live.certificate.plant import Disturbance, Plant
from twin.live.certificate.recursion import pushed, recursion
from twin.live.certificate.theorem import NEVER, NOWHERE, assess, ratio
from twin.live.observer.operating import OperatingSet

RANGES = {"u": (0.0, 9.0), "v": (-2.0, 2.0), "r": (-0.02, 0.015)}
SHIP = Plant(
    lo=((-0.031, -0.012, -0.4), (-0.0021, -0.052, -1.3), (-0.00013, -0.0023, -0.061)),
    hi=((0.011, 0.017, 0.3), (0.0037, -0.004, 0.9), (0.00009, 0.0031, -0.012)),
    heading=(0.013, 0.021, 0.0007),
    most=(0.08, 0.05, 0.0011),
    inertia=((3.1e-9, 0.0, 2e-11), (1e-10, 2.2e-9, 3e-11), (2e-12, 1.1e-11, 2.3e-13)),
    h=0.21,
    operating=OperatingSet(RANGES),
    moved=(0.002, 0.003, 0.00004),
).at_period(0.21)
WILD = Plant(  # damped so strongly that a step may turn an error round
    lo=((-9.5, -0.2, -0.1), (-0.3, -8.7, -0.4), (-0.1, -0.2, -10.5)),
    hi=((-9.0, 0.1, 0.2), (0.2, -8.1, 0.3), (0.2, 0.3, -9.9)),
    heading=(0.01, 0.02, 0.03),
    most=(0.8, 0.5, 0.3),
    inertia=SHIP.inertia,
    h=0.21,
    operating=SHIP.operating,
).at_period(0.21)
K, NOISE, PSI = (0.31, 0.42, 0.53), (0.11, 0.13, 0.0007), 0.004
D = Disturbance((4e5, 3e5, 2e7))


def by_hand(plant, K, m, curve=0.26, n_psi=PSI):
    """V, W, again, drift, d, and what multiplies d and n in (2), by the page's equations."""
    h, S = plant.h, np.maximum(-np.array(plant.lo), np.array(plant.hi))
    A4 = np.vstack([np.column_stack([S, plant.heading]), [0.0, 0.0, 1.0, 0.0]])
    H = h * A4
    bend = expm(H) - np.eye(4) - H
    Hb, T = bend[:3, :3], (expm(H) @ A4)[:3, :3]
    hK, l = h * np.array(K), np.array([max(x - 1, 0) for x in m])
    V, W = h * S + Hb, h * S + Hb
    for i in range(3):
        grows, turns = 1.0 + h * max(plant.hi[i][i], 0.0), h * S[i, i] - 1.0
        V[i, i] = max(grows, turns) + Hb[i, i]
        W[i, i] = max(max(grows - hK[i], turns + hK[i]) + Hb[i, i], abs(1.0 - hK[i]) * V[i, i])
    for i in range(3):
        if m[i] == 0:
            W[i] = abs(1.0 - hK[i]) * V[i]
    B, force = np.array(plant.inertia), np.array(D.calm)
    along = np.eye(3) + (0.5 + curve) * h * T
    d = (
        h * along @ (B @ force + plant.moved)
        + (h * np.array(plant.heading) + bend[:3, 3]) * n_psi
        + curve * h * h * (expm(H) @ A4)[:3] @ np.array([*plant.most, 0.02])
    )
    on_d = np.where(np.array(m) > 0, 1.0 + (l + 0.5) * hK, abs(1.0 - hK))
    return V, W, l * hK**2, (l * hK)[:, None] * (h * S + Hb), d, on_d, hK * (1.0 + l * hK)


@pytest.mark.parametrize("plant", [SHIP, WILD], ids=["a tanker", "strongly damped"])
@pytest.mark.parametrize("m", [(0, 0, 0), (1, 1, 1), (2, 5, 1), (0, 1, 3)])
def test_every_matrix_of_one_sample_is_that_of_the_page(plant, m):
    V, W, again, drift, d, on_d, on_n = by_hand(plant, K, m)
    step = recursion(plant, K, m)
    for ours, hand in (
        (step.V, V), (step.now, W), (step.again, again), (step.drift, drift), (step.pushed, on_d),
        (step.heard, on_n), (step.G, W + again[:, None] * V + drift), (step.share(), np.diag(on_d + again)),
        (step.left_by(tuple(d), NOISE), on_d * d + on_n * NOISE),
    ):  # fmt: skip
        assert np.array(ours) == pytest.approx(hand, rel=1e-12, abs=1e-18)
    push, calm = pushed(plant, PSI)
    assert np.array(push) @ D.calm + calm == pytest.approx(d, rel=1e-12)


@pytest.mark.parametrize("m", [(0, 0, 0), (1, 1, 1), (2, 5, 1)])
def test_the_promise_is_the_fixed_point_and_the_rate_solves_its_equation(m):
    V, W, again, drift, d, on_d, on_n = by_hand(SHIP, K, m)
    G = W + again[:, None] * V + drift
    promise, end = assess(SHIP, K, m, NOISE, D, PSI), np.linalg.inv(np.eye(3) - G)
    assert promise.ok
    assert promise.bound == pytest.approx(end @ ((on_d + again) * d + on_n * NOISE), rel=1e-9)
    assert np.array(promise.gains_noise) == pytest.approx(end @ np.diag(on_n), rel=1e-9)
    more = np.array([1e5, 0.0, 0.0])
    wider = assess(SHIP, K, m, NOISE, Disturbance(tuple(D.calm + more)), PSI)
    assert np.array(wider.bound) - promise.bound == pytest.approx(
        np.array(promise.gains_disturbance) @ more, rel=1e-6
    )
    x = np.exp(-promise.rate * SHIP.h)
    later = W + x ** (-2 * max(m)) * (again[:, None] * V + drift)
    assert max(abs(np.linalg.eigvals(later))) == pytest.approx(x, rel=1e-6) and 0.0 < x < 1.0
    least = max(abs(np.linalg.eigvals(np.array(SHIP.growth()) / np.array(K)[:, None])))
    assert promise.margin == pytest.approx(1.0 - least, rel=1e-9)
    assert ratio(SHIP, K, None) == pytest.approx(least, rel=1e-9)
    assert f"{100 * least:.0f} % of it is the least" in promise.reason


def test_a_regressor_that_is_fed_with_its_own_estimate_adds_to_the_slopes():
    extra = ((0.01, 0.02, 0.03), (0.001, 0.002, 0.003), (0.0001, 0.0002, 0.0003))
    plain, fed = recursion(SHIP, K, (2, 2, 2)), recursion(SHIP, K, (2, 2, 2), extra)
    more, hK = SHIP.h * np.array(extra), SHIP.h * np.array(K)
    assert np.array(fed.V) - plain.V == pytest.approx(more, abs=1e-15)
    assert np.array(fed.drift) - plain.drift == pytest.approx(hK[:, None] * more, abs=1e-15)
    grown = np.array(SHIP.growth()) + extra
    least = max(abs(np.linalg.eigvals(grown / np.array(K)[:, None])))
    assert ratio(SHIP, K, extra) == pytest.approx(least, rel=1e-9)
    assert assess(SHIP, K, (2, 2, 2), NOISE, D, PSI, extra).margin == pytest.approx(1.0 - least, rel=1e-9)


@pytest.mark.parametrize(
    "gain, words",
    (
        (0.01, "too small: errors could grow faster than it pulls them back. K from "),
        (9.6, "is outside what a period of 0.21 s and measurements 1/1/1 samples old allow. K from "),
    ),
)
def test_a_gain_that_does_not_hold_promises_nothing_and_says_which_would(gain, words):
    refused = assess(SHIP, (gain,) * 3, (1, 1, 1), NOISE, D, PSI)
    assert not refused.ok and refused.bound == NOWHERE and refused.rate == -NEVER
    assert all(x == NEVER for row in (*refused.gains_disturbance, *refused.gains_noise) for x in row)
    assert words in refused.reason
    low, high = (float(x) for x in refused.reason.split("K from ")[1].split(" 1/s")[0].split(" to "))
    assert assess(SHIP, (1.01 * low,) * 3, (1, 1, 1), NOISE, D).ok
    assert assess(SHIP, (0.99 * high,) * 3, (1, 1, 1), NOISE, D).ok
    assert not assess(SHIP, (0.98 * low,) * 3, (1, 1, 1), NOISE, D).ok


def test_where_no_gain_holds_a_shorter_period_is_named_and_one_does_there():
    late = assess(SHIP, K, (60, 60, 60), NOISE, D, PSI)
    assert (
        not late.ok and "no K holds at a period of 0.21 s with measurements 60/60/60 samples" in late.reason
    )
    period = float(late.reason.split("every ")[1].split(" s")[0])
    plant = SHIP.at_period(period)
    assert any(assess(plant, (k,) * 3, (60, 60, 60), NOISE, D).ok for k in np.geomspace(1e-3, 1.0, 200))


def test_slopes_without_a_bound_are_said_to_be_so():
    endless = Plant(SHIP.lo, ((NEVER,) * 3,) * 3, SHIP.heading, SHIP.most, SHIP.inertia, SHIP.h,
                    SHIP.operating, SHIP.bend)  # fmt: skip
    assert "the slopes of the physics have no bound" in assess(endless, K, (1, 1, 1), NOISE, D).reason


@pytest.mark.parametrize("shares, count", (
    (0.0, 1), (1.0, 1), (1.0 + 5e-7, 1), (1.001, 2), (2.0, 2), (2.5, 3), (3.0, 3), (3.1, 5), (5.0, 5),
    (6.0, 10), (10.0, 10), (10.1, 30), (30.0, 30), (30.1, TOO_LONG), (1e6, TOO_LONG),
))  # fmt: skip
def test_a_tick_is_covered_by_the_next_entry_of_the_table(shares, count):
    assert of_certificate(Certified()).count(shares * SHIP.h) == count


class Certified:
    """What of a certificate the table of periods asks for."""

    h, plant, K, delays, extra_growth = SHIP.h, SHIP, K, (1, 1, 1), None


@pytest.mark.parametrize("periods", TABLE)
def test_a_long_tick_is_one_long_step_without_a_measurement(periods):
    """Expected: the page's V and d for j periods, the step's curve taken at one half from two on, the
    heading's error by itself."""
    step = of_certificate(Certified()).of(periods)
    curve = 0.26 if periods == 1 else 0.5
    V, *_, d, _, _ = by_hand(SHIP.at_period(periods * SHIP.h), K, (1, 1, 1), curve, n_psi=0.0)
    assert np.array(step.V) == pytest.approx(V, rel=1e-12)
    assert np.array(step.pushed(D.calm)) + step.calm == pytest.approx(d, rel=1e-12)
    turned = by_hand(SHIP.at_period(periods * SHIP.h), K, (1, 1, 1), curve, n_psi=1.0)[4] - d
    assert np.array(step.turned) == pytest.approx(turned, rel=1e-9)


def test_what_no_entry_covers_is_stepped_as_the_longest():
    periods = of_certificate(Certified())
    assert periods.of(TOO_LONG) == periods.of(TABLE[-1])


SAMPLES = np.random.default_rng(5).uniform(0.0, 0.5, (40, 3, 3)) * np.geomspace(0.05, 3.0, 40)[:, None, None]


@pytest.mark.parametrize("a", SAMPLES, ids=range(len(SAMPLES)))
def test_the_algebra_of_three_by_three_is_numpys(a):
    rows = tuple(map(tuple, a.tolist()))
    worst = max(abs(np.linalg.eigvals(a)))
    assert c3.radius(rows) == pytest.approx(worst, rel=1e-9)
    assert c3.contracts(rows) is bool(worst < 1.0)
    assert c3.contracts(rows, 1.001 * worst) and not c3.contracts(rows, 0.999 * worst)
    assert np.array(c3.inverse(rows)) == pytest.approx(np.linalg.inv(a), rel=1e-8)
    end = c3.settled(rows)
    if worst < 1.0:
        assert np.array(end) == pytest.approx(np.linalg.inv(np.eye(3) - a), rel=1e-8)
    else:
        assert end is None
    assert np.array(c3.beyond_first(rows)) == pytest.approx(expm(a) - np.eye(3) - a, rel=1e-11, abs=1e-15)
    x = tuple(a[0])
    assert np.array(c3.apply(rows, x)) == pytest.approx(a @ a[0])
    assert np.array(c3.product(rows, c3.diagonal(x))) == pytest.approx(a @ np.diag(a[0]))
    assert np.array(c3.plus(rows, rows, c3.IDENTITY)) == pytest.approx(2.0 * a + np.eye(3))
    assert c3.add(x, c3.scaled_row(2.0, x)) == pytest.approx(3.0 * a[0])


def test_the_edges_of_the_algebra():
    """Expected: nothing contracts at exactly one, nothing singular has an inverse, no bound is no number."""
    assert not c3.contracts(c3.IDENTITY) and c3.settled(c3.IDENTITY) is None
    assert c3.radius(c3.IDENTITY) == pytest.approx(1.0) and c3.radius(c3.scaled(0.0, c3.IDENTITY)) < 1e-100
    assert c3.inverse(c3.scaled(0.0, c3.IDENTITY)) is None
    assert c3.radius(c3.diagonal((NEVER, 0.0, 0.0))) == NEVER
    assert c3.radius(((0.0, 1e200, 0.0), (1e200, 0.0, 0.0), (0.0, 0.0, 0.0))) == NEVER  # its minors overflow
    forged = ((0.0, 0.08, 19.7), (-5.6e302, -1.9e302, -3.5e305), (8e-4, 2e-3, 0.0))
    assert c3.radius(forged) < 1e-300  # no matrix of a ship: it ends all the same
    for i in range(3):  # each minor by itself
        one = c3.diagonal(tuple(1.5 if j == i else 0.1 for j in range(3)))
        assert not c3.contracts(one) and c3.radius(one) == pytest.approx(1.5)
