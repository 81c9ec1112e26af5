"""What the ship's instruments always were, before the core is fitted: a receiver that smooths course and
speed, a compass that is slow, on every reference voyage alike, is how this ship is measured.

Kinematics find it without a model (instruments/on_references.py). Left out, hull and antenna would absorb it,
and every later voyage would be told to have a fault that the ship always had. Only what kinematics alone can
judge, and the receiver's age, are written into the ship file; the other faults of instruments are fitted with
the core (reference/nuisance.py), for which rudder and shaft tell of them too."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any
from weakref import WeakKeyDictionary

from twin.errors import DataError, SettingsError
from twin.physics.effects import find
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.calibration.usual import LASTING_SE
from twin.study.instruments.corrections import effects_of_readings, with_numbers
from twin.study.instruments.findings import UNINFORMATIVE
from twin.study.instruments.instrument_samples import Readings, ReadingSamples, of_voyage
from twin.study.instruments.on_references import NOTE, KinematicRecord, OnReferences, on_references
from twin.study.instruments.unknowns import INDEX, UNKNOWNS, effect_of, members
from twin.study.reference.sailed import Sailed

AGE = "gnss_delay"  # the fault that is the receiver's age
LEAST_REFERENCES = (
    3  # voyages that tell of a number before it is called the same on each: two show no scatter
)
# by the times of the first and the last sample used [s]; a calibration asks the same voyages twice
READINGS_BY_SPAN: WeakKeyDictionary[Voyage, dict[tuple[float, float], Readings]] = WeakKeyDictionary()


@dataclass(frozen=True)
class OwnInstruments:
    """The ship with its instruments as the references establish them, what is kept of each voyage (None:
    nothing could be asked), and the numbers that became a part of the ship, by effect and parameter."""

    ship: Ship
    record: KinematicRecord | None
    written: dict[str, dict[str, dict[str, Any]]]


def own_instruments(fitted: Sequence[Sailed], ship: Ship) -> OwnInstruments:
    """Ask the reference voyages; where they cannot be asked (no heading), the ship is as it was."""
    try:
        asked = on_references([_readings(s) for s in fitted], float(ship.L_pp))
    except DataError:
        return OwnInstruments(_without_record(ship), None, {})
    written: dict[str, dict[str, dict[str, Any]]] = {}
    known = effects_of_readings()
    for fault in established(asked):
        names = [UNKNOWNS[i].name for i in members(fault)]
        usual = {n: asked.record.numbers[n] for n in names if n in asked.record.numbers and n in known}
        told = {n: (u.value, u.next_sd) for n, u in usual.items()}
        try:
            ship = with_numbers(ship, told, asked.record.own, [s.track.name for s in fitted])
        except SettingsError:  # outside what an effect can be: not what this effect is
            continue
        for n, u in usual.items():
            effect, parameter = known[n].__name__, known[n].by_readings[n]
            written.setdefault(effect, {})[parameter] = {
                "value": u.value,
                "unit": UNKNOWNS[INDEX[n]].unit,
                "sd": u.sd,
                "between": u.between,
            }
    after = replace(ship, notes={**ship.notes, NOTE: plain(asked.record.entry())})
    return OwnInstruments(after, asked.record, written)


def established(asked: OnReferences) -> list[str]:
    """Faults that a ship file may hold as the ship's own: seen on all references together, told by three at
    least, clear of none on the next voyage too, by the scatter between them, and seen beside what sound
    instruments show otherwise from day to day. For what no formula here has of how this ship drifts may look
    like a fault, and is the same on each of its voyages: no scatter between them tells of it."""
    clear = [f for f, far in asked.clear.items() if far > LASTING_SE and _of_kinematics(f)]
    clear = [f for f in clear if _voyages_known(asked, f) >= LEAST_REFERENCES]
    if not clear:
        return []
    seen = asked.whole.varying().estimate().distinct
    return [f for f in clear if f in seen]


def _of_kinematics(fault: str) -> bool:
    """Whether kinematics alone judge it: the receiver's age, and what the ship's motion hardly shows."""
    name = effect_of(fault)
    return name is not None and (fault == AGE or find(name).kinematic)


def _voyages_known(asked: OnReferences, fault: str) -> int:
    """On how many voyages one of its numbers is known."""
    width = dict(zip((u.name for u in UNKNOWNS), asked.found.fit.prior(), strict=True))
    names = [UNKNOWNS[i].name for i in members(fault)]
    usual = [(width[n], asked.record.numbers[n]) for n in names if n in asked.record.numbers]
    return max(sum(v.sd < UNINFORMATIVE * w for v in u.voyages) for w, u in usual)


def _readings(s: Sailed) -> Readings:
    """The readings of what is used of this voyage for the fit."""
    start = float(s.voyage.time_s[0])
    span = start + float(s.track.t[0]), start + float(s.track.t[-1])
    known = READINGS_BY_SPAN.setdefault(s.voyage, {})
    if span not in known:
        known[span] = _used(s.voyage, *span)
    return known[span]


def _used(voyage: Voyage, first: float, last: float) -> Readings:
    read = of_voyage(voyage)

    def used(x: ReadingSamples) -> ReadingSamples:
        ok = (x.t >= first) & (x.t <= last)
        return x if ok.all() else ReadingSamples(x.t[ok], x.y[ok])

    return replace(read, by={k: used(x) for k, x in read.by.items()})


def _without_record(ship: Ship) -> Ship:
    """The ship without what an earlier calibration kept of other voyages."""
    return replace(ship, notes={k: v for k, v in ship.notes.items() if k != NOTE})
