"""The compass's deviation curve, as the ship's own way through the water tells of it.

Where speed over ground is turned into the ship's axes by the compass (or by the attitude that the heading is
of), readings alone cannot tell a deviation: the ship seems to sail at a drift angle that goes with the
heading. A hull without a side force has none, whatever its heading. So semicircular deviation (B, C: a ship's
own iron, and what its motors' currents make) is fitted beside the core where the voyages are clearly more
probable with it, every voyage's own stream allowed for, which carries the ship aside as well but does not
grow with its speed: left out, it bends the core. Whether the next voyage has the same curve is told by
predictions (core_fit.py)."""

from collections.abc import Sequence

import numpy as np

from twin.physics.effects import of_role
from twin.study.estimation.columns import Unknown
from twin.study.estimation.fit import Catalogue, Fit
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import linearise
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.between import BetweenVoyages, voyages
from twin.study.reference.steering_gear import GEAR_LOG_BAYES as CLEARLY
from twin.study.reference.steering_gear import about
from twin.study.track.track import Track

SEMICIRCULAR = ("B", "C")


def own_deviation(
    tracks: Sequence[Track], found: Fit, known: Catalogue, temper: float
) -> tuple[Unknown, ...]:
    """The numbers of a deviation curve that the voyages clearly ask for beside this fit; none where they do
    not, or where the model has a curve."""
    model, curve = found.model, of_role("compass")
    if any(isinstance(e, curve) for e in model.effects):
        return ()
    asked = tuple(u for u in effect_unknowns(curve, model) if u.name in SEMICIRCULAR)
    streams = [u for u in effect_unknowns(of_role("stream"), model) if u.every_day]
    every = (*about(found.unknowns, model), *asked, *streams)
    sd = np.array([u.sd for u in every])
    lines = [linearise(t, model.without_inputs(t.missing())[0], every, known) for t in tracks]
    told = voyages(innovate(lines, [NoiseModel()])[0], sd, temper)
    mine = np.array([u in asked for u in every])
    daily = np.array([u in streams for u in every])
    without = _log_probability([_left_out(t, mine) for t in told], daily[~mine])
    return asked if _log_probability(told, daily) > without + CLEARLY else ()


def _left_out(told: BetweenVoyages, some: np.ndarray) -> BetweenVoyages:
    """The same where these unknowns (P,) are at their centres."""
    return BetweenVoyages(told.A[np.ix_(~some, ~some)], told.b[~some], told.ee)


def _log_probability(told: Sequence[BetweenVoyages], daily: np.ndarray) -> float:
    """Of the voyages, up to what is the same with more or fewer unknowns: those that are `daily` (P,) are
    each voyage's own, the others are one for all; all of them integrated out over their priors."""
    total, lasting = 0.0, ~daily
    A, b = np.eye(int(lasting.sum())), np.zeros(int(lasting.sum()))
    for t in told:
        own, across = t.A[np.ix_(daily, daily)] + np.eye(int(daily.sum())), t.A[np.ix_(lasting, daily)]
        solved = np.linalg.solve(own, np.column_stack([across.T, t.b[daily]]))
        A += t.A[np.ix_(lasting, lasting)] - across @ solved[:, :-1]
        b += t.b[lasting] - across @ solved[:, -1]
        total += 0.5 * (float(t.b[daily] @ solved[:, -1]) - float(np.linalg.slogdet(own)[1]))
    return total + 0.5 * (float(b @ np.linalg.solve(A, b)) - float(np.linalg.slogdet(A)[1]))
