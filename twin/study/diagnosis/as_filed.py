"""A ship's model with effects at the numbers that were found, as its file would hold them."""

from collections.abc import Sequence

import numpy as np

from twin.physics.model import Model
from twin.recording.jsonable import short
from twin.study.diagnosis.case import Case


def model_with(case: Case, names: Sequence[str], z: np.ndarray) -> Model:
    """The ship's model with the named effects at these numbers z (Q,), in prior widths of `case.effects`; of
    numbers that each voyage has for itself those of the first."""
    model = case.model
    for name in names:
        own = {
            number: value
            for u, x in zip(case.effects, z, strict=True)
            if u.owner == name and u.acts_on(case.tracks[0])
            for number, value in u.of_effect(in_file(u.centre + u.sd * float(x), u.lo, u.hi)).items()
        }
        present = next((e for e in model.effects if type(e).__name__ == name), None) or case.catalogue[
            name
        ].absent(model.ship)
        model = model.but(present.but(**own))
    return model


def in_file(value: float, low: float, high: float) -> float:
    """A number with as many digits as a file should hold, still inside its box; in its own unit."""
    return min(max(float(short(value)), low), high)
