"""What is known of core and instruments before a voyage is judged: from reference voyages, from the ship
file, or from priors."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.physics.effect import Effect
from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.ship_notes import known_to_owner, read_from
from twin.study.estimation.columns import (
    FORM,
    ROUGH,
    SEA,
    Unknown,
    core_unknowns,
    form_unknowns,
    lateness_unknowns,
    owner_of,
    sea_unknowns,
)
from twin.study.estimation.innovations import NoiseModel, Normal, innovate
from twin.study.estimation.linear import Linear
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.between import SHARES, BetweenVoyages, doubted, scattered, ship_of, voyages
from twin.study.reference.evidence import Nuisance

HEALTHY_WIDTHS = (
    0.3  # how much of a lasting effect a healthy ship usually shows, in widths of the effect's prior
)
TEMPER = 3.0  # when no reference voyage tells how far innovations are from white
NOTHING = 1e6  # information of what is none
ON_DECK = ("ahead", "starboard")  # of an antenna; how high it stands shows where the ship rolls alone


def lasting(model: Model, catalogue: dict[str, type[Effect]]) -> list[Unknown]:
    """The effects that belong to ship and instruments and not to the day: a healthy ship shows a little of
    each, beside what its file says of it. Of those that kinematics find (`Effect.kinematic`) only the ones
    that its file has; a place of the antenna that the owner knows is where he says."""
    present = {type(e) for e in model.effects}
    its = (
        e
        for name, e in catalogue.items()
        if e.belongs_to != "voyage"
        and (not e.kinematic or e in present)
        and not placed_by_owner(name, model.ship)
    )
    return [u for e in its for u in effect_unknowns(e, model) if u.name not in e.copies]


def placed_by_owner(name: str, ship: Ship) -> bool:
    """Whether it is the place of the antenna and its owner knows it on the deck: an antenna whose place was
    given without doubt has not moved, and is no rival of a receiver that is late."""
    return name == of_role("antenna").__name__ and all(known_to_owner(ship, name, n) for n in ON_DECK)


def daily(model: Model, catalogue: dict[str, type[Effect]]) -> list[Unknown]:
    """What every day brings a little of: no water and no air stands still."""
    return [u for e in catalogue.values() if e.every_day for u in effect_unknowns(e, model) if u.every_day]


def of_known_weather(model: Model, catalogue: dict[str, type[Effect]]) -> list[Unknown]:
    """By how much each number of weather that the ship's file knows may be otherwise on a day, as long as no
    reference voyages say: its form is only roughly right, and another wind or sea shows what is not."""
    present = (type(e).__name__ for e in model.effects if e.of_recorded_weather())
    its = (u for name in present if name in catalogue for u in effect_unknowns(catalogue[name], model))
    return [replace(u, sd=HEALTHY_WIDTHS * u.sd, of_file=True) for u in its]


def of_no_calibration(model: Model, catalogue: dict[str, type[Effect]]) -> dict[str, float]:
    """By how much [its own unit] each number is usually otherwise than none that every diagnosis weighs and
    no core is fitted beside (`Effect.kinematic`), for no calibration says; where the ship's file lacks it."""
    present = {type(e) for e in model.effects}
    its = (e for e in catalogue.values() if e.kinematic and not e.suspected_first and e not in present)
    return {u.label: HEALTHY_WIDTHS * u.sd for e in its for u in effect_unknowns(e, model)}


def instruments(model: Model, catalogue: dict[str, type[Effect]]) -> list[Unknown]:
    """Core derivatives aside, what a calibration fits: the instruments' usual errors, and how late they
    are."""
    faults = [
        replace(u, sd=HEALTHY_WIDTHS * u.sd)
        for u in lasting(model, catalogue)
        if catalogue[u.owner].kind == "SensorFault"
    ]
    return [*faults, *lateness_unknowns()]


def nuisance_unknowns(model: Model, catalogue: dict[str, type[Effect]]) -> tuple[Unknown, ...]:
    """Core derivatives and what they leave out, in calm water and in waves, what a healthy ship usually shows
    of every lasting effect, and how late its instruments are."""
    usual = (replace(u, sd=HEALTHY_WIDTHS * u.sd) for u in lasting(model, catalogue))
    return (*core_unknowns(model), *form_unknowns(), *sea_unknowns(), *usual, *lateness_unknowns())


