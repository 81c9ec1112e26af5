"""The attack on the certificate: it holds inside, breaks outside, and does more than chance."""

from dataclasses import replace

import numpy as np
import pytest

from bench.stability.attack.adversary_search import GREEDY, PASSES, RANDOM, STEEPEST, attack, horizon
from bench.stability.attack.bounds import bounds
from bench.stability.attack.cases import (
    FULL_RUN,
    INSIDE,
    MIXED_GROUPS,
    AttackCase,
    Excess,
    Group,
    certified_for,
)
from bench.stability.attack.orders import ages_of, random_orders
from bench.stability.attack.run_batch import sail
from bench.stability.attack.section import HEAD, section_of, with_section
from bench.stability.attack.waters import Waters
from tests.thorough import one_of
from twin.live.certificate.observer_tube import Tube

CONTAINER, BOAT, ROLLED = (
    AttackCase("container", 10.0, 1),
    AttackCase("usv", 50.0, 1),
    AttackCase("usv", 20.0),
)
OLDEST = Group(1.0)


def batch(case, *groups, runs=6, ticks=12):
    model, c = certified_for(case)
    w = Waters(model, c, groups, runs, ticks, 1)
    return w, random_orders(c, w.groups, runs, ticks, np.random.default_rng(1))


@pytest.mark.parametrize("case", [CONTAINER, ROLLED])
def test_no_adversary_breaks_the_bound_inside_the_assumptions(case):
    found = attack(case, 300, 3, INSIDE)
    assert [g.violations for g in found.groups] == [0] * len(INSIDE)
    assert all(g.samples > 0 and 0.2 < g.of_tube.max() <= 1.0 for g in found.groups)
    assert all(g.of_bound.max() <= 1.0 for g in found.groups)


@pytest.mark.parametrize("case", one_of([ROLLED, AttackCase("kvlcc2_model", 10.0)]))
def test_samples_of_different_ages_break_neither_the_live_bound_nor_the_one_of_any_ages(case):
    found = attack(case, 600, 3, MIXED_GROUPS).groups
    assert [g.violations for g in found] == [0] * len(MIXED_GROUPS)
    assert all(g.bound and 0.2 < g.of_bound.max() <= 1.0 and g.of_tube.max() > 0.7 for g in found)


def test_the_adversary_beats_as_many_random_runs_clearly_on_every_axis():
    runs = 60 * len(PASSES)
    hostile, chance = (attack(CONTAINER, runs, 4, (OLDEST,), p) for p in (PASSES, (RANDOM,) * len(PASSES)))
    gain = hostile.groups[0].of_bound / chance.groups[0].of_bound
    assert hostile.groups[0].runs == chance.groups[0].runs == runs
    assert gain[0] > 1.05 and gain[1] > 1.15 and gain[2] > 1.3, gain


def test_the_way_along_the_adjoint_finds_more_than_pushing_the_way_the_error_has():
    by_pass = attack(BOAT, 300, 5, (OLDEST,)).groups[0].by_pass
    assert by_pass[STEEPEST][2] > 1.2 * by_pass[GREEDY][2]


@pytest.mark.parametrize("case", [CONTAINER, ROLLED])
def test_instruments_twice_as_wrong_as_stated_break_the_bound(case):
    inside, outside = attack(case, 120, 6, (OLDEST, Group(1.0, excess=Excess(noise=2.0)))).groups
    assert inside.violations == 0 and outside.violations > 0
    assert "run" in outside.first and not inside.first


def test_twice_any_limit_brings_the_error_nearer_to_the_bound_than_the_limit_does():
    groups = (OLDEST, *(Group(1.0, excess=Excess()._replace(**{name: 2.0})) for name in Excess._fields))
    inside, *outside = attack(BOAT, 450, 7, groups).groups
    assert all((g.of_bound / inside.of_bound).max() > 1.05 for g in outside)


@pytest.mark.parametrize("case", [CONTAINER, ROLLED])
def test_an_observer_that_nothing_disturbs_stays_on_the_ship(case):
    w, orders = batch(case, OLDEST)
    calm = replace(orders, start=0.0 * orders.start, force=0.0 * orders.force, noise=0.0 * orders.noise)
    sailed = sail(w, calm)
    error = np.abs(sailed.error) / np.array([*w.c.bound, 1.0])[:, None]
    assert sailed.inside.any(axis=0).any() and np.where(sailed.inside[:, None], error, 0.0).max() < 0.03


def test_the_bound_of_full_ticks_is_that_of_the_loops_own_tube():
    w, _ = batch(CONTAINER, OLDEST, Group(0.5))
    tube, told = Tube(w.c), bounds(w)
    for k in range(w.ticks):
        beta = tube.step((True, True, True))
        assert told[k + 1, :3, 0] == pytest.approx(beta) and told[k + 1, :3, -1] == pytest.approx(beta)


def test_ages_stay_within_what_a_group_is_allowed():
    c = certified_for(AttackCase("container", 10.0))[1]
    most = max(c.delays)
    assert ages_of(c, Group(0.0)).tolist() == [0.0]
    assert max(ages_of(c, Group(0.5))) == 0.5 * most and max(ages_of(c, OLDEST)) == most
    assert max(ages_of(c, Group(1.0, FULL_RUN, Excess(delay=1.5)))) == 1.5 * most
    assert horizon(c) * c.h * c.K[0] > 2.0


def test_each_part_of_the_page_leaves_the_others_as_it_was(tmp_path):
    page = tmp_path / "stability.md"
    page.write_text("# Runs\n\nnumbers\n")
    once = with_section(page, f"{HEAD}\n\nfirst\n")
    page.write_text(once)
    assert once == f"# Runs\n\nnumbers\n\n{HEAD}\n\nfirst\n"
    assert with_section(page, f"{HEAD}\n\nsecond\n") == f"# Runs\n\nnumbers\n\n{HEAD}\n\nsecond\n"
    assert section_of(page) == f"\n{HEAD}\n\nfirst\n" and section_of(None) == ""
