"""What the voyages say of the hull's numbers lies inside what ships have, to the last bit."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.estimation.columns import core_unknowns
from twin.study.reference.derivatives import informed_by, with_derivatives


def test_a_number_at_the_end_of_its_box_is_written_and_read_again():
    """Test: an added mass in surge that voyages would have above zero, with a prior in whose widths zero is
    1.7e-18 above zero. Expected: zero, as a ship file may hold it; it had ended a calibration at its last
    step, with "X_udot = 1.7e-18 lies outside [-0.2, 0]"."""
    model = Model.of(load("container"))
    (own,) = (u for u in core_unknowns(model) if u.name == "X_udot")
    own = replace(own, centre=-0.0127, sd=0.003)
    assert own.centre + own.sd * ((own.hi - own.centre) / own.sd) > own.hi
    found = SimpleNamespace(
        model=model,
        unknowns=(own,),
        value=np.array([0.01]),
        sd=np.array([0.001]),
        gained=np.array([0.9]),
    )
    (told,) = informed_by(found)
    assert told.value == own.hi
    assert float(with_derivatives(model.ship, [told]).derivative("X_udot")) == own.hi
