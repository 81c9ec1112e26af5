"""What one unit of an unknown does, where the effect is not there and where it is."""

import numpy as np
import pytest

from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.study.estimation.columns import columns
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.track.track import track


@pytest.fixture(scope="module")
def gear(tanker, voyages):
    """The column of a gear's travel time at some value [s], of the accelerations it changes."""
    sailed, model = track(voyages["nothing"], tanker), Model.of(tanker)
    here, _ = model.without_inputs(sailed.missing())
    unknown = next(u for u in effect_unknowns(catalogue()["SteeringLag"], here) if u.name == "travel_time")

    def column(at):
        return columns(sailed, here, [unknown], catalogue(), None if at is None else {unknown.label: at})[0]

    return column


def test_a_fit_that_stands_at_nothing_still_sees_what_a_slow_gear_would_do(gear):
    """A gear that is a little slow is not slow at all: about nothing the derivative is zero, and a fit would
    stay there for ever."""
    assert np.abs(gear(0.0)).max() > 0.0
    assert np.array_equal(gear(0.0), gear(None))


def test_about_a_found_value_the_column_is_nearly_the_derivative(gear):
    assert not np.array_equal(gear(30.0), gear(None))
