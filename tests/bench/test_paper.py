"""The paper's tables: voyages, filters, intervals and the page, in small."""

from dataclasses import replace

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed: pip install 'shiptwin[train]'")
pytest.importorskip("filterpy", reason="filterpy is not installed: pip install 'shiptwin[dev]'")

from bench import paper_ekf, paper_sea, paper_stats  # noqa: E402
from bench.paper_lab import course, free, judge  # noqa: E402
from bench.paper_ship import OFF, nominal  # noqa: E402
from twin.physics.model import Model  # noqa: E402


@pytest.fixture(scope="module")
def calm(tmp_path_factory):
    cases = [replace(c, duration_s=700.0) for c in paper_sea.zigzags(1, 5, ("TS-01",))]
    (sailed, _) = paper_sea.sail(cases, tmp_path_factory.mktemp("sea"), lambda text: None, tick_s=0.5)
    return course(sailed, nominal())


def test_the_paper_sails_648_000_samples():
    cases = paper_sea.lessons(paper_sea.FULL)
    assert sum(c.duration_s for c in cases) * 10 == 648_000
    assert [c.weather for c in cases[:4]] == ["TS-01", "TS-02", "TS-03", "TS-01"]


def test_what_is_learned_from_and_what_is_judged_on_have_no_seed_in_common():
    plan = paper_sea.FULL
    judged = [c for cases in (paper_sea.changed(plan) | paper_sea.by_speed(plan)).values() for c in cases]
    judged += paper_sea.zigzags(plan.zigzags, 9001)
    assert not {c.seed for c in paper_sea.lessons(plan)} & {c.seed for c in judged}


def test_the_nominal_is_wrong_by_what_literature_is_wrong_by():
    assert all(0.03 < abs(factor - 1.0) <= 0.2 for factor in OFF.values())


def test_a_free_run_of_the_nominal_ship_is_off_by_degrees_not_by_radians(calm):
    e = judge(free(Model(nominal()), None, [calm]), [calm])
    assert e.heading.shape == (5, calm.steps)
    assert 0.1 < e.heading_deg.mean() < 10.0 and 0.1 < e.lateral_m.mean() < 40.0


def test_the_truth_itself_has_no_error(calm):
    run = calm.truth[calm.at][1:]
    e = judge([run], [calm])
    assert np.abs(e.heading).max() == 0.0 and paper_stats.summary(e)["r2_lateral"] == 1.0


def test_the_filter_begins_where_the_ship_is(calm):
    """Expected: place within a metre or two, heading within half a degree, at every start."""
    state = paper_ekf.filtered(calm, Model(nominal()), 1e-5)
    off = state[:, :6] - calm.water.state[calm.starts]
    assert np.abs(off[:, :2]).max() < 2.0 and np.degrees(np.abs(off[:, 2])).max() < 0.5


def test_blocks_widen_an_interval_that_single_errors_make_too_narrow():
    """Test: ten voyages of five equal errors. Expected: the interval by voyages more than twice as wide."""
    values = np.repeat(np.random.default_rng(1).standard_normal(10), 5)
    (a, b), (c, d) = (paper_stats.bootstrap(values, g, 2000) for g in (np.repeat(np.arange(10), 5), np.arange(50)))
    assert b - a > 1.8 * (d - c)


def test_cliffs_delta_by_hand():
    """(1, 2) against (2, 3): of four pairs three are greater and one is a tie."""
    assert paper_stats.cliff(np.array([1.0, 2.0]), np.array([2.0, 3.0])) == 0.75
