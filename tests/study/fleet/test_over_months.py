"""Many ships asked for months: how often one in health is an alarm, and what few references can show."""

import numpy as np
import pytest

from twin.study.fleet.over_months import Martingale, alarms, evidence, of_a_lasting_fault


def test_three_references_and_two_voyages_by_hand():
    """Expected: 2 (sqrt 1 - 0) for the highest of four; then sqrt 5 (sqrt 3 - sqrt 2) for the third of five."""
    e = evidence([1.0, 2.0, 3.0], [4.0, 2.5])
    assert (e.references, e.voyages) == (3, 2)
    assert e.highest == pytest.approx(2.0)
    assert e.value == pytest.approx(2.0 * 5**0.5 * (3**0.5 - 2**0.5))
    assert e.at_most == pytest.approx(2.0 * 5**0.5)


@pytest.mark.parametrize("count", [1, 4, 9])
def test_a_rank_that_is_as_likely_as_any_gives_one_in_the_mean(count):
    """Test: the new score at each place among `count` references."""
    values = [evidence(list(range(count)), [place - 0.5]).value for place in range(count + 1)]
    assert np.mean(values) == pytest.approx(1.0)


def test_equal_scores_count_against_the_voyage():
    assert evidence([2.0] * 5, [2.0]).value < 1.0


def test_a_ship_in_health_ever_reaches_twenty_once_in_twenty_at_most():
    rng = np.random.default_rng(3)
    ever = [evidence(*np.split(rng.standard_normal(30), [6])).highest >= 20.0 for _ in range(1000)]
    assert np.mean(ever) <= 0.05


def test_of_fleets_in_which_a_third_is_faulty_few_alarms_are_of_healthy_ships():
    rng, wrong, found = np.random.default_rng(4), [], 0
    for _ in range(60):
        faulty = {f"bad {i}": 4.0 for i in range(4)} | {f"good {i}": 0.0 for i in range(8)}
        fleet = {
            name: evidence(rng.standard_normal(10), rng.standard_normal(20) + shift)
            for name, shift in faulty.items()
        }
        named = alarms(fleet)
        found += sum(n.startswith("bad") for n in named)
        wrong.append(sum(n.startswith("good") for n in named) / max(len(named), 1))
    assert np.mean(wrong) <= 0.05 and found > 100


def test_an_alarm_needs_more_in_a_larger_fleet_and_less_beside_others():
    quiet, loud = Martingale(9, 9, 1.0, 1.0, 1e6), Martingale(9, 9, 50.0, 50.0, 1e6)
    assert alarms({"a": loud}) == ["a"]
    assert alarms({"a": loud, "b": quiet, "c": quiet}) == []
    assert alarms({"a": loud, "b": loud, "c": quiet}) == ["a", "b"]
    assert alarms({}) == []


def test_three_references_never_show_a_lasting_fault_and_seven_do():
    """Test: the typical M of voyages above all references. Expected: it ends, by 3 far below the 20 that one
    ship needs; a simulation has the same mean logarithm."""
    assert of_a_lasting_fault(3, 10**6) == of_a_lasting_fault(3, 12) < 5.0
    assert of_a_lasting_fault(7, 100) > 20.0
    rng = np.random.default_rng(5)
    logs = [np.log(evidence([0.0] * 7, 1.0 + rng.random(10)).value) for _ in range(2000)]
    assert np.exp(np.mean(logs)) == pytest.approx(of_a_lasting_fault(7, 10), rel=0.05)
