"""Weather that the model does not know is what the model lacks only where it pushes harder than on the references."""

import pytest

from twin.study.reference.weather_baseline import HARDER, as_usual


@pytest.mark.parametrize("push", [1e-4, 0.02, 0.4])
def test_weather_that_pushes_no_harder_than_on_the_references_is_as_before_however_faint_it_is(push):
    assert as_usual({"Wind": push}, {"Wind": push}) == ("Wind",)
    assert as_usual({"Wind": 1.01 * HARDER * push}, {"Wind": push}) == ()


def test_weather_that_the_references_had_none_of_or_that_pushes_nothing_is_not_as_before():
    assert as_usual({"Wind": 0.02, "WaveDrift": 0.0}, {"WaveDrift": 0.1}) == ()
