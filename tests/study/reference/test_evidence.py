"""The linear algebra of the diagnosis against itself, done the long way."""

from dataclasses import replace

import numpy as np
import pytest

from twin.study.estimation.box import stopped
from twin.study.estimation.columns import Unknown
from twin.study.reference.evidence import (
    SPIKE,
    Reduced,
    boxed,
    given,
    log_evidence,
    posterior,
    sized,
    weigh_sets,
    weigh_with,
)
from twin.study.reference.inside_box import log_shares_inside

SETS = [("A",), ("B",), ("C",), ("A", "B"), ("A", "C"), ("B", "C")]


def unknowns():
    """Three effects of one, two and one parameters; the last has one sign."""
    return tuple(
        Unknown(owner, name, "-", 0.0, 1.0, lo, 5.0)
        for owner, name, lo in (("A", "a", -5.0), ("B", "b", -5.0), ("B", "c", -5.0), ("C", "d", 0.0))
    )


@pytest.fixture
def reduced():
    rng = np.random.default_rng(3)
    G = rng.normal(size=(40, 4))
    e = G @ np.array([0.0, 1.5, -0.5, 0.0]) + rng.normal(size=40)
    return Reduced(G.T @ G, G.T @ e, -0.5 * float(e @ e), unknowns(), np.zeros(4))


def test_low_rank_steps_give_the_evidence_of_the_whole_posterior(reduced):
    for chosen, value in weigh_sets(reduced, SETS):
        direct = log_evidence(reduced, chosen, posterior(reduced, chosen))
        assert value == pytest.approx(direct, abs=1e-8), chosen


def test_the_same_where_any_day_brings_some_of_an_effect(reduced):
    """B is no spike but half as wide as when it is there: then it takes some of the credit also when it is
    not."""
    usual = replace(reduced, spike=np.array([SPIKE, 0.5, 0.5, SPIKE]))
    for chosen, value in weigh_sets(usual, SETS):
        assert value == pytest.approx(log_evidence(usual, chosen, posterior(usual, chosen)), abs=1e-8), chosen
    odds = [dict(weigh_sets(r, SETS)) for r in (reduced, usual)]
    assert odds[1][("B",)] - odds[1][()] < 0.2 * (odds[0][("B",)] - odds[0][()])


def test_the_set_that_made_the_data_has_the_most_evidence(reduced):
    best = max(weigh_sets(reduced, SETS), key=lambda item: item[1])
    assert best[0] == ("B",)


def test_evidence_does_not_depend_on_where_the_equations_were_linearised(reduced):
    """The same quadratic about another point: e' = e - G at, and the prior still centred on nothing."""
    at = np.array([0.0, 1.2, -0.3, 0.0])
    moved = Reduced(
        reduced.A,
        reduced.b - reduced.A @ at,
        reduced.base + float(reduced.b @ at) - 0.5 * float(at @ reduced.A @ at),
        unknowns(),
        at,
    )
    here, there = posterior(reduced, ("B",)), posterior(moved, ("B",))
    np.testing.assert_allclose(here.z, there.z, atol=1e-10)
    assert here.log_evidence == pytest.approx(there.log_evidence, abs=1e-8)


def test_an_effect_of_the_wrong_sign_is_not_believed(reduced):
    wrong = Reduced(reduced.A, np.array([0.0, 0.0, 0.0, -60.0]), reduced.base, unknowns(), np.zeros(4))
    found = dict(weigh_sets(wrong, SETS))
    assert found[("C",)] < found[()] + 1.0


def test_one_effect_more_beside_those_found_gives_the_evidence_of_the_whole_posterior(reduced):
    at = np.array([0.0, 1.2, -0.3, 0.0])
    moved = Reduced(reduced.A, reduced.b - reduced.A @ at, reduced.base, unknowns(), at)
    for name, value in weigh_with(moved, ("B",), ["A", "B", "C"]):
        both = tuple(sorted(("B", name)))
        assert value == pytest.approx(log_evidence(moved, both, posterior(moved, both)), abs=1e-8), name
    assert [name for name, _ in weigh_with(moved, ("B",), ["A", "B", "C"])] == ["A", "C"]


def test_what_is_left_given_some_values_is_the_whole_posterior_conditioned_on_them(reduced):
    at, known, z = (
        np.array([0.3, 1.2, -0.3, 0.1]),
        np.array([False, True, False, False]),
        np.array([0.0, 0.7, 0.0, 0.0]),
    )
    moved = Reduced(reduced.A, reduced.b - reduced.A @ at, reduced.base, unknowns(), at)
    whole, left = posterior(moved, ("A", "B")), posterior(given(moved, z, known), ("A", "B"))
    along = whole.covariance[~known][:, known] / whole.covariance[known][:, known]
    np.testing.assert_allclose(
        left.z, whole.z[~known] + along[:, 0] * (z[known] - whole.z[known]), atol=1e-10
    )
    assert np.abs(left.z - whole.z[~known]).max() > 0.01


