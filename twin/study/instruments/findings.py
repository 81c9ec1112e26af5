"""What a fit says, number by number and fault by fault: sizes, what is seen, what cannot be told, and which
residuals show it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from twin.study.estimation.rarity import P95
from twin.study.instruments.instrument_samples import Readings
from twin.study.instruments.kinematic_fit import KinematicFit, columns
from twin.study.instruments.problem import Problem
from twin.study.instruments.select import Weighed, WeighedSets
from twin.study.instruments.unknowns import ALWAYS, INDEX, UNKNOWNS, InstrumentUnknown

FAULT_BAYES_FACTOR = 5.0  # log Bayes factor from which a fault is said to be seen (150 to 1)
UNINFORMATIVE = 0.5  # of a prior width: a number that the readings leave wider is not known
ALIKE = 0.8  # correlation from which two numbers are said to be hard to tell apart
CLOCKS = {
    "gnss_delay": ("place", "velocity"),
    "heading_delay": ("heading",),
    "rate_delay": ("rate",),
    "log_delay": ("log",),
}
NOTHING_REFITTED: Mapping[str, float] = MappingProxyType({})
OF_ATTITUDE = ("heading_delay", "rate_delay")  # ages of what says where the ship points and how it turns


@dataclass(frozen=True)
class InstrumentEstimate:
    """One number. `sd`: the Cramer-Rao bound where the readings put it, with what varies from day to day
    where `estimate` was asked for that; `limit`: 95 % of what may be there unseen; `known`: whether the
    readings say it beside all others; `unlike`: the number that it is hardest to tell from."""

    unknown: InstrumentUnknown
    value: float
    sd: float
    seen: bool
    log_bayes_factor: float
    limit: float
    known: bool
    unlike: str | None
    voyage: str | None = None

    @property
    def interval(self) -> tuple[float, float]:
        """95 %."""
        return self.value - P95 * self.sd, self.value + P95 * self.sd


@dataclass(frozen=True)
class Instruments:
    """What kinematics says of the instruments of these voyages."""

    readings: tuple[Readings, ...]
    own: tuple[bool, ...]  # whether the velocity was turned by an attitude of the receiver's own
    estimates: tuple[InstrumentEstimate, ...]
    faults: tuple[str, ...]  # those seen
    # fault -> kind of reading -> its scatter without and with the fault
    falls: dict[str, dict[str, tuple[float, float]]]
    scatter: tuple[dict[str, float], ...]  # of each voyage's readings about the fit
    # from which instrument ages count; another -> how much later it is, and sd [s]
    relative: tuple[str, dict[str, tuple[float, float]]]
    log_bayes_factors: dict[str, float]
    # fault seen -> what may be there in its place, since these voyages do not tell which; () where they tell
    instead: dict[str, tuple[str, ...]]
    # fault seen -> log Bayes factor of it, or of what may be there in its place, against none of them
    of_any: dict[str, float]
    stream: tuple[dict[str, np.ndarray], ...]
    clock: str  # the age that is none by definition
    velocity_by: str  # what surely turned velocity over ground: "compass" or "receiver"; "": not known
    fit: KinematicFit

    @property
    def distinct(self) -> tuple[str, ...]:
        """The faults seen that the voyages tell from every other."""
        return tuple(f for f in self.faults if not self.instead[f])

    def of(self, name: str) -> InstrumentEstimate | None:
        """The estimate of that number (of the first voyage); None where the readings say nothing of it."""
        return next((e for e in self.estimates if e.unknown.name == name), None)


def said(
    readings: Sequence[Readings],
    problems: Sequence[Problem],
    found: KinematicFit,
    prompt: Sequence[str],
    velocity_by: str,
    refitted: Mapping[str, float] = NOTHING_REFITTED,
) -> Instruments:
    """What a fit says of the instruments, number by number and fault by fault. `readings` and `problems`: one
    for each voyage, in the order of the fit; `prompt`: the ages that are none by definition, first that from
    which those of heading and rate count; `refitted`: log Bayes factors of faults by fits of their own with
    them and without, which are believed where they are the lesser (refits.py). A fault of the likeliest set
    is seen when its log Bayes factor, or that of it and what would stand in its place together, is above
    FAULT_BAYES_FACTOR; in the latter case alone these voyages do not tell it from that."""
    refuted = [f for f, factor in refitted.items() if factor <= FAULT_BAYES_FACTOR]
    book = WeighedSets(found, prompt, refuted)
    best = book.likeliest()
    factor = {f: min(book.bayes_factor(f, best), refitted.get(f, np.inf)) for f in book.tellable}
    everything = book.weigh(book.tellable)
    untold = [f for f in best.faults if factor[f] <= FAULT_BAYES_FACTOR]
    instead = {f: book.instead(f, best) if f in untold else () for f in best.faults}
    of_any = {f: min(book.bayes_factor(f, best, instead[f]), refitted.get(f, np.inf)) for f in best.faults}
    faults = tuple(f for f in best.faults if of_any[f] > FAULT_BAYES_FACTOR and not _early(book, best, f))
    estimates = tuple(
        e for i in range(found.at.size) if (e := _one(i, readings, book, best, faults, factor, everything))
    )
    aged = book.weigh({*best.faults, *CLOCKS, "smoothing"}.intersection(book.tellable))
    return Instruments(
        tuple(readings),
        tuple(p.own for p in problems),
        estimates,
        faults,
        {f: _falls(problems, found, book, f) for f in faults},
        tuple({k: p.sd[k] for k in (*p.by, "drift") if k in p.sd} for p in problems),
        _relative(book, aged, problems, prompt[0]),
        factor,
        {f: instead[f] for f in faults},
        {f: of_any[f] for f in faults},
        tuple(_stream(p, t) for p, t in zip(problems, found.theta, strict=True)),
        prompt[0],
        velocity_by,
        found,
    )


def _early(book: WeighedSets, best: Weighed, fault: str) -> bool:
    """Whether a fault is an age, or the like, that is not above zero anywhere: no instrument is early."""
    of_best = book.fault[best.at] == fault
    return bool(book.late[best.at][of_best].all() and (best.mean[of_best] <= 0.0).all())


def _one(
    i: int,
    readings: Sequence[Readings],
    book: WeighedSets,
    best: Weighed,
    faults: Sequence[str],
    factor: dict[str, float],
    everything: Weighed,
) -> InstrumentEstimate | None:
    name, fault = book.names[i], str(book.fault[i])
    if fault == "drift" or (fault not in book.tellable and fault not in ALWAYS):
        return None
    about = best if i in best.at else book.weigh([*best.faults, fault])
    k = int(np.flatnonzero(about.at == i)[0])
    known = book.fit.width[i] ** -2.0 if fault not in ALWAYS else 0.0
    sd, value = _as_read(float(about.mean[k]), float(about.covariance[k, k]), known)
    at = int(np.flatnonzero(everything.at == i)[0])
    wide = np.sqrt(np.diag(everything.covariance))
    alike = np.abs(everything.covariance[at]) / (wide[at] * wide)
    alike[at] = 0.0
    j = int(np.argmax(alike))
    own = (i - len(UNKNOWNS) + 2) // 2 if fault == "current" else None
    lbf = factor.get(fault, np.inf)
    return InstrumentEstimate(
        UNKNOWNS[INDEX[name]],
        value,
        sd,
        fault in ALWAYS or fault in faults,
        lbf,
        abs(value) + P95 * sd,
        bool(wide[at] < UNINFORMATIVE * book.fit.width[i]),
        book.names[everything.at[j]] if alike[j] > ALIKE else None,
        None if own is None else readings[own].name,
    )


def _as_read(mean: float, variance: float, known: float) -> tuple[float, float]:
    """(sd, value) of a number as the readings alone have it, without what was believed before, N(0, 1/known);
    with it where that tells more than they do."""
    read = 1.0 / variance - known
    if read < known:
        return float(np.sqrt(variance)), mean
    return float(read**-0.5), mean / variance / read


def _falls(
    problems: Sequence[Problem], found: KinematicFit, book: WeighedSets, fault: str
) -> dict[str, tuple[float, float]]:
    """Scatter of each kind of reading without this fault (all else, the paths too, made to fit) and with it,
    where it changed by a tenth."""
    best = book.likeliest()
    without = book.weigh([f for f in best.faults if f != fault])
    row = np.zeros(found.at.size)
    row[without.at] = without.mean
    out: dict[str, tuple[float, float]] = {}
    for v, (bs, red) in enumerate(zip(found.blocks, found.reduced, strict=True)):
        step = row[columns(v)] - found.theta[v]
        states = red.states(step)
        for b in bs:
            if b.name in problems[v].by or b.name == "drift":
                r = b.r - b.J @ states - b.G @ step
                before, after = (float(np.sqrt(np.mean(b.weight * x**2))) for x in (r, b.r))
                if (
                    before > 1.1 * after
                    and before / after > out.get(b.name, (0.0, 1.0))[0] / out.get(b.name, (0.0, 1.0))[1]
                ):
                    out[b.name] = before, after
    return out


AGES = {"velocity": "smoothing", "heading": "heading_delay", "rate": "rate_delay", "log": "log_delay"}


def _relative(
    book: WeighedSets, aged: Weighed, problems: Sequence[Problem], clock: str
) -> tuple[str, dict[str, tuple[float, float]]]:
    """What the others' ages are counted from (the position where its own can be told, else the prompt
    instrument), and how much later each is [s] with its sd; of the velocity: than the position."""
    tied = any(p.tied for p in problems)
    reference = "gnss_delay" if tied and "gnss_delay" in (clock, *aged.faults) else clock
    out = {}
    for name, age in AGES.items():
        if (
            not any(name in p.by for p in problems)
            or age == reference
            or (age not in aged.faults and age != clock)
        ):
            continue
        if name == "log" and not tied:  # its age and the place's count from each other
            continue
        row = np.zeros(len(book.names))
        row[book.names.index(age)] = 1.0
        if name != "velocity":
            row[book.names.index(reference)] -= 1.0
        row = row[aged.at]  # the clock's own age is none
        out[name] = float(row @ aged.mean), float(np.sqrt(max(row @ aged.covariance @ row, 0.0)))
    return instrument_of(reference), out


def instrument_of(age: str) -> str:
    """The instrument whose age this number is."""
    return {"gnss_delay": "position"}.get(age, age.removesuffix("_delay"))


def _stream(p: Problem, theta: np.ndarray) -> dict[str, np.ndarray]:
    """Toward north and east at the stream's own times."""
    t = p.stream.start + p.stream.h * np.arange(p.stream.size)
    c = p.coefficients()[1]
    return {
        "time_s": t,
        "north_mps": c[:, 0] + theta[INDEX["current_north"]],
        "east_mps": c[:, 1] + theta[INDEX["current_east"]],
    }
