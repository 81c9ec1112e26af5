"""Another loading changes derivatives, by regressions that are only roughly right for any one hull."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effects import find
from twin.study.diagnosis import altered
from twin.study.diagnosis.altered import SCATTER, changed_derivatives, floats, sized, widened
from twin.study.diagnosis.refine import Found, refine


@pytest.fixture(scope="module")
def case(case_of):
    return case_of("RudderWear")


def judged(case, name) -> Found:
    return refine(case, (name,), "usual", np.ones(len(case.effects)), ())[0]


def test_the_numbers_of_another_loading_are_known_less_well_than_the_readings_alone_would_have_it(case):
    found = judged(case, "Loading")
    mine = [i for i, u in enumerate(case.effects) if u.owner == "Loading"]
    before, after = (np.diag(p.covariance)[mine] for p in (found.posterior, sized(case, found)))
    assert (after > before).all() and after[1] > 1.5 * before[1]


def test_those_of_an_effect_that_leaves_the_ship_alone_stay_as_they_are(case):
    found = judged(case, "RudderWear")
    assert sized(case, found) is found.posterior


def test_a_derivative_moves_with_its_own_draught(case):
    deeper = case.model.but(find("Loading")(mass=0.0, draught=0.1, x_G=0.0))
    moved = dict(
        zip([u.label for u in case.nuisance.unknowns], changed_derivatives(case, deeper), strict=True)
    )
    d = case.model.ship.derivatives
    assert moved["core.Y_vv"] == pytest.approx(0.1 * d.Y_vv)  # cross-flow drag grows with the draught
    assert moved["core.N_uv"] == pytest.approx(0.21 * d.N_uv)  # a slender body's lift with its square
    assert moved["core.C_L"] == 0.0 and moved["late.log"] == 0.0


def test_doubt_is_added_to_what_was_known_and_the_mean_stays(case):
    extra = np.array([SCATTER * u.sd for u in case.nuisance.unknowns])
    wider = widened(case.nuisance, extra)
    covariance = [np.linalg.inv(n.information) for n in (case.nuisance, wider)]
    assert np.diag(covariance[1]) == pytest.approx(np.diag(covariance[0]) + SCATTER**2)
    assert covariance[1] @ wider.pull == pytest.approx(covariance[0] @ case.nuisance.pull, abs=1e-9)
    same = widened(case.nuisance, 0.0 * extra)
    assert replace(same, information=case.nuisance.information, pull=same.pull).pull == pytest.approx(
        case.nuisance.pull, abs=1e-6
    )


def loaded(case, **numbers):
    """Loading found at these numbers, and clearly."""
    found = judged(case, "Loading")
    z, covariance = found.posterior.z.copy(), found.posterior.covariance.copy()
    for i, u in enumerate(case.effects):
        if u.owner == "Loading":
            z[i] = numbers[u.name] / u.sd
            covariance[i, :] = covariance[:, i] = 0.0
            covariance[i, i] = 0.01**2
    return replace(found, posterior=replace(found.posterior, z=z, covariance=covariance))


@pytest.mark.parametrize(
    "numbers, can_be",
    [
        ({"mass": 0.12, "draught": 0.11, "x_G": 0.0}, True),
        ({"mass": 0.12, "draught": -0.03, "x_G": 0.0}, False),  # heavier, and higher in the water
        ({"mass": 0.001, "draught": 0.001, "x_G": 0.01}, False),  # nothing of it shows
    ],
)
def test_a_load_shows_and_sinks_her_by_the_area_of_her_waterplane(monkeypatch, case, numbers, can_be):
    monkeypatch.setattr(altered, "sized", lambda _, found: found.posterior)
    assert floats(case, loaded(case, **numbers)) is can_be


def test_what_does_not_alter_her_can_be_what_it_says(case):
    assert floats(case, judged(case, "RudderWear"))


def test_what_alters_her_and_is_no_load_need_not_float_and_its_numbers_are_no_regressions(case):
    found = judged(case, "SwayingMass")
    assert floats(case, found) and sized(case, found) is found.posterior