@pytest.mark.parametrize("pull", [(2.0, -2.0), (1.0, -4.0), (3.0, 1.0), (-0.5, -0.5)])
def test_of_two_numbers_that_do_for_each_other_none_stands_outside_its_box_for_the_other(pull):
    """Test: two numbers from 0 to 5 that work alike, of which the readings would have one far out and the
    other as far below nothing.
    Expected: the most probable place, and the evidence, that a fine grid over the box finds (within a tenth
        of what leaving the box cost)."""
    own = (Unknown("A", "a", "-", 0.0, 1.0, 0.0, 5.0), Unknown("A", "b", "-", 0.0, 1.0, 0.0, 5.0))
    A = 40.0 * np.array([[1.0, 0.95], [0.95, 1.0]])
    reduced = Reduced(A, A @ np.array(pull), 0.0, own, np.zeros(2))
    found = posterior(reduced, ("A",))
    grid = np.linspace(0.0, 5.0, 2001)
    a, b = np.meshgrid(grid, grid, indexing="ij")
    log_density = (
        a * reduced.b[0]
        + b * reduced.b[1]
        - 0.5 * (A[0, 0] * a**2 + 2.0 * A[0, 1] * a * b + A[1, 1] * b**2)
        - 0.5 * (a**2 + b**2)
    )
    top = np.unravel_index(np.argmax(log_density), log_density.shape)
    np.testing.assert_allclose(boxed(reduced, ("A",), found).z, [a[top], b[top]], atol=5e-3)
    weight = np.exp(log_density - log_density.max())
    edges = np.where((grid == 0.0) | (grid == 5.0), 0.5, 1.0)
    mass = float(edges @ weight @ edges) * (grid[1] - grid[0]) ** 2
    exact = np.log(mass) + log_density.max() - np.log(2.0 * np.pi) + 2.0 * np.log(2.0)  # half-normal priors
    cost = found.log_evidence + 2.0 * np.log(2.0) - exact
    assert log_evidence(reduced, ("A",), found) == pytest.approx(exact, abs=max(0.1, 0.1 * cost))


def test_what_stands_at_the_edge_of_its_box_stands_there_to_the_last_digit():
    """Test: three numbers, two of them pulled below nothing. Expected: exactly nothing (0.4e-15 before), for
    an effect that ended there is none."""
    numbers = tuple(Unknown("A", name, "", 0.0, 1.0, 0.0, 10.0) for name in "abc")
    A = np.array([[54.0, -19.5, -16.5], [-19.5, 21.9, 18.4], [-16.5, 18.4, 23.0]])
    reduced = Reduced(A, np.array([14.0, -24.0, -13.0]), 0.0, numbers, np.zeros(3))
    z = boxed(reduced, ("A",), posterior(reduced, ("A",))).z
    assert z[0] > 0.2 and z[1] == z[2] == 0.0


def test_many_sets_side_by_side_have_each_the_evidence_that_it_has_alone():
    """Test: thirty densities of five numbers, some of which one to five would leave their box. Expected: to
    the last digits that of each by itself, whatever stands beside it."""
    rng = np.random.default_rng(5)
    G = rng.normal(size=(30, 9, 5))
    covariance = np.linalg.inv(G.swapaxes(-1, -2) @ G)
    mean, lo, hi = rng.normal(size=(30, 5)), np.full((30, 5), -0.5), np.full((30, 5), 3.0)
    together = log_shares_inside(mean, covariance, lo, hi)
    alone = [log_shares_inside(*(x[i : i + 1] for x in (mean, covariance, lo, hi)))[0] for i in range(30)]
    np.testing.assert_allclose(together, alone, rtol=1e-12)
    edges = {stopped(*(x[i] for x in (mean, covariance, lo, hi)))[1].size for i in range(30)}
    assert len(edges) > 3 and np.ptp(together) > 1.0


def test_a_size_far_beyond_what_is_usual_is_not_drawn_back_to_it():
    """Test: twenty readings of scatter 3 of a number that is 6 prior widths. Expected: by the prior alone 6 / (1 +
    9/20) = 4.14, and so three deviations short of the truth; with the width that it asks for within a tenth of 6,
    and no surer than the readings are."""
    one = (Unknown("A", "a", "-", 0.0, 1.0, -50.0, 50.0),)
    far = Reduced(np.array([[20.0 / 9.0]]), np.array([6.0 * 20.0 / 9.0]), 0.0, one, np.zeros(1))
    usual, asked = posterior(far, ("A",)), sized(far, ("A",))
    assert usual.z[0] == pytest.approx(4.14, abs=0.01)
    assert asked.z[0] == pytest.approx(6.0, rel=0.1)
    assert usual.covariance[0, 0] < asked.covariance[0, 0] < 9.0 / 20.0


def test_a_usual_size_stays_as_its_prior_has_it(reduced):
    near = replace(reduced, b=0.2 * reduced.b)
    usual, asked = posterior(near, ("A",)), sized(near, ("A",))
    np.testing.assert_array_equal(asked.z, usual.z)
    np.testing.assert_array_equal(asked.covariance, usual.covariance)
