"""What differs from voyage to voyage, on voyages that are drawn from known ships."""

import numpy as np
import pytest

from twin.study.estimation.columns import Unknown
from twin.study.estimation.innovations import Normal
from twin.study.reference.between import SHARES, BetweenVoyages, doubted, scattered, ship_of
from twin.study.reference.nuisance import of_any_day, temper_of

P, SAID = 6, 400.0  # numbers, and how much a voyage says of each (in priors)


def fleet(scatter, voyages, seed):
    """Voyages of one ship whose numbers are scattered about hers by `scatter` (P,) prior widths."""
    rng = np.random.default_rng(seed)
    lasting_ones, out = rng.standard_normal(P), []
    for _ in range(voyages):
        root = rng.standard_normal((3 * P, P)) * np.sqrt(SAID / (3 * P))
        e = root @ (lasting_ones + scatter * rng.standard_normal(P)) + rng.standard_normal(3 * P)
        out.append(BetweenVoyages(root.T @ root, root.T @ e, float(e @ e)))
    return lasting_ones, out


@pytest.mark.parametrize("seed", range(5))
def test_voyages_of_one_ship_do_not_differ(seed):
    _, told = fleet(np.zeros(P), 6, seed)
    assert scattered(told, np.zeros(P)).max() < 0.05**2


@pytest.mark.parametrize("seed", range(5))
def test_the_number_that_differs_is_found_and_no_other(seed):
    scatter = np.zeros(P)
    scatter[2] = 0.8
    found = scattered(fleet(scatter, 8, seed)[1], np.zeros(P))
    assert np.flatnonzero(found > SHARES[0] ** 2).tolist() == [2]
    assert 0.3 < np.sqrt(found[2]) < 1.7


def test_a_single_voyage_says_nothing_of_the_next():
    assert not scattered(fleet(np.ones(P), 1, 0)[1], np.zeros(P)).any()


def test_numbers_differ_by_what_is_usual_until_voyages_show_more():
    """Test: one or two voyages that agree, and eight of which one number differs. Expected: what is usual stands
    for all but that one."""
    usual = np.full(P, 0.1**2)
    for voyages in (1, 2):
        found = scattered(fleet(np.zeros(P), voyages, 3)[1], np.zeros(P), usual)
        np.testing.assert_allclose(found, usual, rtol=0.05)
    scatter = np.zeros(P)
    scatter[2] = 0.8
    found = scattered(fleet(scatter, 8, 1)[1], np.zeros(P), usual)
    assert 0.3**2 < found[2] < 1.7**2
    np.testing.assert_allclose(np.delete(found, 2), np.delete(usual, 2), rtol=0.05)


def test_a_number_that_may_differ_counts_by_how_likely_that_is():
    """Test: four voyages of which the third number differs, and of which more and more is said. Expected: its
    variance grows from next to nothing to the one that is proved, without a step of more than half of that."""
    scatter, found = np.where(np.arange(P) == 2, 0.2, 0.0), []
    for said in np.geomspace(0.1, 8.0, 25):
        told = [BetweenVoyages(said * t.A, said * t.b, said * t.ee) for t in fleet(scatter, 4, 0)[1]]
        found.append(float(scattered(told, np.zeros(P))[2]))
    steps = np.diff(found) / found[-1]
    assert found[0] < 0.01 * found[-1] and steps.min() > -0.01 and steps.max() < 0.5


def test_an_age_differs_by_what_the_voyages_leave_likely():
    """Test: no voyage, eight of which nothing differs, and eight of which the third number does; asked of the third
    and the fourth number. Expected: without a voyage the mean of what is tried; next to nothing where they agree; its
    size where they differ; all other numbers as is usual."""
    usual, asked_of = np.full(P, 0.1**2), np.arange(P) == 2
    none, scatter = np.zeros(P), 0.8 * asked_of
    assert doubted([], none, usual, asked_of)[2] == pytest.approx(
        sum(s**2 for s in SHARES) / (1 + len(SHARES))
    )
    alike, apart = (doubted(fleet(s, 8, 1)[1], none, usual, asked_of) for s in (none, scatter))
    assert np.sqrt(alike[2]) < 0.15
    assert 0.5 < np.sqrt(apart[2]) < 1.3
    assert np.delete(apart, 2).tolist() == np.delete(usual, 2).tolist()


