"""No more than on a healthy day? One number a voyage, and how many of the reference voyages, each left out of
what is known in turn, reach it.

The score s of a voyage is the greatest log Bayes factor of any one cause of ship or instruments beside the
day's water and weather, so that many suspects are not many tests. With n reference voyages

    p = (1 + #{i: s_i >= s}) / (n + 1)

is never less than 1 / (n + 1), and is at most a with probability a, for each a, when a healthy voyage and the
references could have come in any order (Vovk, Gammerman & Shafer 2005, Algorithmic learning in a random
world, ch. 2). Here s_i is scored against the others alone, s against all, and level and temper of the noise
are those of all: the leave-one-out form, which keeps that level nearly, not exactly. The unit is a voyage,
never a window.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model
from twin.study.estimation.columns import rough_unknowns
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.evidence import Reduced, reduce, weigh_sets
from twin.study.reference.nuisance import Known, usual_of_file, with_effects
from twin.study.reference.reading import MOST_SEGMENTS, read_lines
from twin.study.track.track import Track

MOST_WEATHER = 2  # of weather at once
TELLS = 1e-6  # information about a number, in prior widths, below which there is none
WEATHER_SETS = 3  # sets of weather beside which every cause is asked


class Healthy(NamedTuple):
    """How rare a voyage would be on a healthy ship, by its references."""

    score: float  # greatest log Bayes factor of a cause
    p: float | None  # None: no reference has a score
    at_best: float | None  # the least that so many references can show
    references: int
    reached: float | None  # share of the references that score at least as high


def score(reduced: Reduced, causes: Sequence[str], weather: Sequence[str]) -> float:
    """The greatest log Bayes factor of one cause of which these voyages tell something, the day's weather
    being there or not either way; below zero where none explains as much as its freedom costs."""
    tell = np.diag(reduced.A)
    causes = [name for name in causes if np.any(tell[reduced.rows((name,))] > TELLS)]
    days = [day for size in range(MOST_WEATHER + 1) for day in combinations(weather, size)]
    alone = sorted(weigh_sets(reduced, days), key=lambda e: -e[1])
    best = [day for day, _ in alone[:WEATHER_SETS]]
    sets = [(*day, name) for day in best for name in causes]
    return max((e for s, e in weigh_sets(reduced, sets) if s), default=alone[0][1]) - alone[0][1]


def always_weighed(effect: type[Effect], present: Collection[type[Effect]]) -> bool:
    """Whether every diagnosis weighs it: not what waits for kinematics, where the ship file lacks it. No
    other is scored, or healthy voyages would have more suspects than those that are judged."""
    return not effect.suspected_first or effect in present


def compared(own: Sequence[float], healthy: Sequence[float]) -> Healthy:
    """Of voyages' scores among those of the references. Of m voyages asked at once, m times the least p of
    any (Bonferroni)."""
    highest, n, m = max(own), len(healthy), len(own)
    if not n:
        return Healthy(highest, None, None, 0, None)
    reach = sum(s >= highest for s in healthy)
    return Healthy(highest, min(1.0, m * (1 + reach) / (n + 1)), min(1.0, m / (n + 1)), n, reach / n)


def left_out_scores(
    tracks: Sequence[Track],
    model: Model,
    catalogue: Mapping[str, type[Effect]],
    known: Known,
    noise_model: NoiseModel,
    temper: float,
) -> list[float]:
    """The score of each reference voyage when only the others tell what is usual on the ship; none where
    there are fewer than two."""
    if len(tracks) < 2:
        return []
    kinds, its = dict(catalogue), {type(e) for e in model.effects}
    names = [n for n, e in kinds.items() if always_weighed(e, its) and not e.lacking(model.ship)]
    effects = tuple(u for n in names for u in effect_unknowns(kinds[n], model))
    rough = rough_unknowns(model)
    unknowns = with_effects((*known.unknowns, *rough), effects, model, kinds)
    weather = [n for n in names if kinds[n].is_weather()]
    causes = [n for n in names if n not in weather]
    out = []
    for i, track in enumerate(tracks):
        usual = known.nuisance(without=i).beside(rough)
        usual = replace(usual, daily=usual_of_file(model, kinds) | dict(usual.daily))
        lines = read_lines([track], model, unknowns, kinds, MOST_SEGMENTS)
        normal = innovate(lines, [noise_model], MOST_SEGMENTS)[0]
        out.append(score(reduce(normal, usual, unknowns, effects, temper), causes, weather))
    return out
