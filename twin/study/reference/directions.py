"""What is known beforehand of core and instruments, in the few directions about which the voyages say
something.

Eighty numbers that reference voyages told nearly everything of are eighty columns of every filter. A voyage
that is judged adds to what is known of a few combinations of them: the others stay where they are expected,
as one column together. Evidence is what it was but for what the voyages would have said of the rest, which is
little, and the same whatever they are asked."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.study.estimation.columns import Unknown
from twin.study.estimation.linear import Linear
from twin.study.reference.evidence import Nuisance

# information in the voyages over what is known beforehand, from which a direction is asked about
TELLS = 0.02
HELD_INFORMATION = 1e6  # information about what is not asked about


@dataclass(frozen=True)
class Directions:
    """The nuisance of a case in other unknowns: the first is all that is not asked about, and known; the
    others are independent."""

    nuisance: Nuisance
    place: tuple[int, ...]  # of the nuisance's own numbers among the columns of a line
    columns: np.ndarray  # (C, 1 + K) those numbers [their own units] for one unit of each of the new unknowns

    def line(self, line: Linear, others: Sequence[int]) -> Linear:
        """A track with the columns of these directions, and behind them some of those that it has. (What a
        fault that the instruments have turns of what they show counts in its own column alone: of its usual
        error that is next to nothing.)"""
        size = self.columns.shape[1]
        new = np.zeros((line.A.shape[2], size + len(others)), line.A.dtype)
        new[self.place, :size] = self.columns
        new[others, size + np.arange(len(others))] = 1.0
        # one product of all steps: one of each, of what is picked out first, takes twice as long
        A, R = ((M.reshape(-1, len(new)) @ new).reshape(*M.shape[:2], -1) for M in (line.A, line.R))
        turns = {size + k: line.turns[j] for k, j in enumerate(others) if j in line.turns}
        return replace(line, A=A, R=R, turns=turns)


def directions(
    told: np.ndarray,
    nuisance: Nuisance,
    unknowns: Sequence[Unknown],
    temper: float,
    chosen: Sequence[str] = (),
) -> Directions:
    """Of the information (P, P) of `unknowns`, the nuisance's among them. The usual amount of what is
    `chosen` is as expected: how much there is of it is asked beside. They are in prior widths."""
    label = {u.label: i for i, u in enumerate(unknowns)}
    place, sd = [label[u.label] for u in nuisance.unknowns], np.array([u.sd for u in nuisance.unknowns])
    mean, free = (
        np.linalg.solve(nuisance.information, nuisance.pull),
        np.array([u.owner not in chosen for u in nuisance.unknowns]),
    )
    root = np.zeros((sd.size, int(free.sum())))
    root[free] = np.linalg.cholesky(np.linalg.inv(nuisance.information[np.ix_(free, free)]))
    tells, turn = np.linalg.eigh(root.T @ (told[np.ix_(place, place)] * np.outer(sd, sd) / temper) @ root)
    asked = tells > TELLS
    every = root @ turn[:, asked]
    size = turn[:, asked].T @ np.linalg.solve(root[free], mean[free])
    columns = sd[:, None] * np.column_stack([mean - every @ size, every])
    fresh = tuple(Unknown("usual", str(k), "", 0.0, 1.0, -np.inf, np.inf) for k in range(columns.shape[1]))
    information = np.array([HELD_INFORMATION, *np.ones(size.size)])
    return Directions(
        Nuisance(fresh, np.diag(information), information * np.array([1.0, *size]), nuisance.daily),
        tuple(place),
        columns,
    )
