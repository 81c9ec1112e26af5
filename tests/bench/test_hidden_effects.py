"""The league: its plan, its scores by hand, and three short voyages through the whole of it."""

import json
from collections import Counter

import pytest

from bench.cli import main
from bench.league import league_score, league_tables, plan
from bench.league.page import page
from bench.league.truth import TABLE, beside
from bench.reference.hidden_catalogue import CATALOGUE, prepare
from bench.reference.hulls import HULLS
from bench.reference.weather import CALM
from tests.thorough import thorough
from twin.physics.effects import catalogue, find

KEYS = {
    "schema_version",
    "cases",
    "named",
    "named_in_group",
    "false_alarms",
    "nothing_cases",
    "unknown_recognised",
    "unknown_cases",
    "pairs_found",
    "pair_cases",
    "coverage95",
    "error_after_over_oracle",
    "seconds_median",
    "effects",
}
OF_EFFECT = {"cases", "named", "named_in_group", "error_before_m", "error_after_m", "error_oracle_m"}


def row(kind="effect", hidden=("Wind",), missing=("Wind",), verdict=None, group=(), **more):
    truly = hidden if kind in ("effect", "pair") else ()
    said = verdict or ("missing" if missing else "nothing_missing")
    return {
        "kind": kind,
        "hidden": dict.fromkeys(hidden, 1.0),
        "missing_truly": list(truly),
        "missing": list(missing),
        "verdict": said,
        "group": list(group),
        "hull": "kvlcc2",
        "manoeuvre": "mixed",
        "seed": 1,
        "known": [],
        "decoys": [],
        "duration_s": 1800.0,
        "seconds": 8.0,
        "cpu_seconds": 4.0,
        "key": "k",
        **more,
    }


def test_every_round_hides_every_effect_on_every_hull_at_every_strength():
    (first, second) = plan.questions(plan.HULLS, 2, plan.STRENGTHS)
    hidden = Counter((q.hull, q.hidden[0]) for q in first if q.kind == "effect")
    assert len(hidden) == len(plan.HULLS) * len(CATALOGUE) * 2 and set(hidden.values()) == {1}
    assert Counter(q.kind for q in first) == Counter(q.kind for q in second)


def test_no_two_questions_are_the_same():
    keys = [q.key for r in plan.questions(plan.HULLS, 5, plan.STRENGTHS) for q in r]
    assert len(set(keys)) == len(keys)


def test_other_seeds_ask_the_same_kinds_of_questions_on_other_voyages():
    first, sixth = (plan.questions(["usv"], 1, [1.0], first_seed=seed)[0] for seed in (1, 6))
    assert {q.seed % 50 for q in sixth} == {6} and {q.seed % 50 for q in first} == {1}
    assert {q.kind for q in first} == {q.kind for q in sixth} and not {q.key for q in first} & {
        q.key for q in sixth
    }


def test_the_held_out_voyage_is_another_manoeuvre_of_the_same_ship():
    for q in plan.questions(["usv"], 1, [1.0])[0]:
        if q.proves:
            sailed, other = q.voyages()
            assert (sailed.hidden, sailed.seed) == (
                other.hidden,
                other.seed,
            ) and sailed.manoeuvre != other.manoeuvre


def test_every_compared_number_is_one_of_the_catalogue_and_of_the_sea():
    for c in TABLE:
        assert c.parameter in {p.name for p in find(c.effect).params()}
        truth = prepare(HULLS["kvlcc2"], CALM, ((c.effect, 1.0),), (), 1)[3][c.effect]
        assert c.size(truth) > 0.0 and abs(c.of(truth)) <= c.size(truth) * (1 + 1e-12)


def test_the_league_hides_what_a_diagnosis_looks_for_by_itself():
    asked = {name for name, effect in catalogue().items() if not effect.kinematic}
    assert set(CATALOGUE) == asked


