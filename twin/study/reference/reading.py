"""A voyage linearised where it is read: so many segments of it, as a diagnosis reads it."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.study.estimation.columns import Unknown
from twin.study.estimation.linear import Linear, linearise
from twin.study.estimation.rough import doubted
from twin.study.reference.seaway import excited, levelled
from twin.study.track.segments import read_parts
from twin.study.track.track import Track

# of 16 ship lengths each; a small boat's hour holds more, and an even choice of them says enough
MOST_SEGMENTS = 20
FITTED_SEGMENTS = 60  # and of all voyages that a core is fitted to (decision 0051)


def fitted_parts(tracks: Sequence[Track], model: Model) -> list[Track]:
    """What of these tracks a core is fitted to: an even choice of FITTED_SEGMENTS of all together, and at
    least one of each."""
    return read_parts(tracks, float(model.ship.scale("time")), FITTED_SEGMENTS)


def read_lines(
    tracks: Sequence[Track],
    model: Model,
    unknowns: Sequence[Unknown],
    catalogue: dict[str, type[Effect]],
    most: int | None = None,
) -> tuple[Linear, ...]:
    """The tracks with what waves do to them taken for that, linearised where they will be read (`most`
    segments); what waves change of the ship's own forces, and what is only roughly known, no hypothesis takes
    away."""
    models = [model.without_inputs(t.missing())[0] for t in tracks]
    parts = read_parts([levelled(t) for t in tracks], float(model.ship.scale("time")), most)
    slack = [
        np.hypot(excited(t, m)[np.searchsorted(t.steps(), p.steps())], doubted(p, m))
        for t, p, m in zip(tracks, parts, models, strict=True)
    ]
    return tuple(
        replace(linearise(p, m, unknowns, catalogue), slack=s)
        for p, m, s in zip(parts, models, slack, strict=True)
    )
