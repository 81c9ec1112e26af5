"""Whether what acts like a cause lasts, or comes and goes."""

from dataclasses import replace

import numpy as np
import pytest

from twin.study.diagnosis.irregular import comes_and_goes, log_bayes_factor
from twin.study.diagnosis.refine import refine

CLEARLY = 5.0  # log Bayes factor


def found(case, *chosen):
    """These effects as the voyages have them."""
    return refine(case, chosen, "usual", np.ones(len(case.effects)), ())[0]


def test_ice_that_is_met_now_and_then_is_no_fouling_that_lasts(case_of):
    case = case_of("IceLike")
    fouled = found(case, "HullFouling")
    assert log_bayes_factor(case, fouled) > CLEARLY and comes_and_goes(case, fouled) > 0.99


def test_a_worn_rudder_is_worn_all_voyage(case_of):
    case = case_of("RudderWear")
    worn = found(case, "RudderWear")
    assert log_bayes_factor(case, worn) < -CLEARLY and comes_and_goes(case, worn) < 0.01


def test_noise_that_the_cause_makes_needless_speaks_for_nothing(case_of):
    """Test: the worn rudder's voyage, its noise model with a fast part ten times as large as on the
    references.
    Expected: a day as the references were is likelier than that, so that nothing comes and goes."""
    case = case_of("RudderWear")
    rough = replace(case.noise_model, white=tuple(10.0 * level for level in case.white))
    shaken = replace(case, noise_model=rough)
    assert log_bayes_factor(shaken, found(case, "RudderWear")) < -CLEARLY


@pytest.mark.parametrize("name, cause", [("HeadingBias",) * 2, ("Wind",) * 2, ("IceLike", "TowForce")])
def test_only_of_what_belongs_to_the_ship_it_is_asked_whether_it_lasts(case_of, name, cause):
    """An instrument exerts no force, and weather and a tow need not be steady."""
    case = case_of(name)
    assert log_bayes_factor(case, found(case, cause)) is None
    assert comes_and_goes(case, found(case, cause)) == 0.0