def test_the_ships_own_numbers_are_known_no_better_than_their_scatter_over_the_voyages():
    scatter = np.full(P, 0.5)
    lasting_ones, told = fleet(scatter, 8, 1)
    mean, covariance = ship_of(told, scatter**2, np.zeros(P))
    sd = np.sqrt(np.diag(covariance))
    assert (sd > 0.4 * 0.5 / np.sqrt(8)).all() and (np.abs(mean - lasting_ones) < 3.5 * sd).all()
    sure = np.sqrt(np.diag(ship_of(told, np.zeros(P), np.zeros(P))[1]))
    assert (sd > 4.0 * sure).all()


def test_log_probability_is_that_of_the_readings_with_the_numbers_integrated_out():
    rng = np.random.default_rng(3)
    root, e = rng.standard_normal((9, P)), rng.standard_normal(9)
    mean, square = rng.standard_normal(P), rng.standard_normal((P, P))
    covariance = square @ square.T
    spread = root @ covariance @ root.T + np.eye(9)
    off = e - root @ mean
    straight = -0.5 * (off @ np.linalg.solve(spread, off) + np.linalg.slogdet(spread)[1])
    assert BetweenVoyages(root.T @ root, root.T @ e, float(e @ e)).log_probability(
        mean, covariance
    ) == pytest.approx(straight)


def test_its_slope_by_each_variance_is_the_difference_quotient():
    rng = np.random.default_rng(4)
    root, e = rng.standard_normal((9, P)), rng.standard_normal(9)
    told, mean, covariance = (
        BetweenVoyages(root.T @ root, root.T @ e, float(e @ e)),
        rng.standard_normal(P),
        0.3 * np.eye(P),
    )
    slope, _ = told.score(mean, covariance)
    for i in range(P):
        up, down = (covariance + s * 1e-5 * np.diag(np.eye(P)[i]) for s in (1.0, -1.0))
        assert (told.log_probability(mean, up) - told.log_probability(mean, down)) / 2e-5 == pytest.approx(
            slope[i], rel=1e-4
        )


def segments_of(truth, spread, seed=0, count=40):
    """Normal equations of segments that all know the same numbers, scattered by `spread` times what white
    readings would."""
    rng = np.random.default_rng(seed)
    A, b = [], []
    for _ in range(count):
        root = rng.standard_normal((4 * P, P)) * np.sqrt(SAID / (4 * P))
        e = root @ truth + np.sqrt(spread) * rng.standard_normal(4 * P)
        A.append(root.T @ root)
        b.append(root.T @ e)
    none = np.zeros(count)
    return Normal(np.array(A), np.array(b), none, none, none, np.zeros((count, 8)), ((0, 0, 1),) * count)


def test_what_the_unknowns_explain_tempers_nothing_and_what_they_cannot_does():
    unknowns = [Unknown("core", str(i), "", 0.0, 1.0, -9.0, 9.0) for i in range(P)]
    told = {spread: temper_of(segments_of(np.full(P, 2.0), spread), unknowns) for spread in (1.0, 4.0)}
    assert told[1.0] == 1.5  # as little as it ever is
    assert told[4.0] == pytest.approx(4.0, rel=0.3)


def test_what_any_day_brings_is_as_much_as_the_days_had_whatever_its_direction():
    named = [
        ("core", "X_uu"),
        ("Current", "north"),
        ("Current", "east"),
        ("ExternalForce", "north"),
        ("ExternalForce", "turn_north"),
    ]
    unknowns = [
        Unknown(owner, name, "", 0.0, 1.0, -9.0, 9.0, every_day=name in ("north", "east"))
        for owner, name in named
    ]
    much = of_any_day(np.array([1.0, 2.0, -3.0, 0.5, 7.0]), np.array([0.1, 0.6, 0.8, 0.75, 9.0]), unknowns)
    stream = np.sqrt(0.5 * ((0.6 + 2.0**2) + (0.8 + 3.0**2)))
    np.testing.assert_allclose(much, [0.0, stream, stream, 1.0, 0.0])
