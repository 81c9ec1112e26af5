"""What is known of core and instruments before a voyage is judged: from reference voyages, from the ship file, or from priors."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from twin.physics.effect import Effect
from twin.physics.model import Model

from .columns import Unknown, core_unknowns, effect_unknowns
from .evidence import Nuisance
from .innovations import Floor, Linear, Normal, innovate

USUAL = 0.3  # an instrument's usual error, in widths of the fault's prior
TEMPER = 3.0  # when no reference voyage tells how far innovations are from white


def instruments(model: Model, catalogue: dict[str, type[Effect]]) -> list[Unknown]:
    """The faults of instruments, each as wide as a fault."""
    return [u for e in catalogue.values() if e.kind == "SensorFault" for u in effect_unknowns(e, model)]


def nuisance_unknowns(model: Model, catalogue: dict[str, type[Effect]]) -> tuple[Unknown, ...]:
    """Core derivatives, and the instruments' usual errors."""
    return (*core_unknowns(model), *(replace(u, sd=USUAL * u.sd) for u in instruments(model, catalogue)))


def from_references(lines: Sequence[Linear], unknowns: tuple[Unknown, ...], floor: Floor, temper: float) -> Nuisance:
    """Prior and reference voyages together (`lines` linearised with exactly these unknowns, in this order)."""
    A, b, _ = innovate(lines, [floor])[0].total()
    sd = np.array([u.sd for u in unknowns])
    return Nuisance(unknowns, A * np.outer(sd, sd) / temper + np.eye(sd.size), b * sd / temper)


def from_ship(model: Model, unknowns: tuple[Unknown, ...]) -> Nuisance:
    """What the ship file's calibration left open; where it says nothing, the priors."""
    stored = model.ship.notes.get("structural", {})
    labels, size = stored.get("labels", []), len(unknowns)
    information, place = np.eye(size), {label: i for i, label in enumerate(labels)}
    mine = [i for i, u in enumerate(unknowns) if u.label in place]
    if mine:
        theirs = [place[unknowns[i].label] for i in mine]
        sd = np.array([unknowns[i].sd for i in mine])
        covariance = np.array(stored["covariance"])[np.ix_(theirs, theirs)] / np.outer(sd, sd)
        information[np.ix_(mine, mine)] = np.linalg.inv(covariance + 1e-6 * np.eye(len(mine)))
    pull = np.zeros(size)
    for i, u in enumerate(unknowns):
        if u.owner != "core" and u.label in place:
            pull[i] = stored["values"][place[u.label]] / u.sd
    return Nuisance(unknowns, information, information @ pull)


def temper_of(normal: Normal, unknowns: Sequence[Unknown]) -> float:
    """How much less the innovations tell than they would if they were white: variance of the segments' scores over their information.

    Only directions that the voyages inform count; the median is taken, between 1.5 and 8 (White 1982, the sandwich).
    """
    sd = np.array([u.sd for u in unknowns])
    scores = normal.b * sd
    information = np.einsum("sii->i", normal.A) * sd**2
    told = information > 10.0
    if len(scores) < 4 or not told.any():
        return TEMPER
    ratio = (scores**2).sum(0)[told] / information[told]
    return float(np.clip(np.median(ratio), 1.5, 8.0))
