"""Theorem 3 for samples of each axis at times of their own: the step of its proof against bounds that are carried on
step by step."""

import random
from itertools import pairwise

import pytest

from bench.stability.attack.cases import AttackCase, certified_for
from twin.live.certificate.rolled import FOUR, InnerStep, bound_at_any_ages, inner, way

PARTS = 4  # into which an inner step is cut at most


def of(ship, spans, rate_hz=10.0):
    c = certified_for(AttackCase(ship, rate_hz))[1]
    force = c.disturbance.at(0.0)
    return c, force, bound_at_any_ages(c.plant, c.K, c.inner, c.noise, force, c.heading_noise, spans)


@pytest.mark.parametrize(
    ("ship", "rate_hz", "spans"), [("kvlcc2_model", 10.0, 2.0), ("usv", 10.0, 1.0), ("usv", 20.0, 1.5)]
)
@pytest.mark.parametrize("seed", range(4))
def test_whenever_each_axis_is_sampled_no_bound_that_is_carried_on_settles_above_it(
    ship, rate_hz, spans, seed
):
    """Test: the recursion of the live tube, each row corrected at times of its own, up to `spans` periods apart, in
    parts of inner steps. Expected: after the first periods no row is above the bound of any ages, and none of them needless by
    more than three times."""
    c, force, most = of(ship, spans, rate_hz)
    chance, a = random.Random(seed), c.K[0] * c.h
    part = c.plant.h / c.inner / PARTS
    step = InnerStep(c.plant.at_period(part))
    d, n = step.pushes(force, way(c.plant, force)[2]), (*c.noise, c.heading_noise)
    x, met = [2.0 * b for b in most], [0.0] * 4
    period, often = round(c.inner * PARTS * spans), seed % 2 == 0
    due = [chance.randrange(period) for _ in FOUR]
    for k in range(60 * period):
        x = [sum(m * y for m, y in zip(row, x, strict=True)) + e for row, e in zip(step.M, d, strict=True)]
        if k > 40 * period:
            met = [max(b, y) for b, y in zip(met, x, strict=True)]
        for i in FOUR:
            if k >= due[i]:
                x[i] = (1.0 - a) * x[i] + a * n[i]
                due[i] = k + (period if often else chance.randint(period // 2, period))
    assert all(y <= b for y, b in zip(met, most, strict=True)), (met, most)
    assert max(y / b for y, b in zip(met, most, strict=True)) > 0.33


def test_the_longer_between_samples_the_wider_until_the_step_of_the_proof_gives_none():
    widths = [of("usv", spans)[2] for spans in (0.5, 0.8, 1.0, 1.25)]
    assert all(a < b for pair in pairwise(widths[:3]) for a, b in zip(*pair, strict=True))
    assert widths[3] is None


def test_inner_steps_grow_with_their_length_more_than_in_proportion():
    """What the proof uses: M - I and d of a part of a step are at most that part of those of the whole."""
    c, force, _ = of("usv", 1.0)
    whole = inner(c.plant, c.inner)
    for share in (0.1, 0.5, 0.9):
        one, some = InnerStep(whole), InnerStep(c.plant.at_period(share * whole.h))
        for i in FOUR:
            for j in FOUR:
                assert some.M[i][j] - (i == j) <= share * (one.M[i][j] - (i == j)) * (1.0 + 1e-12)
        far = way(c.plant, force)[2]
        for a_part, all_of_it in zip(some.pushes(force, far), one.pushes(force, far), strict=True):
            assert a_part <= share * all_of_it * (1.0 + 1e-12)
