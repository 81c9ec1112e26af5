"""Facts about the causes of an explanation."""

from types import SimpleNamespace

import numpy as np
import pytest

from twin.physics.effects import catalogue
from twin.study.diagnosis.consider import stilled, without_hollow
from twin.study.diagnosis.facts import Cause

EXPLANATION = ("HullFouling", "RudderOffset", "SpeedLogBias")
KEPT = EXPLANATION[:2]


def cause(name, reached=None):
    return Cause(name, "ship", True, False, False, 0.9, 0.9, 20.0, 20.0, 0.1, 5.0, 1.0, reached)


def case_in_which(**sizes):
    """A case, and the set of the two causes of the ship fitted to these sizes."""
    case = SimpleNamespace(
        effects=[SimpleNamespace(owner=name, name="size") for name in EXPLANATION],
        catalogue={name: SimpleNamespace(size="") for name in EXPLANATION},
    )
    z = np.array([sizes.get(name, 0.0) for name in EXPLANATION])
    return case, {KEPT: SimpleNamespace(posterior=SimpleNamespace(z=z))}


@pytest.mark.parametrize(
    "log_as_before, fouling, explains",
    [
        (1.0, 0.0, ["RudderOffset", "SpeedLogBias"]),  # fouling only made good what the log took
        (1.0, 1.2, [*EXPLANATION]),
        (None, 0.0, [*EXPLANATION]),  # nothing is taken out of the explanation
    ],
)
def test_a_cause_that_ends_at_nothing_without_an_instrument_that_is_as_it_was_explains_nothing(
    log_as_before, fouling, explains
):
    case, found = case_in_which(HullFouling=fouling, RudderOffset=2.0)
    causes = [*map(cause, KEPT), cause("SpeedLogBias", log_as_before)]
    told = without_hollow(case, found, EXPLANATION, causes)
    assert [c.effect for c in told if c.in_explanation] == explains
    assert without_hollow(case, {}, EXPLANATION, causes) == causes  # nobody fitted what is left


@pytest.mark.parametrize(
    "steady, others, told",
    [
        (True, [("Current", "RudderWear")], ("Current", "RudderWear")),
        (False, [("Current", "RudderWear")], ("VaryingCurrent", "RudderWear")),
        (True, [], ("VaryingCurrent", "RudderWear")),  # nobody fitted the steady one
    ],
)
def test_a_stream_that_did_not_change_is_held_against_the_references_as_the_steady_one(steady, others, told):
    """Test: the likeliest set has a stream that may change. Expected: where it did not, the set with the steady
    stream says how much of it the references had, and how much nearer the path is with it."""
    held = ("VaryingCurrent", "RudderWear")
    found = {held: SimpleNamespace(steady=steady)} | {s: SimpleNamespace(steady=False) for s in others}
    case = SimpleNamespace(catalogue=catalogue(), ordered=lambda names: tuple(sorted(names)))
    assert set(stilled(case, found, held)) == set(told)