def test_a_number_beside_its_truth_by_hand():
    given = [{"name": "north", "value": 0.5, "low95": 0.4, "high95": 0.6, "unit": "m/s"}]
    (found,) = beside("Current", given, {"north_mps": 0.3, "east_mps": 0.4})
    assert found["error"] == pytest.approx(0.4) and found["covered"] is False


def test_scores_by_hand():
    rows = [
        row(before=4.0, after=2.0, oracle=1.0),
        row(missing=["Bank"], group=["Wind"], before=4.0, after=4.0, oracle=2.0),
        row(missing=["Bank"]),
        row(missing=[]),
        row("none", (), []),
        row("decoy", (), ["Wind"]),
        row("outside", ("Squall",), [], "unknown"),
        row("outside", ("Squall",), [], "nothing_missing"),
        row("pair", ("Wind", "Bank"), ["Bank", "Wind"]),
        row("pair", ("Wind", "Bank"), ["Wind"]),
    ]
    found = league_score.contract(rows)
    assert (found["cases"], found["named"], found["named_in_group"]) == (10, 0.25, 0.5)
    assert (found["false_alarms"], found["nothing_cases"]) == (0.5, 2)
    assert (found["unknown_recognised"], found["pairs_found"]) == (0.5, 0.5)
    assert found["error_after_over_oracle"] == pytest.approx(2.0)
    assert league_score.confusion(league_score.of_kind(rows, "effect")) == {"Bank": 2, "nothing_missing": 1}


def test_effects_that_the_true_one_mends_little_are_counted_apart():
    visible = row(hidden=("Wind",), before=10.0, oracle=4.0, after=4.0)
    hardly = row(hidden=("Wind",), missing=(), before=10.0, oracle=9.9, after=10.0)
    log = row(hidden=("SpeedLogBias",), missing=("SpeedLogBias",), before=10.0, oracle=10.0, after=10.0)
    lines = league_tables.gain([visible, hardly, log]).splitlines()
    assert "| less than 5 % | 1 | 0 % |" in lines[-2] and "| more | 1 | 100 % |" in lines[-1]


def test_an_answer_that_failed_is_an_alarm_and_not_a_name():
    failed = row("none", (), [], "failed", why="x")
    assert league_score.alarm(failed) and not league_score.named(row(missing=[], verdict="failed"))


@thorough
def test_three_short_voyages_go_through_the_whole_league(tmp_path, capsys):
    options = [
        "--quick",
        "--effect",
        "Current",
        "--duration",
        "300",
        "--references",
        "2",
        "--jobs",
        "1",
        "--kind",
        "effect",
        "none",
        "outside",
    ]
    out = tmp_path / "league.md"
    assert (
        main(["hidden-effects", *options, "--resume", str(tmp_path / "r"), "--out", str(out), "--json", "-"])
        == 0
    )
    result = json.loads(capsys.readouterr().out)
    assert set(result) >= KEYS and set(result["effects"]["Current"]) == OF_EFFECT
    assert (result["cases"], result["nothing_cases"], result["unknown_cases"]) == (3, 1, 1)
    assert result["run"]["failed"] == 0 and result["seconds_median"] > 0.0
    assert json.loads(out.with_suffix(".json").read_text())["cases"] == 3
    assert "| Current | 1 |" in out.read_text()
    assert not list((tmp_path / "r").glob("*.npz")), "voyages are forgotten when they are judged"
    assert len((tmp_path / "r" / "answers.jsonl").read_text().splitlines()) == 3


def test_the_page_stands_without_a_single_answer():
    run = {"command": "x", "answered": 0, "planned": 0, "seeds": [], "hulls": [], "strengths": []}
    assert "# The hidden-effect league" in page([], league_score.contract([]) | {"run": run}, {})


def test_an_unknown_effect_is_refused_with_the_known_ones(capsys):
    assert main(["hidden-effects", "--effect", "Wnd"]) == 5
    assert "Wnd" in capsys.readouterr().err
