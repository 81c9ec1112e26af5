"""Whether a stream that may change did: no water on earth stands quite still beside its mean, and an eddying
stream is a steady one.

What changes with the clock has a number for every twenty minutes, and where a core or another effect is only
roughly right these find something to mend: a full `Current` of the 2 m boat was a `VaryingCurrent` by 35 in
log evidence, for changes of 3 to 4 % of it; of true ones two thirds and more change. Such a stream is told as
what it is, a steady one. It stays in the weighing all the same: eddies that the voyages do show, taken from
every hypothesis, are put down to a cause."""

from collections.abc import Sequence

import numpy as np

from twin.physics.effect import Flow
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found, Sets
from twin.study.track.track import Track

EDDIES = 0.2  # of a stream, beside its mean, that nobody calls a change (root mean squares)


def steady(case: Case, found: Found) -> bool:
    """Whether a hypothesis holds a stream that may change, and that stays what it is but for eddies: it is
    the simpler effect that it `holds`."""
    chosen = found.hypothesis.effects
    of_voyages = [
        [e for e in found.on(i).effects if isinstance(e, Flow) and e.holds and type(e).__name__ in chosen]
        for i in range(len(case.tracks))
    ]
    return any(changes(each, found.model, case.tracks) < EDDIES for each in zip(*of_voyages, strict=True))


def changes(streams: Sequence[Flow], model: Model, tracks: Sequence[Track]) -> float:
    """What of the streams of these voyages is not each one's mean, as a share of all of it."""
    velocities = []
    for stream, t in zip(streams, tracks, strict=True):
        w = stream.water(Situation(t=t.t, psi=np.zeros(len(t))), model.ship)
        velocities.append(np.column_stack([w.u, w.v]))
    moved = np.concatenate([v - v.mean(0) for v in velocities])
    return float(np.linalg.norm(moved)) / max(float(np.linalg.norm(np.concatenate(velocities))), 1e-12)


def simpler(case: Case, effects: Sets) -> list[Sets]:
    """The same set with a part in the place of an effect that holds it: a current that does not change is a
    steady one."""
    swaps = [
        (name, part) for name in effects for part in case.catalogue[name].holds if part in case.candidates
    ]
    return [
        tuple(n for n in case.candidates if n == part or (n in effects and n != name)) for name, part in swaps
    ]
