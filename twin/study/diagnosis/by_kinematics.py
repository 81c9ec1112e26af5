"""Instruments first: where an instrument is suspected, position, velocity, heading, rate of turn and log are
checked against each other without any model of the ship (twin/study/instruments), and compared with what they
were on the reference voyages.

A slow compass looks like a late receiver, an antenna elsewhere and a slow gear together; the rate of turn
proves it alone. What kinematics ask for, and is another than on the references, becomes a candidate of the
whole search. It brings no evidence of its own there: the same readings speak again, with the ship's model
beside them. And a number that kinematics know to be as it always was is not one that changed."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from twin.errors import DataError
from twin.physics.effect import Effect
from twin.physics.effects import of_ship
from twin.physics.ship import Ship
from twin.recording.voyage import Voyage
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.criteria import CLEAR
from twin.study.diagnosis.refine import Found
from twin.study.estimation.columns import lateness_unknowns
from twin.study.instruments.by_voyage import equations
from twin.study.instruments.corrections import effects_of_readings
from twin.study.instruments.findings import CLOCKS, Instruments
from twin.study.instruments.instrument_estimate import estimate
from twin.study.instruments.on_references import KinematicRecord
from twin.study.instruments.unknowns import INDEX, UNKNOWNS, effect_of

# standard deviations from the references, or from none, from which an instrument is weighed as a cause: fewer
# than are asked of one that is named, for the ship's motion speaks, too
OTHERWISE = 5.0
INSTRUMENT_OF = {
    "heading_delay": "compass"
}  # number of kinematics -> whose usual lateness is known (columns.py)


@dataclass(frozen=True)
class AskedKinematics:
    """What kinematics say of the voyages that are judged, all together, and what they said of the reference
    voyages; None: the ship file was calibrated without."""

    found: Instruments
    record: KinematicRecord | None

    @cached_property
    def comparable(self) -> tuple[str, ...]:
        """Numbers that the references told too: ages only where they count from the same instrument."""
        if self.record is None:
            return ()
        same = self.found.clock == self.record.clock
        return tuple(n for n in self.record.numbers if same or n not in CLOCKS)

    def number(self, name: str) -> tuple[float, float] | None:
        """(value, sd) of one number beside the faults of these voyages and of the references; in the place
        of a fault that the voyages do not tell from its own."""
        fault = UNKNOWNS[INDEX[name]].fault
        seen = (f for f in self.found.faults if fault not in self.found.instead[f])
        before = self.record.faults if self.record else ()
        open_ones = {*seen, *before, fault}.intersection(self.found.log_bayes_factors)
        if fault not in open_ones:
            return None
        told = equations(self.found.fit, range(len(self.found.readings)), open_ones)
        return told.number(told.at.index(INDEX[name]))


def instrument_suspected(case: Case, effects: Sequence[str]) -> bool:
    """Whether one of these effects is an instrument's."""
    return any(case.catalogue[name].belongs_to == "instrument" for name in case.names(effects))


def kinematics(voyages: Sequence[Voyage], ship: Ship) -> AskedKinematics | None:
    """Of these voyages; None where they lack heading, or too much of it: kinematics say nothing."""
    record = KinematicRecord.of_ship(ship)
    try:
        clock, own = (record.clock, record.own) if record else (None, None)
        found = estimate(voyages, float(ship.L_pp), clock=clock, own=own)
    except DataError:
        return None
    return AskedKinematics(found, record.counted_from(found.clock) if record else None)


def suspected_instruments(case: Case, asked: AskedKinematics) -> tuple[type[Effect], ...]:
    """Effects of instruments that kinematics alone ask for on these voyages, and that are no candidates yet:
    clearly other than on the reference voyages, or where nothing is known of these, than is usual."""
    catalogue = of_ship(case.model.ship)
    others = other_than_before(asked) if asked.record else beyond_usual(asked.found)
    names = {str(effect_of(fault)) for fault in others}
    return tuple(catalogue[n] for n in sorted(names) if n in catalogue and n not in case.candidates)


def other_than_before(asked: AskedKinematics) -> list[str]:
    """Faults that are seen, and one of whose numbers is farther from those of the references than OTHERWISE
    times its own standard deviation and the scatter of those together."""
    assert asked.record is not None
    out = []
    for name in asked.comparable:
        fault, usual, now = UNKNOWNS[INDEX[name]].fault, asked.record.numbers[name], asked.number(name)
        if now is None or fault not in asked.found.faults:
            continue
        if abs(now[0] - usual.value) > OTHERWISE * float(np.hypot(now[1], usual.next_sd)):
            out.append(fault)
    return list(dict.fromkeys(out))


def beyond_usual(found: Instruments) -> list[str]:
    """Faults that are seen, and whose number is farther from none than OTHERWISE times its own standard
    deviation and the usual lateness together."""
    usual = {u.name: u.sd for u in lateness_unknowns()}
    out = []
    for name, whose in INSTRUMENT_OF.items():
        e = found.of(name)
        if e and e.seen and abs(e.value) > OTHERWISE * float(np.hypot(e.sd, usual[whose])):
            out.append(e.unknown.fault)
    return out


def reached(case: Case, found: Found, name: str, asked: AskedKinematics) -> float | None:
    """Share of the reference voyages whose kinematic numbers of this instrument are as far from the others'
    as these voyages' are from theirs; None where kinematics know too little to tell "as it was" from the
    change that the likeliest hypothesis has (log Bayes factor CLEAR).

    Of a change D +- s_D, seen as d +- s against references that scatter by s_0, the factor is

        ln N(d; 0, s^2 + s_0^2) - ln N(d; D, s^2 + s_0^2 + s_D^2)        summed over its numbers
    """
    if asked.record is None:
        return None
    factor, mine, theirs, known = 0.0, 0.0, dict[tuple[str, int], float](), effects_of_readings()
    for number in asked.comparable:
        effect, usual = known.get(number), asked.record.numbers[number]
        if effect is None or effect.__name__ != name or len(usual.distances) < 2:
            continue
        if (now := asked.number(number)) is None:
            continue
        D, sd_D = changed(case, found, f"{name}.{effect.by_readings[number]}")
        d, variance = now[0] - usual.value, now[1] ** 2 + usual.next_sd**2
        factor += _log_normal(d, variance) - _log_normal(d - D, variance + sd_D**2)
        mine = max(mine, abs(d) / float(np.sqrt(variance)))
        alike = Counter[str]()  # two files in two folders may have one name
        for v, far in zip(usual.voyages, usual.distances, strict=True):
            alike[v.voyage] += 1
            place = v.voyage, alike[v.voyage]
            theirs[place] = max(far, theirs.get(place, 0.0))
    if factor <= CLEAR:
        return None
    return float(np.mean([far >= mine for far in theirs.values()]))


def changed(case: Case, found: Found, label: str) -> tuple[float, float]:
    """By how much a number of an instrument is another than a healthy ship's, and its sd, in its own unit."""
    i = next(i for i, u in enumerate(case.effects) if u.label == label)
    u, known = case.effects[i], case.nuisance
    mean = np.linalg.solve(known.information, known.pull)
    usual = sum(float(m * n.sd) for m, n in zip(mean, known.unknowns, strict=True) if n.label == label)
    by = float(found.posterior.z[i] * u.sd) - usual
    return by, float(u.sd * np.sqrt(found.posterior.covariance[i, i]))


def _log_normal(x: float, variance: float) -> float:
    return -0.5 * (x * x / variance + float(np.log(variance)))
