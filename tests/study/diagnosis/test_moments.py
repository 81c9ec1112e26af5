"""Moments at which something pushed the ship."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.study.conftest import voyage
from tests.thorough import thorough
from twin.physics.effects import find
from twin.physics.state import Force
from twin.study.diagnosis import moments as moment_of
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.diagnosis.moments import PUSH_LOG_BAYES, Moment, joined, moments, stretches
from twin.study.diagnosis.refine import Found, refine
from twin.study.diagnosis.tell_diagnosis import terminal_lines
from twin.study.estimation.columns import Unknown
from twin.study.reference.evidence import Hypothesis, Nuisance, likeliest, posterior


def as_she_is(case):
    told = posterior(case.reduced(case.lines, case.scenarios(["usual"]))[0], ())
    return Found(Hypothesis((), "usual", told.log_evidence, 0.0), told, case.model)


def test_a_ship_with_which_nothing_is_wrong_had_no_push_of_its_own(case_of):
    case = case_of("nothing")
    asked = stretches(case, as_she_is(case))
    assert max(m.log_evidence for m in asked) < 0.5 * PUSH_LOG_BAYES and moments(case, as_she_is(case)) == []
    assert (
        {m.voyage for m in asked} == {"nothing"}
        and min(m.start_s for m in asked) < 60.0
        and max(m.end_s for m in asked) > 1100.0
    )


def test_a_push_that_goes_on_is_one_and_one_of_another_direction_or_later_is_not():
    """By hand: 60 s at 1 and 30 s at 0.7 are 90 s at 0.9."""

    def push(start, end, *force, voyage="v"):
        return Moment(voyage, start, end, 20.0, np.array(force))

    first, next_one = push(0.0, 60.0, 1.0, 0.0, 0.0), push(61.0, 91.0, 0.7, 0.0, 0.0)
    (whole,) = joined([next_one, first])
    assert (whole.start_s, whole.end_s, whole.log_evidence) == (0.0, 91.0, 40.0)
    assert np.allclose(whole.push, (0.9, 0.0, 0.0))
    for other in (
        push(61.0, 91.0, -0.7, 0.0, 0.0),
        push(90.0, 120.0, 0.7, 0.0, 0.0),
        push(61.0, 91.0, 0.7, 0.0, 0.0, voyage="w"),
    ):
        assert len(joined([first, other])) == 2


def test_what_lasts_all_voyage_is_no_moment_once_it_is_known(case_of):
    case = case_of("RudderWear")
    known, _ = refine(case, ("RudderWear",), "usual", np.ones(len(case.effects)), ())
    assert moments(case, known) == []


@thorough
def test_what_a_late_receiver_showed_of_before_the_recording_is_no_push_at_its_end(make, kvlcc2):
    """Test: a receiver 20 s late, as its model knows, on a voyage that begins in a turn. Expected: its last stretches
    are no likelier with a push (before, the errors of its first 20 s stood there: a log Bayes factor of 3.4)."""
    steps, start, whole = 16, 420, make(seed=1)
    late_s, now = steps * (whole.time_s[1] - whole.time_s[0]), slice(start, whole.time_s.size)
    then = slice(start - steps, whole.time_s.size - steps)
    turned = np.unwrap(np.radians(whole.columns["heading_true_north_deg"]))
    turned = turned[then] - turned[now]  # by the ship's own compass, which is prompt
    columns = {name: x[now].copy() for name, x in whole.columns.items()}
    for name in ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps"):
        columns[name] = whole.columns[name][then].copy()
    u, v = columns["surge_velocity_mps"], columns["sway_velocity_mps"]
    columns["surge_velocity_mps"] = u * np.cos(turned) - v * np.sin(turned)
    columns["sway_velocity_mps"] = u * np.sin(turned) + v * np.cos(turned)
    case = assemble([whole.with_rows(whole.time_s[now], columns)], kvlcc2)
    known, _ = refine(case, ("SensorDelay",), "usual", np.zeros(len(case.effects)), ())
    age = find("SensorDelay").absent(kvlcc2).but(delay=late_s, turned=late_s)
    asked = stretches(case, replace(known, model=known.model.but(age)))
    end_s = max(m.end_s for m in asked)
    assert max(m.log_evidence for m in asked if m.end_s > end_s - late_s) < 0.0


@thorough
def test_ships_that_pass_are_seen_when_they_pass_and_nothing_is_said_to_be_in_order(tanker, voyages):
    """Test: ships that pass every 11 lengths (439 s), each for about one. Expected: unknown, and the times at
    which they did."""
    result = diagnose([voyages["passed"]], tanker).result
    seen = sorted(0.5 * (m["start_s"] + m["end_s"]) for m in result["moments"])
    assert result["verdict"] == "unknown" and len(seen) >= 2
    passes = np.array(seen) / (11.0 * float(tanker.scale("time")))
    assert abs(np.exp(2j * np.pi * passes).mean()) > 0.8 and np.unique(np.rint(passes - passes[0])).size >= 2
    assert result["probabilities"]["nothing_missing"] < 0.5
    assert "a force pushed the ship" in "\n".join(terminal_lines(result)) and "missing" in result["sentence"]


def test_where_waves_toss_her_more_is_asked_of_a_push(case_of, monkeypatch):
    """Test: a healthy voyage of which one stretch is 20 nats likelier with a push, what swings it slowly,
    and waves.
    Expected: a moment, but in waves none."""
    case = case_of("nothing")
    monkeypatch.setattr(moment_of, "stretches", lambda *_: [Moment("nothing", 60.0, 90.0, 20.0, np.ones(3))])
    (track,) = case.tracks
    slow, swift = (np.full((len(track), 6), 2.0 * np.pi / period_s) for period_s in (40.0, 10.0))
    calm, slow, swift = (
        moments(replace(case, tracks=(replace(track, swell=x),)), as_she_is(case))
        for x in (None, slow, swift)
    )
    assert len(calm) == len(slow) == 1 and swift == []


def test_what_is_most_probable_of_everything_is_where_the_sum_of_squares_stands_still():
    rng = np.random.default_rng(3)
    G, e = rng.standard_normal((40, 5)), rng.standard_normal(40)
    normal = SimpleNamespace(total=lambda: (G.T @ G, G.T @ e, float(e @ e)), logdet=np.zeros(1))
    widths = {"core.0": 1.0, "core.1": 2.0, "A.2": 0.5, "A.3": 1.0, "B.4": 3.0}
    every = tuple(Unknown(*label.split("."), "-", 0.0, sd, -9.0, 9.0) for label, sd in widths.items())
    # the third is a fault's number, too
    nuisance = Nuisance(every[:3], np.diag([1.0, 2.0, 4.0]), np.array([0.3, -0.2, 0.1]))
    at = np.array([0.0, 0.4, 0.0])
    theta = likeliest(normal, nuisance, every, every[2:], 1.5, at, ("A",))

    def cost(x, z):
        moved = np.r_[x * [1.0, 2.0, 0.5], 0.0, 0.0] + np.r_[0.0, 0.0, (z - at) * [0.5, 1.0, 3.0]]
        left, width = e - G @ moved, np.array([1.0, 1.0, 0.01])
        return (
            0.5 * left @ left / 1.5
            + 0.5 * x @ nuisance.information @ x
            - nuisance.pull @ x
            + 0.5 * np.sum((z / width) ** 2),
            moved,
        )

    best = np.zeros(6)
    step = 1e-4
    for _ in range(3):  # Newton's steps by differences: the cost is a parabola
        around = [[cost(*np.split(best + step * (a + b), 2))[0] for b in np.eye(6)] for a in np.eye(6)]
        one = np.array([cost(*np.split(best + step * a, 2))[0] for a in np.eye(6)])
        here = cost(*np.split(best, 2))[0]
        back = np.array([cost(*np.split(best - step * a, 2))[0] for a in np.eye(6)])
        hessian = (np.array(around) - one[:, None] - one[None, :] + here) / step**2
        best = best - np.linalg.solve(hessian, (one - back) / (2.0 * step))
    assert theta == pytest.approx(cost(*np.split(best, 2))[1], abs=1e-3)


class Tug(find("TowForce")):
    """It pulls from 8 to 15 minutes after the voyage began: ten ship lengths."""

    def force(self, s, ship):
        return super().force(s, ship) if 480.0 <= s.t < 900.0 else Force(0.0, 0.0, 0.0)


def test_a_pull_of_ten_lengths_is_told_with_its_times_and_about_its_size(tanker):
    voyage_of = voyage(Tug.absent(tanker).but(ahead=-1.2e6), of=tanker)
    case = assemble([voyage_of], tanker)
    told = moments(case, as_she_is(case))
    assert told and all(m.start_s > 430.0 and m.end_s < 950.0 for m in told)
    assert sum(m.end_s - m.start_s for m in told) > 200.0
    assert told[0].as_json(case.model)["X_N"] == pytest.approx(-1.2e6, rel=0.2)


def test_a_moment_is_told_as_a_force(case_of, tanker):
    case = case_of("nothing")
    moment = replace(stretches(case, as_she_is(case))[0], push=np.array([1.0, 0.0, 0.0]))
    said = moment.as_json(case.model)
    assert said["X_N"] == pytest.approx(tanker.scale("force")) and said["Y_N"] == said["N_Nm"] == 0.0


def test_voyages_that_were_logged_at_different_rates_are_asked_side_by_side(tanker, voyages):
    every = voyages["nothing"]
    seldom = replace(
        every,
        name="seldom",
        time_s=every.time_s[::6],
        columns={name: x[::6] for name, x in every.columns.items()},
    )
    case = assemble([every, seldom], tanker)
    asked = stretches(case, as_she_is(case))
    assert case.tracks[1].h > 2.0 * case.tracks[0].h
    for name in ("nothing", "seldom"):
        lasts = [m.end_s - m.start_s for m in asked if m.voyage == name]
        assert max(lasts) == pytest.approx(16.0 * float(tanker.scale("time")), rel=0.1)
        assert max(m.end_s for m in asked if m.voyage == name) > 1100.0
