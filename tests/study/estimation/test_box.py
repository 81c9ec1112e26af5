"""Whether a box stopped a number."""

import pytest

from twin.study.estimation.box import at_an_end


@pytest.mark.parametrize(
    "value, none, stopped",
    [
        (0.5, 0.0, False),
        (1.0, 0.0, True),
        (1.0 - 1e-7, 0.0, True),
        (1.0 - 1e-5, 0.0, False),
        (0.0, 0.0, False),  # no worn rudder
        (0.0, 0.5, True),  # a gear that was slow and is the fastest there can be
        (-0.1, 0.0, True),
        (1.1, 1.0, True),
    ],
)
def test_a_number_at_an_end_of_its_box_was_stopped_there_unless_that_is_none_of_it(value, none, stopped):
    assert at_an_end(value, 0.0, 1.0, none) is stopped


@pytest.mark.parametrize("sd, stopped", [(0.2, True), (0.3, False)])
def test_an_end_that_the_prior_itself_reaches_is_an_answer_as_any(sd, stopped):
    """Test: a share from none to all, believed to be a half, give or take 0.2 or 0.3, that is none."""
    assert at_an_end(0.0, 0.0, 1.0, 0.5, sd) is stopped
