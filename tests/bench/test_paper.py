"""The paper's tables: voyages, filters, intervals and the page, in small."""

import gc
import json
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed: pip install 'shiptwin[train]'")
pytest.importorskip("filterpy", reason="filterpy is not installed: pip install 'shiptwin[dev]'")

from bench.paper import filter as paper_filter  # noqa: E402
from bench.paper import gap as paper_gap  # noqa: E402
from bench.paper import paper_voyages as paper_sea  # noqa: E402
from bench.paper import reproduce as paper  # noqa: E402
from bench.paper import stats as paper_stats  # noqa: E402
from bench.paper import tuned_ekf as paper_ekf  # noqa: E402
from bench.paper.lab import course, free, judge  # noqa: E402
from bench.paper.nominal_ship import OFF, nominal  # noqa: E402
from bench.paper.page import page  # noqa: E402
from export.data import split  # noqa: E402
from tests.thorough import thorough  # noqa: E402
from twin.physics.model import Model  # noqa: E402


@pytest.fixture(scope="module")
def calm(tmp_path_factory):
    cases = [replace(c, duration_s=700.0) for c in paper_sea.zigzags(1, 5, ("TS-01",))]
    (sailed, _) = paper_sea.sail(cases, tmp_path_factory.mktemp("sea"), lambda text: None, tick_s=0.5)
    return course(sailed, nominal())


def test_the_paper_sails_648_000_samples():
    cases = paper_sea.lessons(paper_sea.FULL_PLAN)
    assert sum(c.duration_s for c in cases) * 10 == 648_000
    assert [c.weather for c in cases[:4]] == ["TS-01", "TS-02", "TS-03", "TS-01"]


def test_what_is_learned_from_and_what_is_judged_on_have_no_seed_in_common():
    plan = paper_sea.FULL_PLAN
    judged = [c for cases in (paper_sea.changed(plan) | paper_sea.by_speed(plan)).values() for c in cases]
    judged += paper_sea.unseen(plan)
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
    (a, b), (c, d) = (
        paper_stats.bootstrap(values, g, 2000) for g in (np.repeat(np.arange(10), 5), np.arange(50))
    )
    assert b - a > 1.8 * (d - c)


def test_cliffs_delta_by_hand():
    """(1, 2) against (2, 3): of four pairs three are greater and one is a tie."""
    assert paper_stats.cliff(np.array([1.0, 2.0]), np.array([2.0, 3.0])) == 0.75


def test_the_hybrids_filter_knows_where_she_is_and_where_the_water_goes(calm):
    """Test: the nominal ship in TS-01, a current of 0.1 m/s. Expected: place within two metres at every
    start, current within 0.1 m/s, heading within half a degree, and uncertainties that are neither nothing
    nor boundless."""
    one = paper_filter.Filter([calm], Model(nominal()), None, [paper_filter.Tuning()])
    state = one.run(int(calm.starts[-1]))[calm.starts, 0]
    truth = calm.truth[calm.starts]
    assert (
        np.abs(state[:, :2] - truth[:, :2]).max() < 2.0
        and np.degrees(np.abs(state[:, 2] - truth[:, 2])).max() < 0.5
    )
    assert np.abs(state[:, 6:8] - calm.water.water[calm.starts]).max() < 0.1
    sigma = np.sqrt(np.diagonal(one.P[0]))
    assert (sigma > 0).all() and sigma[0] < 1.0 and sigma[3] < 0.1


def test_many_filters_side_by_side_say_what_each_says_alone(calm):
    model, tunings = Model(nominal()), [paper_filter.Tuning(), paper_filter.Tuning(1e-4, 1e-6, 1.0)]
    both = paper_filter.Filter([calm, calm], model, None, tunings).run(60)
    for i, t in enumerate(tunings):
        alone = paper_filter.Filter([calm], model, None, [t]).run(60)
        assert np.allclose(both[:, i], alone[:, 0], atol=1e-9)


def test_free_runs_over_ground_begin_where_the_filter_is(calm):
    """Test: a filter's state that is the truth, but for a current that is 1 m/s too far north. Expected: a
    metre north for each second."""
    state = np.concatenate(
        [calm.water.state[calm.starts], calm.water.water[calm.starts], np.zeros((5, 3))], 1
    )
    state[:, :2] = calm.earth.state[calm.starts, :2]
    model = Model(nominal())
    (there,) = paper_filter.from_states([calm], model, None, [state])
    state[:, paper_filter.NORTH] += 1.0
    (north,) = paper_filter.from_states([calm], model, None, [state])
    seconds = calm.water.t[calm.at[-1, 0]] - calm.water.t[calm.at[0, 0]]
    assert np.allclose(north[-1, :, 0] - there[-1, :, 0], seconds, atol=1e-3) and np.allclose(
        north[..., 1:], there[..., 1:]
    )
    assert np.allclose(there, free(model, None, [calm])[0], atol=1e-3)


