"""The physics of the loop: what the observer follows by itself is not in it a second time."""

import pytest

from twin.live.observer.dynamics import Dynamics
from twin.physics.effects import find


@pytest.mark.parametrize(
    "name, streams", [("Current", {"north": 0.5}), ("VaryingCurrent", {"north": 0.5, "north_c1": 0.2})]
)
def test_a_stream_that_has_a_name_is_where_the_observers_filter_begins_and_not_in_the_model_too(
    kvlcc2, name, streams
):
    stream = find(name).absent(kvlcc2).but(**streams)
    dynamics = Dynamics(kvlcc2.with_effects(stream, find("HullFouling")(extra=0.2)))
    assert dynamics.first_current == (0.5, 0.0)
    assert [type(e).__name__ for e in dynamics.full.effects] == ["HullFouling"]
