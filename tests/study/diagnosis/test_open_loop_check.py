"""Where a hypothesis leads the ship, beside where it went."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effects import find
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.horizon import horizon_s
from twin.study.diagnosis.open_loop_check import (
    COMPLEXITY,
    FORM_MISSES,
    OpenLoopCheck,
    expected_errors,
    held_out_error,
    mean_error_m,
    measured_error_m,
    open_loop_check,
    roughly,
)
from twin.study.diagnosis.refine import Found, refine
from twin.study.diagnosis.verdict import weights
from twin.study.estimation.rough import KNOWN, added, elsewhere
from twin.study.reference.evidence import Hypothesis, posterior
from twin.study.reference.path_error import PathError

TEN = 10.0  # windows that do not overlap
EXPECTED_M = float(np.hypot(8.0, FORM_MISSES * 20.0))  # where nothing is off by 20 m


def asked(levered=None, **open_loop_error_m):
    """What a few hypotheses were off by [m] where 8 m are expected in the usual world and of 16 m in a rough
    one."""
    sets = {
        tuple(n for n in name.split("_") if n != "nothing"): off for name, off in open_loop_error_m.items()
    }
    found = {
        s: Found(Hypothesis(s, "usual", 0.0, 0.0), None, None, 0.0, off, EXPECTED_M)
        for s, off in sets.items()
    }
    return OpenLoopCheck(
        found,
        {"usual": 8.0, "rough": 16.0},
        {(): 0.0} | (levered or {}),
        TEN,
        frozenset(["WaveDrift"]),
        frozenset(),
    )


def says(*effects, scenario="usual"):
    return Hypothesis(effects, scenario, -100.0, -1.0)


def test_a_weather_force_that_is_in_the_model_is_known_to_a_tenth_on_the_path_too(tanker, voyages):
    """Test: a model that holds the wind since it was calibrated, on a windy voyage; the same calibrated with
    it. Expected: a tenth of where it would end without it belongs to what is expected, with what a wind that pushes
    a twentieth of its length farther ahead or aft would do; and nothing."""
    windy = tanker.with_effects(find("Wind").plausible(tanker))
    stored = windy.notes["structural"]
    beside = {"beside_effects": [*stored["beside_effects"], "Wind"]}
    lasting_ones = replace(windy, notes={**windy.notes, "structural": stored | beside})
    case, known = (assemble([voyages["Wind"]], ship) for ship in (windy, lasting_ones))
    (without, share), *others = added(case.model)
    assert share == KNOWN and not others and added(known.model) == []
    (ahead, aft), *more = elsewhere(case.model)
    moved = (
        0.5 * (mean_error_m(case, ahead) ** 2 + mean_error_m(case, aft) ** 2)
        - mean_error_m(case, case.model) ** 2
    )
    assert moved > 0.0 and not more and elsewhere(known.model) == []
    assert (
        roughly(case) == pytest.approx(np.hypot(KNOWN * mean_error_m(case, without), moved**0.5))
        and roughly(known) == 0.0
    )
    assert without.effects == tanker.effects


def test_the_level_of_the_reference_voyages_counts_once(tanker, voyages):
    """Test: a ship whose references ended twice as far off as noise and structure have it, and the same with a
    measured error of ten times that beside that level. Expected: twice what is simulated, whatever the other says."""

    def expected(level, measured):
        ahead, read = np.array([10.0, 120.0]), np.array([np.eye(8), 100.0 * np.eye(8)])
        mean = measured * np.array([[2.0, 1.0, 0.01], [20.0, 10.0, 0.1]])
        path = PathError(ahead, read, np.zeros(2), 10.0, mean, 3, level=np.array([level, level]))
        stored = tanker.notes["structural"] | {"path_error": path.entry()}
        notes = tanker.notes | {"structural": stored}
        return expected_errors(assemble([voyages["Wind"]], replace(tanker, notes=notes)))["usual"]

    simulated = expected(1.0, 1.0)
    assert expected(2.0, 1.0) == pytest.approx(2.0 * simulated, rel=1e-6)
    assert expected(2.0, 10.0) == pytest.approx(2.0 * simulated, rel=1e-6)


def test_a_wind_may_lead_her_as_far_off_as_its_side_force_would_that_attacks_elsewhere():
    """Test: 10 m off where hypot(8, 2) m are expected, alone and with what was not run beside it. Expected: no
    word against either where the lever may leave 6 m."""
    sure, levered = asked(nothing=20.0, Wind=10.0), asked({("Wind",): 6.0}, nothing=20.0, Wind=10.0)
    assert all(
        sure.log_probability(says(*s)) < -3.0 and levered.log_probability(says(*s)) == 0.0
        for s in (("Wind",), ("Wind", "Bank"))
    )


def test_what_is_no_farther_off_than_noise_and_structure_would_be_is_not_judged_by_it():
    path = asked(nothing=20.0, Wind=7.9, Bank=3.0)
    assert path.log_probability(says("Wind")) == path.log_probability(says("Bank")) == 0.0


def test_the_path_has_the_expected_error_of_the_model_alone_and_the_steps_the_one_beside_all_that_is_usual(
    case_of, searched, tanker
):
    case = case_of("nothing")
    notes = tanker.notes["structural"]
    assert case.path.share == pytest.approx(
        notes["floor"]["share"]
    ) and case.noise_model.share == pytest.approx(notes["beside"]["share"])
    weighed, found = searched("nothing")
    expected_m = open_loop_check(case, found, weighed).expected_m
    assert expected_m["usual"] <= expected_m["rough"] <= expected_m["strange"] < 4.0 * expected_m["usual"]


def test_what_goes_astray_loses_by_how_far_and_how_often():
    path = asked(nothing=20.0, Wind=16.0)
    assert path.log_probability(says("Wind")) == pytest.approx(-2.0 * TEN * np.log(16.0 / EXPECTED_M))
    assert path.log_probability(says("Wind", scenario="rough")) == 0.0
    assert path.log_probability(says()) < path.log_probability(says("Wind"))


def test_the_form_of_an_effect_may_miss_a_part_of_what_it_does_to_the_path():
    for nothing, expected_m in ((20.0, EXPECTED_M), (100.0, np.hypot(8.0, 10.0))):
        path = asked(nothing=nothing, Wind=expected_m)
        assert path.log_probability(says("Wind")) == pytest.approx(0.0)
        assert path.log_probability(says()) == pytest.approx(-2.0 * TEN * np.log(nothing / 8.0))


def test_a_force_that_comes_and_goes_leaves_half_of_what_it_does_to_the_path():
    at = np.hypot(8.0, 0.5 * 20.0)
    path = asked(nothing=20.0, WaveDrift=at, Wind=at)
    assert (
        path.log_probability(says("WaveDrift")) == pytest.approx(0.0)
        and path.log_probability(says("Wind")) < -1.0
    )


def test_a_hypothesis_that_was_not_asked_leads_as_well_as_the_best_part_of_it():
    path = asked(nothing=20.0, Wind=12.0, Bank=40.0)
    assert path.log_probability(says("Wind", "Bank")) == path.log_probability(says("Wind"))
    assert path.log_probability(says("Loading")) == pytest.approx(-2.0 * TEN * np.log(20.0 / EXPECTED_M))


def test_a_pair_that_was_asked_is_not_excused_by_its_better_half():
    path = asked(nothing=20.0, Wind=7.0, Wind_Bank=20.0)
    assert path.log_probability(says("Wind", "Bank")) == pytest.approx(-2.0 * TEN * np.log(20.0 / EXPECTED_M))


def test_a_second_effect_costs_more_where_one_leads_her_there_and_nothing_where_none_does():
    pair, none = says("Wind", "Bank"), says()
    for path, cost in (
        (asked(nothing=20.0, Wind=7.0, Wind_Bank=7.0), COMPLEXITY),
        (asked(nothing=20.0, Wind=15.0, Wind_Bank=7.0), 0.0),
    ):
        weighed = {h.effects: h.log_evidence for h in path.weigh([none, pair])}
        assert weighed["Wind", "Bank"] == pytest.approx(pair.log_evidence - cost)


def test_a_stream_is_not_asked_for_in_hours_that_were_left_out(case_of):
    """Expected: the current's own numbers come from the other half, those of a stream that changes from the
    whole voyage."""
    case = case_of("Current")
    for name, same in (("VaryingCurrent", True), ("Current", False)):
        found, _ = refine(case, (name,), "usual", np.zeros(len(case.effects)), ())
        elsewhere = replace(found, posterior=replace(found.posterior, z=1.5 * found.posterior.z))
        assert (held_out_error(case, elsewhere) > 1.2 * held_out_error(case, found)) == same


def test_a_stream_as_strong_as_any_day_brings_leads_her_without_being_named(case_of, voyages):
    """Test: a hidden stream, on a ship whose reference voyages met streams of 0 (nobody told), half and twice
    its size. Expected: nothing missing leads it astray by all of it, by what two such days do not bring, and
    not at all."""
    case = case_of("Current")
    named, _ = refine(case, ("Current",), "usual", np.zeros(len(case.effects)), ())
    axes = [i for i, u in enumerate(case.effects) if u.owner == "Current"]
    size = max(abs(named.posterior.z[i] * case.effects[i].sd) for i in axes)
    off = []
    for share in (0.0, 0.25, 1.0):
        daily = {case.effects[i].label: share * size for i in axes} if share else {}
        of_the_day = replace(case, nuisance=replace(case.nuisance, daily=daily))
        told = posterior(of_the_day.reduced(case.lines, case.scenarios(["usual"]))[0], ())
        off.append(held_out_error(of_the_day, Found(says(), told, case.model)))
    assert off[0] > off[1] > off[2]
    assert off[2] - held_out_error(case, named) < 0.05 * off[0]


def test_the_best_come_first():
    order = [h.effects for h in asked(nothing=30.0, Wind=8.0).weigh([says(), says("Wind")])]
    assert order == [("Wind",), ()]


def test_a_worn_rudder_leads_a_tanker_where_she_went_and_nothing_does_not(case_of, searched):
    case = case_of("RudderWear")
    weighed, found = searched("RudderWear")
    assert weights(case, weighed, found).best.effects == ("RudderWear",)
    assert found["RudderWear",].open_loop_error_m < 0.7 * found[()].open_loop_error_m
    path = open_loop_check(case, found, weighed)
    assert path.windows == pytest.approx(case.tracks[0].t[-1] / horizon_s(case.tracks[0], case.model))
    worn, healthy = (
        path.log_probability(replace(found[s].hypothesis, scenario="usual")) for s in (("RudderWear",), ())
    )
    assert worn > healthy
    assert held_out_error(case, found[()]) == pytest.approx(found[()].open_loop_error_m)


def test_what_is_likely_by_now_is_asked_however_unlikely_it_was_where_it_was_found(case_of, searched):
    """Test: a worn rudder that was found far below the best, and is the best since another set left the rest
    of it to what any day brings.
    Expected: it is led by it, too, and not only by nothing."""
    case = case_of("RudderWear")
    weighed, found = searched("RudderWear")
    worn = replace(found["RudderWear",].hypothesis, log_evidence=-1e4)
    stale = found | {("RudderWear",): replace(found["RudderWear",], hypothesis=worn)}
    assert ("RudderWear",) in open_loop_check(case, stale, weighed).found and (
        "RudderWear",
    ) not in open_loop_check(case, stale, [worn, found[()].hypothesis]).found


def test_the_expected_error_is_no_lower_than_what_the_calibration_measured_on_other_voyages(
    case_of, searched, tanker
):
    case = case_of("nothing")
    ahead = horizon_s(case.tracks[0], case.model)
    stored = {k: v for k, v in tanker.notes["structural"].items() if k != "path_error"}
    for held_out, measured in (([], 0.0), ([{"horizon_s": ahead, "position_m": 500.0}], 500.0)):
        notes = tanker.notes | {"structural": stored | {"held_out": held_out}}
        ship = replace(case.model.ship, notes=notes)
        asked_of = replace(case, model=replace(case.model, ship=ship))
        assert measured_error_m(asked_of) == pytest.approx(measured)
    weighed, found = searched("nothing")
    expected_m = open_loop_check(asked_of, found, weighed).expected_m
    assert list(expected_m.values()) == pytest.approx([500.0] * len(expected_m))


def test_two_that_lead_her_farther_astray_than_one_of_them_are_no_hypothesis():
    """Test: a gear alone, and with a second effect, where 8.2 m are expected. Expected: the two are dropped where
    they end outside it and farther off than the gear; not where both end alike, nor where the two end within
    what is expected."""
    both = says("SteeringLag", "Loading")
    for alone, together, kept in (
        (5.0, 9.0, False),
        (12.0, 14.0, False),
        (13.8, 14.0, True),
        (5.0, 8.0, True),
    ):
        path = asked(nothing=20.0, SteeringLag=alone, SteeringLag_Loading=together)
        assert (both.effects in [h.effects for h in path.weigh([both, says("SteeringLag"), says()])]) is kept


def test_weather_is_no_luxury_beside_a_cause():
    """Test: a cause that leads the ship there alone, in a wind and with a second cause. Expected: the wind
    costs nothing, the second cause does."""
    path = replace(
        asked(nothing=20.0, Wind=15.0, RudderWear=7.0, Wind_RudderWear=7.0, Loading_RudderWear=7.0),
        weather=frozenset(["Wind"]),
    )
    windy, two = says("Wind", "RudderWear"), says("Loading", "RudderWear")
    weighed = {h.effects: h.log_evidence for h in path.weigh([windy, two])}
    assert weighed[windy.effects] == pytest.approx(windy.log_evidence) and weighed[
        two.effects
    ] == pytest.approx(two.log_evidence - COMPLEXITY)


def test_what_a_side_force_may_leave_is_the_same_in_whatever_order_the_voyages_are_given(
    tanker, voyages, monkeypatch
):
    """Test: two windy voyages, in a stream of 1 m/s on the one and in none on the other. Expected: on each the
    wind's lever is asked in its own stream."""
    monkeypatch.setattr("twin.study.diagnosis.open_loop_check.held_out_error", lambda *_: 10.0)
    days = {"Wind": 1.0, "Wind again": 0.0}

    def levered(*names):
        case = assemble([voyages[name] for name in names], tanker)
        effects = case.ordered(("Wind", "Current"))
        sizes = {u.label: days[u.voyage] / u.sd for u in case.effects if u.owner == "Current"}
        z = np.array([sizes.get(u.label, float(u.owner == "Wind")) for u in case.effects])
        mine = [i for i, u in enumerate(case.effects) if u.owner in effects]
        models = tuple(case.at(mine, z, t) for t in case.tracks)
        nothing = posterior(case.reduced(case.lines, case.scenarios(["usual"]))[0], ())
        there = {
            s: Found(
                Hypothesis(s, "usual", 0.0, 0.0), replace(nothing, z=z), models[0], models=models if s else ()
            )
            for s in ((), effects)
        }
        return open_loop_check(case, there, [f.hypothesis for f in there.values()]).levered[effects]

    assert levered("Wind", "Wind again") == pytest.approx(levered("Wind again", "Wind"), rel=1e-6)