def test_without_gnss_noise_the_place_is_the_truth_of_a_moment_ago(tmp_path):
    (sailed,) = paper_sea.sail(
        [replace(paper_sea.zigzags(1, 5, ("TS-02",))[0], duration_s=60.0)], tmp_path, lambda text: None
    )
    exact = paper_sea.without_gnss_noise(sailed).voyage
    seen = np.isfinite(sailed.voyage.columns["north_m"])
    assert np.array_equal(np.isfinite(exact.columns["north_m"]), seen)
    off = exact.columns["north_m"][seen][1:] - sailed.truth[np.flatnonzero(seen)[1:] - 1, 0]
    assert np.abs(off).max() < 1e-6
    assert 0.2 < np.std(exact.columns["north_m"][seen] - sailed.voyage.columns["north_m"][seen]) < 1.0


def test_validation_and_test_are_as_hard_as_each_other_by_their_plan():
    """Expected: the same manoeuvres, seas and speeds among the runs that say when to stop and those that
    never did, but for the one run more that 72 leave over."""
    parts = split(paper_sea.lessons(paper_sea.FULL_PLAN))
    kinds = {
        n: Counter(x for c in cases for x in (c.manoeuvre, c.weather, c.speed_fraction))
        for n, cases in parts.items()
    }
    assert sum(kinds["validation"].values()) - sum(kinds["test"].values()) == 3
    assert all(0 <= kinds["validation"][kind] - kinds["test"][kind] <= 1 for kind in kinds["train"])


def test_a_gap_between_equal_parts_is_nothing(calm):
    model = Model(nominal())
    found = paper_gap.gap({"nominal": lambda some: free(model, None, some)}, [calm], [calm], 100)["nominal"][
        "heading"
    ]
    assert (
        found["change_percent"] == 0.0 and found["by_voyage_95"] == [0.0, 0.0] and found["validation"] > 0.1
    )


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    """The whole bench with the least of everything: it learns next to nothing, but every table is made."""
    plan = paper_sea.PaperPlan(
        5, 1, 1, 1, (20,), (1,), 1, (42, 123), 2, 1, 64, 1, 200, 0.5, 320.0, (110.0, 150.0, 190.0)
    )
    folder = tmp_path_factory.mktemp("tiny")
    gc.freeze()  # each step that is timed collects first: not all that these tests have loaded
    try:
        return paper.reproduce(plan, folder / "work", True, folder / "figures"), folder
    finally:
        gc.unfreeze()


@thorough
def test_every_table_is_made_and_keeps_the_contract(tiny):
    result, _ = tiny
    assert set(result["tables"]) >= {"3", "4", "5", "6", "7", "8", "fig5", "data", "fig6_ms"}
    three = result["tables"]["3"]
    for measure in ("heading_mae_deg", "lateral_mae_m"):
        assert {"analytic", "ekf", "lstm", "hybrid", "hybrid_adapted", "physics_added", "paper"} <= set(
            three[measure]
        )
    assert set(three["r2"]) >= {"analytic", "hybrid"} and three["seeds"]["count"] == 2
    assert {"heading_vs_analytic", "lateral_vs_analytic", "heading_vs_ekf", "lateral_vs_ekf"} <= set(
        result["ratios"]
    )
    json.dumps(result, allow_nan=False)


@thorough
def test_the_lstm_says_the_same_as_onnx(tiny):
    assert tiny[0]["models"]["lstm"]["torch_onnx_difference"] < 1e-6


@thorough
def test_the_page_has_the_papers_numbers_and_the_figures_are_small(tiny):
    result, folder = tiny
    text = "\n".join(page(result))
    assert all(
        word in text
        for word in (
            "(paper 142.5)",
            "Table 7",
            "Table 8",
            "Fig. 5",
            "learning on",
            "Error over amount of data",
            "fig-5-closed-loop.png",
        )
    )
    assert (
        "| R2 at least 0.96 |" in text
        and ("| 14 x in heading and 12.7 x lateral against the nominal analytic model |") in text
    )
    drawn = sorted(path.name for path in (folder / "figures").iterdir())
    assert [name[:5] for name in drawn] == [f"fig-{k}" for k in range(2, 8)]
    assert all(path.stat().st_size < 150_000 for path in (folder / "figures").iterdir())


@thorough
def test_the_loop_closed_over_the_reference_sea_settles_and_a_hostile_residual_stays_bounded(tiny):
    """Expected: without a residual, settled within six lengths with hardly any overshoot and the rudder far
    from its stop; a hostile one, as strong as its bound allows, cannot turn it round."""
    rows = {(x["mode"], x["scenario"]): x for x in tiny[0]["tables"]["fig5"]}
    assert len(rows) == 9
    for scenario in paper_sea.SCENARIOS:
        alone = rows["analytic alone", scenario]
        assert (
            alone["settle_lengths_max"] < 6.0
            and alone["overshoot_percent"] < 8.0
            and alone["rudder_deg"] < 20.0
        )
        assert rows["with a hostile residual", scenario]["gust_deg"] < 60.0


def test_errors_that_are_the_same_are_not_smaller():
    x = np.array([1.0, 2.0, 3.0, 4.0])
    assert paper_stats.wilcoxon(x, x.copy(), np.array([0, 0, 1, 1])) == (1.0, 1.0)