def usual_unknowns(model: Model, catalogue: dict[str, type[Effect]]) -> tuple[Unknown, ...]:
    """The same, and what the days of the reference voyages brought, also of weather that the ship's file
    knows."""
    return (
        *nuisance_unknowns(model, catalogue),
        *(replace(u, sd=HEALTHY_WIDTHS * u.sd) for u in daily(model, catalogue)),
        *of_known_weather(model, catalogue),
    )


def usual_of_file(model: Model, catalogue: dict[str, type[Effect]]) -> dict[str, float]:
    """By how much [its own unit] numbers are usually otherwise than the ship's file has them, or than none,
    where no reference voyages say."""
    of_weather = {u.label: u.sd for u in of_known_weather(model, catalogue)}
    return of_weather | of_no_calibration(model, catalogue)


def with_effects(
    known: Sequence[Unknown],
    effects: Sequence[Unknown],
    model: Model,
    catalogue: dict[str, type[Effect]],
) -> tuple[Unknown, ...]:
    """The columns in which a voyage is judged: of what is `known` the core and what it leaves out; numbers of
    the effects that may be there; what else lasts on this ship; and how late the instruments are."""
    core = [u for u in known if u.owner in ("core", FORM, SEA, ROUGH)]
    judged = {u.owner for u in effects}
    extra = [u for u in lasting(model, catalogue) if u.owner not in judged]
    return (*core, *effects, *extra, *lateness_unknowns())


@dataclass(frozen=True)
class Known:
    """What each reference voyage tells of these unknowns, in prior widths, and by how much (`scatter` (C,):
    variances) numbers differ from one to another; `pull` (C,): of the priors' means."""

    unknowns: tuple[Unknown, ...]
    voyages: tuple[BetweenVoyages, ...]
    scatter: np.ndarray
    usual: np.ndarray
    pull: np.ndarray

    @property
    def between(self) -> dict[str, float]:
        """By what share of its prior's width a number differs, of those that are likely to differ by
        more than is `usual` (C,)."""
        likely = self.usual + 0.5 * np.maximum(self.usual, SHARES[0] ** 2)
        each = zip(self.unknowns, self.scatter, likely, strict=True)
        return {u.label: float(np.sqrt(s)) for u, s, least in each if s > least}

    def nuisance(self, without: int | None = None) -> Nuisance:
        """As they concern the next voyage; `without` one of them, as that one would have been foretold."""
        told = [t for i, t in enumerate(self.voyages) if i != without]
        mean, covariance = ship_of(told, self.scatter, self.pull)
        covariance = covariance + np.diag(self.scatter)
        of_a_day = np.array([u.every_day or u.of_file for u in self.unknowns])
        lasting_ones = np.flatnonzero(~of_a_day)
        information = np.linalg.inv(covariance[np.ix_(lasting_ones, lasting_ones)])
        sizes = of_any_day(mean, np.diag(covariance), self.unknowns)
        usual = {
            self.unknowns[i].label: float(self.unknowns[i].sd * sizes[i]) for i in np.flatnonzero(of_a_day)
        }
        return Nuisance(
            tuple(self.unknowns[i] for i in lasting_ones),
            information,
            information @ mean[lasting_ones],
            usual,
        )


def known_from(
    lines: Sequence[Linear],
    unknowns: tuple[Unknown, ...],
    noise_model: NoiseModel,
    temper: float,
    prior: np.ndarray | None = None,
) -> Known:
    """Prior and reference voyages together (`lines` linearised with exactly these unknowns, in this order).
    `prior` (P,): prior means where they are not the unknowns' centres, in their own units."""
    sd = np.array([u.sd for u in unknowns])
    pull = np.zeros(sd.size) if prior is None else (prior - np.array([u.centre for u in unknowns])) / sd
    told = voyages(innovate(lines, [noise_model])[0], sd, temper)
    several = told if len(lines) > 1 else []  # two halves of one voyage share its clocks
    usual = doubted(
        several,
        pull,
        np.array([u.varies**2 for u in unknowns]),
        np.array([u.age or u.of_file for u in unknowns]),
    )
    return Known(unknowns, tuple(told), scattered(told, pull, usual), usual, pull)


