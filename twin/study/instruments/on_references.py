"""What healthy voyages establish of the instruments, whatever the ship is: each number on each voyage, the
ship's own, and how it scatters between voyages.

An instrument that is late, smooths or deviates on every reference voyage is no fault: it is how this ship is
measured. The scatter between voyages is found as that of the core (reference/between.py). What a diagnosis
finds later is compared with these numbers."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from twin.physics.ship import Ship
from twin.physics.ship_notes import read_from
from twin.study.estimation.of_effect import NOTE
from twin.study.estimation.rarity import deviations
from twin.study.instruments.by_voyage import equations, tellable
from twin.study.instruments.findings import CLOCKS, Instruments
from twin.study.instruments.instrument_estimate import WholeFit, fit_whole
from twin.study.instruments.instrument_samples import Readings
from twin.study.instruments.unknowns import ALWAYS, INDEX, UNKNOWNS
from twin.study.reference.between import scattered, ship_of


@dataclass(frozen=True)
class KinematicOfVoyage:
    """One number on one voyage, in its own unit, and the log Bayes factor of its fault there."""

    voyage: str
    value: float
    sd: float
    log_bayes_factor: float


@dataclass(frozen=True)
class KinematicUsual:
    """One number on the reference voyages: the ship's own `value` and its `sd`, its scatter `between` voyages
    (sd), and each voyage's, where it told of it."""

    value: float
    sd: float
    between: float
    voyages: tuple[KinematicOfVoyage, ...]

    @property
    def opposite(self) -> "KinematicUsual":
        """Of the difference of two ages: the other less the one."""
        return replace(
            self, value=-self.value, voyages=tuple(replace(v, value=-v.value) for v in self.voyages)
        )

    @property
    def next_sd(self) -> float:
        """How far the number of the next voyage may be from `value` (sd)."""
        return float(np.hypot(self.sd, self.between))

    @cached_property
    def distances(self) -> tuple[float, ...]:
        """How far each reference voyage is from what the others foretell, in standard deviations."""
        return tuple(self._far(i) for i in range(len(self.voyages))) if len(self.voyages) > 1 else ()

    def _far(self, i: int) -> float:
        others = [v for j, v in enumerate(self.voyages) if j != i]
        weight = np.array([1.0 / (v.sd**2 + self.between**2) for v in others])
        mean = float(weight @ [v.value for v in others]) / float(weight.sum())
        variance = 1.0 / float(weight.sum()) + self.between**2 + self.voyages[i].sd ** 2
        return abs(self.voyages[i].value - mean) / float(np.sqrt(variance))


@dataclass(frozen=True)
class KinematicRecord:
    """What the ship file keeps. `clock`: the age from which the others count; `faults`: those that the
    references ask for, open beside every other; `own`: whether the receiver turned its velocity itself on all
    of them; `velocity_by`: what surely turned it, "compass" or "receiver", "" where that cannot be known."""

    clock: str
    faults: tuple[str, ...]
    own: bool
    numbers: Mapping[str, KinematicUsual]
    velocity_by: str = ""

    def entry(self) -> dict[str, Any]:
        """As the ship file has it."""
        return asdict(self)

    def counted_from(self, clock: str) -> "KinematicRecord":
        """The same with ages counted from another instrument. By how much the one that was prompt is later
        than that is what it was earlier by; of the other ages nothing is kept."""
        if clock == self.clock or clock not in self.numbers:
            return self
        kept = {n: u for n, u in self.numbers.items() if n not in CLOCKS}
        return replace(self, clock=clock, numbers=kept | {self.clock: self.numbers[clock].opposite})

    @staticmethod
    def of_ship(ship: Ship) -> "KinematicRecord | None":
        """From its file; None where it was calibrated without. SettingsError: the file does not hold it as it
        was written."""
        told = ship.notes.get(NOTE)
        if not told:
            return None
        with read_from(ship, f"[{NOTE}]"):
            numbers = {
                name: KinematicUsual(**{**n, "voyages": tuple(KinematicOfVoyage(**v) for v in n["voyages"])})
                for name, n in told["numbers"].items()
                if name in INDEX
            }
            return KinematicRecord(
                str(told["clock"]),
                tellable(told["faults"]),
                bool(told["own"]),
                numbers,
                str(told.get("velocity_by", "")),
            )


@dataclass(frozen=True)
class OnReferences:
    """The record, and how far the numbers of each fault that is seen are from none on the next voyage, as
    standard deviations of one."""

    record: KinematicRecord
    clear: Mapping[str, float]
    found: Instruments
    whole: WholeFit


def on_references(readings: Sequence[Readings], length_m: float) -> OnReferences:
    """Of reference voyages; DataError where one of them lacks heading, or position and velocity."""
    whole = fit_whole(readings, length_m)
    found = whole.estimate()
    told = [f for f in found.log_bayes_factors if f not in (*ALWAYS, found.clock)]
    numbers: dict[str, KinematicUsual] = {}
    clear: dict[str, float] = {}
    sets = {f: tellable({*found.faults, f}) for f in told}
    for chosen in dict.fromkeys(sets.values()):
        mine = [f for f in told if sets[f] == chosen]
        usual, far = _of_set(found, readings, chosen, mine)
        numbers |= usual
        clear |= {f: d for f, d in far.items() if f in found.distinct}
    record = KinematicRecord(found.clock, found.faults, all(found.own), numbers, found.velocity_by)
    return OnReferences(record, clear, found, whole)


def _of_set(
    found: Instruments, readings: Sequence[Readings], chosen: Sequence[str], mine: Collection[str]
) -> tuple[dict[str, KinematicUsual], dict[str, float]]:
    """The numbers of the faults `mine` with the faults `chosen` open, and how far each fault is from none."""
    each = [equations(found.fit, [v], chosen) for v in range(len(readings))]
    between = [e.between() for e in each]
    none = np.zeros(each[0].b.size)
    scatter = scattered(between, none)
    mean, covariance = ship_of(between, scatter, none)
    width, usual, far = each[0].width, {}, {}
    for fault in mine:
        rows = each[0].rows(fault)
        for i in rows:
            alone = [
                (r.name, e.number(i), e.log_bayes_factor(fault)) for r, e in zip(readings, each, strict=True)
            ]
            usual[UNKNOWNS[each[0].at[i]].name] = KinematicUsual(
                float(mean[i] * width[i]),
                float(np.sqrt(covariance[i, i]) * width[i]),
                float(np.sqrt(scatter[i]) * width[i]),
                tuple(KinematicOfVoyage(name, *n, factor) for name, n, factor in alone if n),
            )
        foretold = covariance[np.ix_(rows, rows)] + np.diag(scatter[rows])
        late = all(UNKNOWNS[each[0].at[i]].late for i in rows)
        far[fault] = 0.0 if late and mean[rows[0]] <= 0.0 else deviations(mean[rows], foretold)
    return usual, far
