"""Whether a stream that may change did: no water on earth stands quite still beside its mean, and an eddying
stream is a steady one.

What changes with the clock has a number for every twenty minutes, and where a core or another effect is only
roughly right these find something to mend: a full `Current` of the 2 m boat was a `VaryingCurrent` by 35 in
log evidence, for changes of 3 to 4 % of it; of true ones two thirds and more change. Such a stream is told as
what it is, a steady one. It stays in the weighing all the same: eddies that the voyages do show, taken from
every hypothesis, are put down to a cause."""

import numpy as np

from twin.physics.effect import Flow
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found
from twin.study.track.track import Track

EDDIES = 0.2  # of a stream, beside its mean, that nobody calls a change (root mean squares)


def steady(case: Case, found: Found) -> bool:
    """Whether a hypothesis holds a stream that may change, and that stays what it is but for eddies: it is
    the simpler effect that it `holds`."""
    chosen = found.hypothesis.effects
    streams = [
        e for e in found.model.effects if isinstance(e, Flow) and e.holds and type(e).__name__ in chosen
    ]
    return any(changes(stream, found.model, case.tracks) < EDDIES for stream in streams)


def changes(stream: Flow, model: Model, tracks: tuple[Track, ...]) -> float:
    """What of a stream is not its mean over these voyages, as a share of all of it."""
    north_up = (stream.water(Situation(t=t.t, psi=np.zeros(len(t))), model.ship) for t in tracks)
    velocity = np.concatenate([np.column_stack([w.u, w.v]) for w in north_up])
    return float(np.linalg.norm(velocity - velocity.mean(0))) / max(float(np.linalg.norm(velocity)), 1e-12)