def of_any_day(mean: np.ndarray, variance: np.ndarray, unknowns: Sequence[Unknown]) -> np.ndarray:
    """(C,) how much of each number a day brings, when these days had such a mean and spread: alike for the
    parts of what every day brings, for no stream sets to the north alone. In prior widths, as `mean` and
    `variance` (C,)."""
    square, owner = mean**2 + variance, np.array([u.owner for u in unknowns])
    shared = np.array([u.every_day for u in unknowns])
    means = [square[(owner == u.owner) & shared].mean() if u.every_day else 0.0 for u in unknowns]
    return np.sqrt(np.where([u.of_file for u in unknowns], square, means))


def from_ship(model: Model, unknowns: tuple[Unknown, ...]) -> Nuisance:
    """What the ship file's calibration left open; where it says nothing, the priors. SettingsError: its file
    does not hold it as it was written."""
    with read_from(model.ship, "[structural] offset and covariance"):
        return _from_ship(model, unknowns)


def _from_ship(model: Model, unknowns: tuple[Unknown, ...]) -> Nuisance:
    stored = model.ship.notes.get("structural", {})
    # added when it was calibrated already
    since = {type(e).__name__ for e in model.effects} - set(stored.get("beside_effects", ()))
    place = {label: i for i, label in enumerate(stored.get("labels", [])) if owner_of(label) not in since}
    size = len(unknowns)
    information, mean = np.eye(size), np.zeros(size)
    # by an earlier calibration
    unlearned = [
        i for i, u in enumerate(unknowns) if place and u.owner in ("core", FORM) and u.label not in place
    ]
    information[unlearned, unlearned] = NOTHING
    mine = [i for i, u in enumerate(unknowns) if u.label in place]
    if mine:
        theirs = [place[unknowns[i].label] for i in mine]
        sd = np.array([unknowns[i].sd for i in mine])
        covariance = np.array(stored["covariance"], float)[np.ix_(theirs, theirs)] / np.outer(sd, sd)
        mean[mine] = np.array(stored["offset"], float)[theirs] / sd
        if not np.all(np.isfinite(covariance)) or not np.all(np.isfinite(mean)):
            raise ValueError("not finite")
        if np.any(np.diag(covariance) < 0.0):
            raise ValueError("a variance below zero")
        covariance += 1e-9 * np.eye(len(mine))
        np.linalg.cholesky(covariance)  # ValueError where it is none
        information[np.ix_(mine, mine)] = np.linalg.inv(covariance)
    return Nuisance(unknowns, information, information @ mean, stored.get("daily", {}))


def learned_since(model: Model, catalogue: dict[str, type[Effect]]) -> list[str]:
    """Causes that the calibration in the ship's file did not know, or not with all their numbers: it was of
    an earlier version, or before a package brought them. None where the ship was never calibrated."""
    known = set(model.ship.notes.get("structural", {}).get("labels", ()))
    by_fit = [u for u in lasting(model, catalogue) if not catalogue[u.owner].kinematic]
    return list(dict.fromkeys(u.owner for u in by_fit if known and u.label not in known))


def temper_of(normal: Normal, unknowns: Sequence[Unknown]) -> float:
    """How much less the innovations tell than they would if they were white: variance of the segments' scores
    over their information, where the unknowns together explain the voyages best.

    Only directions that the voyages inform count; the median is taken, between 1.5 and 8 (White 1982, the
    sandwich)."""
    sd = np.array([u.sd for u in unknowns])
    A, b = normal.A * np.outer(sd, sd), normal.b * sd
    scores = b - A @ np.linalg.solve(np.eye(sd.size) + A.sum(0), b.sum(0))
    information = np.einsum("sii->i", A)
    told = information > 10.0
    if len(scores) < 4 or not told.any():
        return TEMPER
    ratio = (scores**2).sum(0)[told] / information[told]
    return float(np.clip(np.median(ratio), 1.5, 8.0))
