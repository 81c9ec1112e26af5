"""What the tests of filter and tangents judge."""

import pytest

from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.track.track import track


@pytest.fixture(scope="module")
def judged(tanker, voyages):
    model = Model.of(tanker)
    unknowns = [*core_unknowns(model)[:4], *effect_unknowns(catalogue()["HeadingBias"], model)]
    return track(voyages["nothing"], tanker), model, unknowns
