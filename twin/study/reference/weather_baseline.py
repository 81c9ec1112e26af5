"""Weather that was measured and that the model does not know: did it blow harder than on the reference
voyages?

What pushed it then as hard as now is unchanged: it is allowed for in every hypothesis that gains by it, and
is never the answer."""

from collections.abc import Mapping, Sequence

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.study.estimation.respond import standard, steered
from twin.study.track.track import Track

FAINT = 0.03  # of the standard acceleration: nobody would feel it
HARDER = 1.5  # times the push of the reference voyages that are a change; a wind 1.2 times as strong


def strengths(
    tracks: Sequence[Track], model: Model, catalogue: Mapping[str, type[Effect]]
) -> dict[str, float]:
    """How hard each kind of measured weather that the model does not hold would push it at a plausible size:
    over the standard acceleration, on the voyage where it was hardest."""
    present = {type(e).__name__ for e in model.effects}
    unknown = [
        name for name, effect in catalogue.items() if effect.of_recorded_weather() and name not in present
    ]
    felt = {
        name: [s for t in tracks if (s := _strength(t, model, catalogue[name])) is not None]
        for name in unknown
    }
    return {name: max(values) for name, values in felt.items() if values}


def as_usual(now: Mapping[str, float], then: Mapping[str, float]) -> tuple[str, ...]:
    """The weather that is felt now, and no harder than it was then."""
    return tuple(name for name, strength in now.items() if 0.0 < strength <= HARDER * then.get(name, 0.0))


def _strength(track: Track, model: Model, effect: type[Effect]) -> float | None:
    """Root mean square over the voyage; None where its cause was not measured, or the ship's particulars lack
    what it needs."""
    if track.missing().intersection(effect.needs) or effect.lacking(model.ship):
        return None
    here = model.without_inputs(track.missing())[0]
    rates = effect.strength(track.situation(**steered(track, here)), here)
    push = np.column_stack([np.broadcast_to(a, track.t.shape) for a in rates]) / standard(here)
    return float(np.sqrt(np.nanmean(np.sum(push**2, axis=1))))
