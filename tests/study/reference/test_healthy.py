"""How rare a voyage would be on a healthy ship, by the scores of its reference voyages."""

from math import log

import numpy as np
import pytest

from twin.commands.story import MONDAY, SHIP
from twin.physics.effects import find, of_ship
from twin.physics.model import Model
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.study.estimation.columns import Unknown
from twin.study.estimation.innovations import NoiseModel
from twin.study.reference import healthy
from twin.study.reference.evidence import Nuisance, Reduced
from twin.study.reference.healthy import compared, score
from twin.study.reference.nuisance import usual_unknowns
from twin.study.track.track import track


def told(information, pull):
    """Two causes in prior widths, of which the voyages tell so much, independent of one another."""
    unknowns = tuple(Unknown(name, "size", "", 0.0, 1.0, -np.inf, np.inf) for name in ("Wear", "Bias"))
    return Reduced(np.diag(information), np.array(pull), 0.0, unknowns, np.zeros(2))


def test_p_counts_the_references_that_reach_the_score_and_is_never_less_than_one_of_them_more():
    """By hand: two of three at least as high, a tie among them: (1 + 2) / 4."""
    assert compared([1.0], [0.5, 1.0, 3.0])[1:] == (0.75, 0.25, 3, pytest.approx(2 / 3))
    assert compared([9.0], [0.5, 1.0, 3.0]).p == 0.25
    assert compared([9.0], [])[1:] == (None, None, 0, None)


def test_two_voyages_asked_at_once_are_two_chances():
    assert compared([0.0, 9.0], [0.5, 1.0, 3.0])[1:] == (0.5, 0.5, 3, 0.0)


def test_the_score_is_the_bayes_factor_of_the_cause_that_explains_most():
    """By hand: a normal prior of unit width against one of a hundredth; b^2/2 (1/(a+1) - 1/(a+1e4)) less half the
    log of the ratio."""
    a, b = 50.0, 30.0
    by_hand = 0.5 * b * b * (1 / (a + 1) - 1 / (a + 1e4)) - 0.5 * log((a + 1) / (1 + a * 1e-4))
    assert score(told((a, 20.0), (b, 1.0)), ["Wear", "Bias"], []) == pytest.approx(by_hand, rel=1e-6)


def test_a_cause_of_which_the_voyages_tell_nothing_is_no_news():
    """Else its Bayes factor of one would hide how much less the others explain."""
    assert score(told((50.0, 0.0), (0.1, 0.0)), ["Wear", "Bias"], []) < -1.0


@pytest.mark.parametrize("present", [(), ("HeadingLag",)])
def test_a_reference_is_scored_by_the_causes_that_every_diagnosis_weighs(monkeypatch, present):
    """Else it has more suspects than the voyage it is compared with, which then looks usual."""
    ship, scored = load(SHIP), []
    model = Model.of(ship.with_effects(*(find(name).absent(ship) for name in present)))
    suspected_first = {n for n, e in of_ship(ship).items() if e.suspected_first}
    assert suspected_first == {"HeadingLag", "ReceiverSmoothing", "CompassDeviation"}

    class Others:
        unknowns = usual_unknowns(model, of_ship(ship))

        def nuisance(self, without):
            return Nuisance(self.unknowns, np.eye(len(self.unknowns)), np.zeros(len(self.unknowns)))

    monkeypatch.setattr(healthy, "score", lambda reduced, causes, weather: scored.append(set(causes)) or 0.0)
    whole = track(read_voyage(MONDAY), ship)
    halves = [whole.part(0, len(whole) // 2), whole.part(len(whole) // 2, len(whole))]
    assert healthy.left_out_scores(halves, model, of_ship(ship), Others(), NoiseModel(), 1.0) == [0.0, 0.0]
    assert all(causes & suspected_first == set(present) and "HullFouling" in causes for causes in scored)
