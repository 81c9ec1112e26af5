"""A stream that hardly changes is a steady one."""

import numpy as np
import pytest

from twin.physics.effects.current import Current
from twin.physics.effects.varying_current import VaryingCurrent
from twin.physics.model import Model
from twin.study.diagnosis.case import SCENARIOS
from twin.study.diagnosis.refine import Found
from twin.study.diagnosis.search import Hypotheses
from twin.study.diagnosis.steady import EDDIES, changes, steady
from twin.study.reference.evidence import Hypothesis, posterior


@pytest.fixture(scope="module")
def case(case_of):
    return case_of("Current")


def test_what_changes_is_told_as_a_share_of_the_whole_stream(case):
    (track,) = case.tracks
    still, turning = VaryingCurrent(north=0.3, east=0.4), VaryingCurrent(north_c3=0.3)
    assert changes([still], case.model, case.tracks) == pytest.approx(0.0, abs=1e-6)
    north = 0.3 * np.cos(3.0 * 2.0 * np.pi / 3600.0 * track.t)
    assert changes([turning], case.model, case.tracks) == pytest.approx(
        north.std() / np.sqrt((north**2).mean())
    )


def judged(case, stream):
    """As if this stream had been found."""
    told = posterior(case.reduced(case.lines, case.scenarios(["usual"]))[0], ())
    hypothesis = Hypothesis((type(stream).__name__,), "usual", told.log_evidence, 0.0)
    return Found(hypothesis, told, Model(case.model.ship, (*case.model.effects, stream)))


def test_only_a_stream_that_may_change_and_does_not_is_called_steady(case):
    assert steady(case, judged(case, VaryingCurrent(north=0.4, north_c3=0.4 * EDDIES)))
    assert not steady(case, judged(case, VaryingCurrent(north=0.1, north_c3=0.4)))
    assert not steady(case, judged(case, Current(north=0.4)))


def test_a_stream_that_did_not_change_stays_in_the_weighing_and_a_steady_one_is_judged_beside_it(
    case, monkeypatch
):
    names = list(SCENARIOS)
    held = Hypotheses(case, dict(zip(names, case.reduced(case.lines, case.scenarios(names)), strict=True)))
    monkeypatch.setattr(
        "twin.study.diagnosis.search.steady", lambda case, found: "VaryingCurrent" in found.hypothesis.effects
    )
    held.judge(("VaryingCurrent",))
    assert held.found["VaryingCurrent",].steady
    assert any(s == ("VaryingCurrent",) for s, _ in held.entries)
    assert held.next() == ("Current",)
