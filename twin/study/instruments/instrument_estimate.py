"""`estimate`: from voyages to what is wrong with each instrument, how much, how surely, and what cannot be
known from them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import numpy as np

from twin.recording.progress import Progress, silent
from twin.recording.voyage import Voyage
from twin.study.instruments.findings import (
    CLOCKS,
    FAULT_BAYES_FACTOR,
    OF_ATTITUDE,
    InstrumentEstimate,
    Instruments,
    said,
)
from twin.study.instruments.instrument_samples import Readings, of_track, of_voyage
from twin.study.instruments.kinematic_fit import KinematicFit, columns, fit, varying_with_the_day
from twin.study.instruments.problem import Problem
from twin.study.instruments.refits import Refits, begun_anew
from twin.study.instruments.select import Weighed, WeighedSets
from twin.study.instruments.unknowns import ALWAYS, INDEX, UNKNOWNS, effect_of
from twin.study.instruments.velocity_turned import turned_share
from twin.study.track.track import Track

__all__ = ["InstrumentEstimate", "Instruments", "estimate", "evidence"]
ROUNDS = 4  # selections, each about a new fit
OWN_TURN_LOG_BAYES = 30.0  # log evidence from which a receiver is said to have turned its velocity itself
BY_OWN = {False: "compass", True: "receiver"}  # whether the receiver turned it itself -> what did
# by which it is asked what turned a velocity: the gyro's scale is told only where the receiver did, and would
# speak for it wherever a gyro is off
OF_TURNING = [u.name for u in UNKNOWNS if u.name != "gyro_scale"]
# by the length of the ship [m]; a calibration asks the same voyages twice
KNOWN_TURNS: WeakKeyDictionary[Readings, dict[float, float]] = WeakKeyDictionary()


def estimate(
    voyages: Sequence[Voyage | Track | Readings],
    length_m: float | None = None,
    progress: Progress = silent,
    clock: str | None = None,
    own: bool | None = None,
    varying: bool = False,
) -> Instruments:
    """The instruments of these voyages of one ship; `length_m` of the ship, if known, scales what is believed
    of antennas and drift before any data. `clock`: the age from which others are counted, where that
    instrument was recorded and none is clearly earlier; else the earliest. `own`: whether its receiver turns
    its velocity by an attitude of its own, if known; else what all voyages say together. `varying`: whether
    what sound instruments show otherwise from day to day stands beside what the readings leave open: asked of
    voyages with no others of the same ship to compare them with."""
    whole = fit_whole(voyages, length_m, progress, clock, own)
    return (whole.varying() if varying else whole).estimate(progress)


@dataclass(frozen=True)
class WholeFit:
    """All numbers of these voyages fitted at once, before it is asked which faults are there. `prompt`: the
    ages that are none by definition; `velocity_by`: what surely turned the velocity ("": not known);
    `of_day`: whether what varies from day to day stands beside what the readings leave open."""

    readings: tuple[Readings, ...]
    problems: tuple[Problem, ...]
    velocity_by: str
    found: KinematicFit
    prompt: tuple[str, ...]
    refits: Refits
    of_day: bool = False

    def varying(self) -> "WholeFit":
        """With what sound instruments show otherwise from day to day."""
        return replace(self, found=varying_with_the_day(self.found, self.problems), of_day=True)

    def estimate(self, progress: Progress = silent) -> Instruments:
        """Which faults are there, and every number beside them."""
        problems, found, refitted = [p.as_it_is() for p in self.problems], self.found, dict[str, float]()
        while True:
            refuted = [f for f, factor in refitted.items() if factor <= FAULT_BAYES_FACTOR]
            found, best = self._settled(problems, found, refuted, progress)
            answer = said(self.readings, problems, found, self.prompt, self.velocity_by, refitted)
            asked = [f for f in answer.faults if f not in refitted]
            if not asked:
                return answer
            progress("fitting without " + ", ".join(asked))
            factors = self.refits.bayes_factors(best.faults, answer.faults)
            weakest = min(factors, key=lambda f: factors[f])
            if factors[weakest] > FAULT_BAYES_FACTOR:
                refitted |= factors
            else:
                refitted[weakest], problems = factors[weakest], begun_anew(problems)

    def _settled(
        self,
        problems: Sequence[Problem],
        found: KinematicFit,
        refuted: Sequence[str],
        progress: Progress,
    ) -> tuple[KinematicFit, Weighed]:
        """The fit of the likeliest set of faults, none of which was refuted, and the set: chosen about one
        fit, fitted, and chosen again until it stays."""
        chosen: tuple[str, ...] | None = None
        for _ in range(ROUNDS):
            best = WeighedSets(found, self.prompt, refuted).likeliest()
            if best.faults == chosen:
                break
            chosen = best.faults
            progress("fitting " + (", ".join(chosen) or "no fault"))
            names = [u.name for u in UNKNOWNS if u.fault in (*chosen, *ALWAYS)]
            found = fit(problems, names, _start(found, best))
            if self.of_day:
                found = varying_with_the_day(found, problems)
        return found, best


def fit_whole(
    voyages: Sequence[Voyage | Track | Readings],
    length_m: float | None = None,
    progress: Progress = silent,
    clock: str | None = None,
    own: bool | None = None,
) -> WholeFit:
    """All numbers of these voyages at once. Arguments: as of `estimate`."""
    readings = [_readings(v) for v in voyages]
    problems, velocity_by = _problems(readings, [length_m or r.length for r in readings], own, progress)
    progress("fitting all numbers at once")
    found, prompt = _whole(problems, clock)
    refits = Refits(problems, found.theta)
    return WholeFit(tuple(readings), tuple(problems), velocity_by, found, prompt, refits)


def _readings(v: Voyage | Track | Readings) -> Readings:
    return v if isinstance(v, Readings) else of_track(v) if isinstance(v, Track) else of_voyage(v)


def _problems(
    readings: Sequence[Readings], lengths: Sequence[float], own: bool | None, progress: Progress
) -> tuple[list[Problem], str]:
    """The voyages, with their velocity turned by the ship's compass or by the receiver itself, and which it
    surely was on all of them ("": that cannot be told). Where nobody says (`Readings.own`), their noise does,
    and where that is silent how they go together: one receiver, wired once."""
    untold = [(r, n) for r, n in zip(readings, lengths, strict=True) if r.own is None and "velocity" in r.by]
    share = turned_share([r for r, _ in untold])
    if own is None and share.tells:
        own = share.share < 0.5
    elif own is None and untold:
        own = sum(_itself(r, length, progress) for r, length in untold) > OWN_TURN_LOG_BAYES
    sure = {BY_OWN[r.own] if r.own is not None else share.by for r in readings if "velocity" in r.by}
    problems = [
        Problem(r, length, bool(own if r.own is None else r.own))
        for r, length in zip(readings, lengths, strict=True)
    ]
    return problems, sure.pop() if len(sure) == 1 else ""


def _itself(r: Readings, length: float, progress: Progress) -> float:
    """How much likelier (log) the readings are if the receiver turned its velocity itself than if the compass
    did. Asked once of the same readings."""
    known = KNOWN_TURNS.setdefault(r, {})
    if length not in known:
        known[length] = _likelier_itself(r, length, progress)
    return known[length]


def _likelier_itself(r: Readings, length: float, progress: Progress) -> float:
    progress(f"{r.name}: whose attitude turned the velocity?")
    sides = [Problem(r, length, own) for own in (False, True)]
    told = [fit([p], OF_TURNING, rounds=4).log_likelihood for p in sides]
    progress(f"{r.name}: its own rather than the compass by {told[1] - told[0]:.1f}")
    return told[1] - told[0]


def _whole(problems: Sequence[Problem], clock: str | None = None) -> tuple[KinematicFit, tuple[str, ...]]:
    """All numbers at once but for the ages that are none, and which: a clock of all instruments together
    shows nowhere; none is early, so the earliest is prompt. Where nothing ties compass and gyro to the place
    there are two such clocks: theirs, and that of place and log."""
    names, tied = [u.name for u in UNKNOWNS], any(p.tied for p in problems)
    held = ("heading_delay",) if tied else ("heading_delay", "log_delay")
    first = fit(problems, [n for n in names if n not in held], rounds=6)
    there = [n for n, by in CLOCKS.items() if any(b in p.by for b in by for p in problems)]
    groups = [there] if tied else [[n for n in there if (n in OF_ATTITUDE) == a] for a in (True, False)]
    sd = dict(zip(WeighedSets(first, held).names, first.sd().tolist(), strict=False))
    theta, prompt = first.theta.copy(), []
    for ages in filter(None, groups):
        value = {n: float(first.theta[0, INDEX[n]]) for n in ages}
        earliest = min(ages, key=lambda n: value[n] + 2.0 * sd[n])
        if clock in ages and value[clock] - 2.0 * sd[clock] < value[earliest] + 2.0 * sd[earliest]:
            earliest = clock
        theta[:, [INDEX[n] for n in ages]] -= value[earliest]
        prompt.append(earliest)
    return fit(problems, [n for n in names if n not in prompt], theta), tuple(prompt)


def _start(found: KinematicFit, best: Weighed) -> np.ndarray:
    """(V, P) where the set of faults is expected to stand."""
    row = np.zeros(found.at.size)
    row[best.at] = best.mean
    return np.array([row[columns(v)] for v in range(found.theta.shape[0])])


def evidence(track: Track, length_m: float | None = None) -> dict[str, float]:
    """Log Bayes factors by instrument effect of the catalogue, from kinematics alone: is this fault asked for
    by how position, velocity, heading, rate of turn and log go together? An effect of which the track tells
    nothing is not there."""
    found = estimate([track], length_m)
    out: dict[str, float] = {}
    for fault, factor in found.log_bayes_factors.items():
        if effect := effect_of(fault):
            out[effect] = max(factor, out.get(effect, -np.inf))
    return out
