"""Instruments first: where an instrument is suspected, position, velocity, heading, rate of turn and log are
checked against each other without any model of the ship (twin/study/instruments).

A slow compass looks like a late receiver, an antenna elsewhere and a slow gear together; the rate of turn
proves it alone. What kinematics ask for, and is larger than what is usual of that instrument, becomes a
candidate of the whole search. It brings no evidence of its own there: the same readings speak again, with
the ship's model beside them."""

from collections.abc import Sequence

import numpy as np

from twin.errors import DataError
from twin.physics.effect import Effect
from twin.physics.effects import of_ship
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.criteria import SIGNIFICANT
from twin.study.estimation.columns import lateness_unknowns
from twin.study.instruments.estimate import estimate
from twin.study.instruments.findings import Instruments
from twin.study.instruments.unknowns import effect_of

USUAL = {"heading_delay": "compass"}  # number of kinematics -> whose usual lateness is known (columns.py)


def instrument_suspected(case: Case, effects: Sequence[str]) -> bool:
    """Whether one of these effects is an instrument's."""
    return any(case.catalogue[name].belongs_to == "instrument" for name in case.names(effects))


def asked_for(case: Case) -> tuple[type[Effect], ...]:
    """Effects of instruments that kinematics alone ask for on these voyages, clearly beyond what is usual of
    such an instrument, and that are no candidates yet."""
    try:
        found = estimate(case.tracks, float(case.model.ship.L_pp))
    except DataError:  # no heading, or too little of it: kinematics say nothing
        return ()
    catalogue = of_ship(case.model.ship)
    names = {str(effect_of(fault)) for fault in beyond_usual(found)}
    return tuple(catalogue[n] for n in sorted(names) if n in catalogue and n not in case.candidates)


def beyond_usual(found: Instruments) -> list[str]:
    """Faults that are seen, and whose number is farther from none than SIGNIFICANT times its own standard
    deviation and the usual lateness together."""
    usual = {u.name: u.sd for u in lateness_unknowns()}
    out = []
    for name, whose in USUAL.items():
        e = found.of(name)
        if e and e.seen and abs(e.value) > SIGNIFICANT * float(np.hypot(e.sd, usual[whose])):
            out.append(e.unknown.fault)
    return out
