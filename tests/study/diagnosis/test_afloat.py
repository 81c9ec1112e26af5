"""A load changes derivatives otherwise than regressions have it; it shows beside them, and it floats."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effects import find
from twin.study.diagnosis.afloat import floats
from twin.study.diagnosis.refine import Found, refine


@pytest.fixture(scope="module")
def case(case_of):
    return case_of("RudderWear")


def judged(case, name) -> Found:
    return refine(case, (name,), "usual", np.ones(len(case.effects)), ())[0]


def test_what_a_load_changes_otherwise_than_regressions_is_found_with_it_and_changes_the_ship(case):
    bare = find("Loading")(mass=0.1, draught=0.1, x_G=0.0)
    own = replace(bare, N_ur=-0.2)
    regressed, after = (case.model.but(load).loaded.derivatives for load in (bare, own))
    assert after.N_ur == pytest.approx(0.8 * regressed.N_ur) and after.Y_uv == regressed.Y_uv
    assert {"Loading.Y_uv", "Loading.Y_ur", "Loading.N_uv", "Loading.N_ur"} <= {u.label for u in case.effects}


def loaded(case, **numbers):
    """Loading found at these numbers, and clearly."""
    found = judged(case, "Loading")
    z, covariance = found.posterior.z.copy(), found.posterior.covariance.copy()
    for i, u in enumerate(case.effects):
        if u.owner == "Loading":
            z[i] = numbers.get(u.name, 0.0) / u.sd
            covariance[i, :] = covariance[:, i] = 0.0
            covariance[i, i] = 0.01**2
    return replace(found, posterior=replace(found.posterior, z=z, covariance=covariance))


@pytest.mark.parametrize(
    "numbers, can_be",
    [
        ({"mass": 0.12, "draught": 0.11, "x_G": 0.0}, True),
        ({"mass": 0.12, "draught": -0.03, "x_G": 0.0}, False),  # heavier, and higher in the water
        ({"mass": 0.001, "draught": 0.001, "x_G": 0.01}, False),  # nothing of it shows
        ({"mass": 0.001, "draught": 0.001, "x_G": 0.01, "N_ur": 0.2}, False),  # other damping is no load
    ],
)
def test_a_load_shows_and_sinks_her_by_the_area_of_her_waterplane(case, numbers, can_be):
    assert floats(case, loaded(case, **numbers)) is can_be


def test_what_does_not_alter_her_can_be_what_it_says(case):
    assert floats(case, judged(case, "RudderWear"))


def test_what_alters_her_and_is_no_load_need_not_float(case):
    assert floats(case, judged(case, "SwayingMass"))
