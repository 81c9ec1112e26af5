"""How rare the voyages of a case would be on the ship in health (the score: reference/healthy.py; its words:
against_healthy.py)."""

from collections.abc import Sequence

from twin.physics.ship_notes import read_from
from twin.study.diagnosis.case import Case, uneven
from twin.study.estimation.linear import Linear
from twin.study.reference.healthy import Healthy, always_weighed, compared, score
from twin.study.reference.reading import MOST_SEGMENTS, read_lines
from twin.study.reference.structure import noise_model_of


def against_healthy(case: Case) -> Healthy | None:
    """How rare these voyages would be on this ship in health, by its reference voyages
    (reference/healthy.py)."""
    with read_from(case.model.ship, "[structural] left_out_scores"):
        scores = list(map(float, case.model.ship.notes.get("structural", {}).get("left_out_scores", [])))
    noise_model = noise_model_of(case.model.ship, "beside")
    if not scores or noise_model is None:
        return None
    its = {type(e) for e in case.model.effects}
    causes = [n for n in case.names(case.candidates) if always_weighed(case.catalogue[n], its)]
    own = [score(case.reduced([line], [noise_model])[0], causes, case.weather) for line in lines_apart(case)]
    return compared(own, scores)


def lines_apart(case: Case) -> Sequence[Linear]:
    """Each voyage linearised on as many segments as every reference voyage was scored on: a score grows with
    them, and voyages that are asked together share that many."""
    if len(case.tracks) == 1:
        return case.lines
    alone = [
        read_lines([t], case.linearised, case.unknowns, case.catalogue, MOST_SEGMENTS)[0] for t in case.tracks
    ]
    time = float(case.model.ship.scale("time"))
    settled = any(line.track.ripple is not None for line in case.lines)
    return [uneven(line, time) for line in alone] if settled else alone
