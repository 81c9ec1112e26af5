"""A ship that is loaded otherwise has other derivatives, which regressions over many hulls give: for any one
hull they are only roughly right.

How much heavier, deeper or trimmed it is, is then known no better than those regressions let it be. So the
numbers of an effect that alters the ship are told with each derivative that it changes free to change by a
share of that more or less. And it is a load only if something of it still shows then, and if it floats with
it: what is heavier lies deeper, by the area of its waterplane."""

from dataclasses import replace

import numpy as np

from twin.physics.effect import Effect, Force
from twin.physics.effects.loading import waterplane
from twin.physics.model import Model
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import Found, standing
from twin.study.estimation.columns import with_values
from twin.study.reference.evidence import Nuisance, Posterior, posterior

HULL = ("X_", "Y_", "N_")
SCATTER = 0.5  # of single hulls about a regression, as a share of what it says
# chi squared of a load's numbers from which they are more than derivatives that differ (95 % of three)
SHOWS = 8.0
# share of its draught by which mass and draught may disagree: other water, a waterplane that is not as usual
AFLOAT = 0.02
DIFFERENCE_SD = 2.5  # standard deviations beyond which they do


def sized(case: Case, found: Found) -> Posterior:
    """What the voyages say of a hypothesis' numbers; of one that alters the ship, beside derivatives that
    scatter."""
    moved = changed_derivatives(
        case,
        Model(
            found.model.ship, tuple(e for e in found.model.effects if type(e).__name__ not in case.unnamed)
        ),
    )
    if not moved.any():
        return found.posterior
    lines, at = standing(case, found, case.unknowns)
    wider = replace(case, nuisance=widened(case.nuisance, SCATTER * moved))
    reduced = wider.reduced(lines, case.scenarios([found.hypothesis.scenario], found.doubt), at)[0]
    return posterior(reduced, found.hypothesis.effects)


def floats(case: Case, found: Found) -> bool:
    """Whether what alters the ship under a hypothesis can be a load; what does not alter it can be what it
    says."""
    own = [
        u
        for u in case.effects
        if u.owner in found.hypothesis.effects
        and u.owner not in case.unnamed
        and _alters(case.catalogue[u.owner])
    ]
    if not own:
        return True
    known, mine = sized(case, found), [case.effects.index(u) for u in own]
    z, C = known.z[mine], known.covariance[np.ix_(mine, mine)]
    if z @ np.linalg.solve(C, z) < SHOWS:
        return False
    before = case.model.loaded

    def deeper(z: np.ndarray) -> float:
        """Than its mass would have it, as a share of its draught."""
        after = with_values(
            case.model, own, [u.centre + u.sd * x for u, x in zip(own, z, strict=True)], case.catalogue
        ).loaded
        return float(after.T / before.T - 1.0 - (after.m / before.m - 1.0) * before.C_b / waterplane(before))

    slope = np.array([deeper(z + step) - deeper(z - step) for step in 0.01 * np.eye(z.size)]) / 0.02
    return abs(deeper(z)) < DIFFERENCE_SD * float(np.hypot(np.sqrt(slope @ C @ slope), AFLOAT))


def _alters(kind: type[Effect]) -> bool:
    return issubclass(kind, Force) and kind.alter is not Force.alter


def changed_derivatives(case: Case, model: Model) -> np.ndarray:
    """(C,) how far the effects move each of the nuisance's numbers, in its own unit: derivatives over the
    draught of the ship as it was."""
    before, after = case.model.loaded, model.loaded
    deeper = float(after.T) / float(before.T)

    def change(name: str) -> float:
        return deeper * float(getattr(after.derivatives, name)) - float(getattr(before.derivatives, name))

    return np.array(
        [change(u.name) if u.owner == "core" and u.name[:2] in HULL else 0.0 for u in case.nuisance.unknowns]
    )


def widened(nuisance: Nuisance, extra: np.ndarray) -> Nuisance:
    """The same knowledge with so much more doubt in each number [its own unit]. `extra` (C,)."""
    covariance = np.linalg.inv(nuisance.information)
    mean = covariance @ nuisance.pull
    information = np.linalg.inv(covariance + np.diag((extra / [u.sd for u in nuisance.unknowns]) ** 2))
    return replace(nuisance, information=information, pull=information @ mean)
