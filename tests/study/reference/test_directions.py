"""What is known beforehand, in the few directions about which the voyages tell."""

import numpy as np
import pytest

from twin.study.estimation.columns import Unknown
from twin.study.estimation.innovations import innovate
from twin.study.reference.directions import TELLS, directions
from twin.study.reference.evidence import Nuisance, posterior, reduce

C, Q = 12, 3  # numbers of the nuisance, and of the effects


def equations():
    """Normal equations of columns that are alike in part, with a nuisance of which some is known well and
    some not."""
    rng = np.random.default_rng(7)
    G = rng.normal(size=(60, C + Q)) * np.geomspace(3.0, 1e-3, C + Q)[rng.permutation(C + Q)]
    e = rng.normal(size=60)
    unknowns = tuple(
        Unknown("core" if i < C else "Effect", str(i), "", 0.0, 1.0, -9.0, 9.0) for i in range(C + Q)
    )
    root = rng.normal(size=(C, C))
    information = root @ root.T + np.eye(C)
    return G, e, unknowns, Nuisance(unknowns[:C], information, information @ rng.normal(size=C))


class Told:
    """As much of `Normal` as `reduce` reads."""

    def __init__(self, G, e):
        self.A, self.b, self.ee, self.logdet = G.T @ G, G.T @ e, float(e @ e), np.zeros(1)

    def total(self):
        return self.A, self.b, self.ee


def test_the_effects_are_what_they_were_and_as_likely():
    G, e, unknowns, nuisance = equations()
    along = directions(G.T @ G, nuisance, unknowns, 1.5)
    few = np.column_stack([G[:, list(along.place)] @ along.columns, G[:, C:]])
    before = reduce(Told(G, e), nuisance, unknowns, unknowns[C:], 1.5)
    after = reduce(Told(few, e), along.nuisance, (*along.nuisance.unknowns, *unknowns[C:]), unknowns[C:], 1.5)
    assert 1 < len(along.nuisance.unknowns) < C
    assert posterior(after, ("Effect",)).z == pytest.approx(posterior(before, ("Effect",)).z, abs=0.02)
    for chosen in ((), ("Effect",)):  # evidence, too: hypotheses are compared whichever way they were judged
        told, as_before = (posterior(r, chosen).log_evidence for r in (after, before))
        assert told == pytest.approx(as_before, abs=0.5 * C * TELLS)


def test_what_is_not_asked_about_stays_where_it_is_expected():
    G, _, unknowns, nuisance = equations()
    along = directions(0.0 * G.T @ G, nuisance, unknowns, 1.5)
    assert len(along.nuisance.unknowns) == 1
    assert along.columns[:, 0] == pytest.approx(np.linalg.solve(nuisance.information, nuisance.pull))


def test_the_usual_amount_of_what_is_chosen_is_no_direction():
    _, _, unknowns, nuisance = equations()
    owned = tuple(
        Unknown("Effect", u.name, "", 0.0, 1.0, -9.0, 9.0) if i < 2 else u
        for i, u in enumerate(nuisance.unknowns)
    )
    along = directions(
        1e6 * np.eye(C + Q),
        Nuisance(owned, nuisance.information, nuisance.pull),
        (*owned, *unknowns[C:]),
        1.5,
        ("Effect",),
    )
    assert along.columns.shape == (C, 1 + C - 2)
    assert not along.columns[:2, 1:].any()


def test_a_case_of_few_columns_tells_of_its_effects_what_the_whole_case_tells(case_of):
    case = case_of("RudderWear")
    few, kept = case.along(case.lines)
    assert kept.all() and len(few.unknowns) < len(case.unknowns)
    whole, small = (
        posterior(c.reduced(c.lines, c.scenarios(["usual"]))[0], ("RudderWear",)) for c in (case, few)
    )
    assert small.z == pytest.approx(whole.z, abs=0.05)
    assert small.log_evidence == pytest.approx(whole.log_evidence, abs=0.5)
    column = [u.label for u in case.unknowns].index("RudderWear.loss")
    lines = innovate(few.lines, few.scenarios(["usual"]))[0].A.shape[-1]
    assert (
        lines == len(few.unknowns)
        and few.lines[0].A[..., -len(few.effects) :].any()
        and case.lines[0].A[..., column].any()
    )
