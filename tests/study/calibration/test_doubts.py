"""What a calibration says is doubtful."""

from dataclasses import replace

import pytest

from twin.num import num
from twin.physics.model import Model
from twin.study.calibration.doubts import doubts, doubts_of, resistance_of
from twin.study.estimation.columns import core_unknowns
from twin.study.reference.derivatives import Derivative, by_particulars, first_prior, with_derivatives

FELL = {"horizon_s": 60.0, "windows": 9, "position_m": 1.0, "before_m": 2.0}
FELL |= {"heading_deg": 1.0, "before_deg": 2.0}


def told(between):
    """The sentences about numbers that differ by so many prior widths from voyage to voyage."""
    return doubts([], [FELL], (0.03, 0.03, 0.03), between=between)


@pytest.mark.parametrize(("lift", "lines"), [(-1.45e-5, 1), (-0.12, 0)])
def test_a_hull_without_lift_is_doubtful(lift, lines):
    """Found on a catamaran that its owner had simulated with a lift of -0.42."""
    lifts = {"name": "Y_uv", "value": lift, "sd": 0.0098, "before": -0.3364, "excited": True}
    said = doubts([lifts], [FELL], (0.03, 0.03, 0.03))
    assert len(said) == lines
    assert all(
        s.startswith("Y_uv is as good as none (-0.34 by") and "drift pushes it aside" in s for s in said
    )


def test_only_faults_are_said_to_be_hard_to_see():
    """Test: what waves do at once, the core's form and how late instruments are differ as much as an effect.
    Expected: the effect alone is told: the others are no faults that could be seen."""
    inner = {"core.N_vdot": 1.6, "core.port.gain": 1.6, "form.X_u4": 1.6, "late.log": 1.6}
    inner |= {"sea.helm": 1.6, "rough.yaw": 1.6}
    assert told(inner) == []
    assert told({"Current.north": 1.6}) == []  # a stream is another one every day
    (one,) = told(inner | {"SteeringLag.delay": 1.6})
    assert one.startswith("SteeringLag.delay (1.6 times its usual width) differs so much")
    assert "sea." not in one


def test_several_of_them_are_said_in_the_plural():
    (both,) = told({"SteeringLag.delay": 1.6, "PropellerWalk.c_n": 1.2, "Wind.c_x": 0.4})
    assert "SteeringLag.delay (1.6 times its usual width), PropellerWalk.c_n" in both
    assert "differ so much" in both and "Wind.c_x" not in both


@pytest.mark.parametrize(
    ("voyages", "begins"), [(1, ["1 reference voyage: "]), (4, ["4 reference voyages: "]), (5, [])]
)
def test_few_reference_voyages_are_said_to_be_few(voyages, begins):
    said = doubts([], [FELL], (0.03, 0.03, 0.03), voyages=voyages)
    assert len(said) == len(begins) and all(s.startswith(b) for s, b in zip(said, begins, strict=True))


@pytest.mark.parametrize(("after_n", "lines"), [(66.2e3, 1), (0.34 * 662e3, 0), (766e3, 0)])
def test_a_hull_without_resistance_is_doubtful(after_n, lines):
    """Found on a ferry whose pitch was changed at constant turns, and was not in the map."""
    said = doubts([], [FELL], (0.03, 0.03, 0.03), resistance=(662e3, after_n))
    assert len(said) == lines
    assert all("10 % is left (66.2 kN; by the particulars 662 kN)" in s and "pitch" in s for s in said)


def test_the_resistance_of_a_ship_is_that_of_its_hull_at_service_speed(kvlcc2):
    """Expected: X_uu alone, by hand."""
    bare = replace(kvlcc2, derivatives=replace(kvlcc2.derivatives, X_u=0.0, X_uuu=0.0))
    by_hand = -0.5 * bare.rho * bare.L_pp * bare.T * bare.derivatives.X_uu * bare.U_0**2
    assert resistance_of(bare) == pytest.approx(by_hand)


def fitted(ship, share):
    """The ship after a calibration that leaves such shares of what its derivatives were, and what it tells."""
    own = {u.name: first_prior(u, ship) for u in core_unknowns(Model.of(ship)) if u.name in share}
    before = {name: float(ship.derivative(name)) for name in own}
    after = with_derivatives(
        ship, [Derivative(u, share[n] * before[n], 0.01 * abs(u.centre), 0.9) for n, u in own.items()]
    )
    rows = [
        {"name": n, "before": before[n], "value": share[n] * before[n], "sd": 0.01, "excited": True}
        for n in own
    ]
    said = {"derivatives": rows, "held_out": [FELL], "usual": [], "between_voyages": {}}
    return after, doubts_of(said | {"floor": {"share": (0.03, 0.03, 0.03)}}, ship, after, 5)


def test_a_ship_that_is_calibrated_again_is_still_held_against_its_particulars(kvlcc2):
    """Test: a calibration that leaves a hundredth of resistance and lift, and a second one that leaves that nearly
    as it is. Expected: both say so, of the same numbers by the particulars."""
    bare = replace(kvlcc2, derivatives=replace(kvlcc2.derivatives, X_u=0.0, X_uuu=0.0))
    once, said = fitted(bare, {"X_uu": 0.009, "Y_uv": 0.009})
    again, said_again = fitted(once, {"X_uu": 0.95, "Y_uv": 0.95})
    kN = f"by the particulars {num(resistance_of(bare) / 1e3, 3)} kN"
    for lines in (said, said_again):
        *_, lift, resistance = lines
        assert lift.startswith("Y_uv is as good as none (") and kN in resistance
    assert by_particulars(again).derivatives == bare.derivatives
