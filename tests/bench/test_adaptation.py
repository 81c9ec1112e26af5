"""Laws of adaptation: each finds what is planted, and none is led astray by lies."""

from math import sin

import numpy as np
import pytest

from bench import bench_output
from bench.adaptation import laws
from bench.adaptation.laws_compared import CHANGE_S, LIES, ROUND_S, changes
from bench.adaptation.page import figure, page
from twin.live.learning.adapt import A_MAX, Adaptation
from twin.live.learning.adapted_row import SIZES
from twin.live.learning.learned_force import scale_of
from twin.physics.ship import load

ALL = (laws.Gradient, laws.EModified, laws.DeadZone, laws.Recursive, laws.Kalman, Adaptation)
STEPS, DT = 1200, 1.25


@pytest.fixture(scope="module")
def ship():
    return load("kvlcc2")


def stream(planted, seed=1, noise=0.02):
    """What a law is told: each row's first known force is off by `planted`."""
    rng, out = np.random.default_rng(seed), []
    for k in range(STEPS):
        t = k * DT
        q = [
            sin(t / 40.0),
            sin(t / 27.0 + 1.0),
            *(0.5 * sin(t / (35.0 + 7 * i) + i) for i in range(3 * SIZES)),
        ]
        out.append(
            (tuple(planted * q[2 + SIZES * r] + noise * rng.standard_normal() for r in range(3)), q, DT, "")
        )
    return out


def taught(law, ship, told):
    made = law(ship, scale_of(ship), 2)
    for step in told:
        made.learn(*step)
        assert made.norm() <= A_MAX + 1e-9
    return made


@pytest.mark.parametrize("law", ALL)
def test_every_law_comes_nearer_to_what_is_planted(law, ship):
    """Expected: with what was learned, what it is told later is explained better than by nothing."""
    made, later = taught(law, ship, stream(0.2)), stream(0.2, seed=2)[-400:]
    left = [np.subtract(wanted, made.correction(q)) for wanted, q, _, _ in later]
    assert np.square(left).mean() < 0.9 * np.square([wanted for wanted, *_ in later]).mean()


@pytest.mark.parametrize("lie", LIES)
@pytest.mark.parametrize("law", ALL)
def test_no_lie_makes_a_law_diverge(law, lie, ship):
    """Test: noise, outliers, drop-outs, an adversary, stuck readings. Expected: finite, inside the ball at
    every step."""
    made = taught(law, ship, LIES[lie]([stream(0.1)])[0])
    assert np.isfinite(made.numbers()).all()


def test_drop_outs_freeze_and_the_rest_still_teaches(ship):
    told = LIES["drop-outs"]([stream(0.2)])[0]
    made = taught(Adaptation, ship, told)
    assert 0 < made.updates < STEPS and made.numbers()[1][2] == pytest.approx(0.2, abs=0.05)


def test_every_change_in_the_middle_comes_when_the_windows_expect_it():
    """Expected: one window ends where the change begins, the others begin at it or later; asked of a fouled,
    a heavier and a held ship and of a step of wind."""
    made = changes()
    assert {c.at_s for c in made.values() if c} == {CHANGE_S} and made["as it is"] is None
    assert ROUND_S[0] + 120.0 == CHANGE_S == ROUND_S[1] and sorted(ROUND_S) == list(ROUND_S)
    for word in ("mass", "damping", "fouling", "wind"):
        assert any(word in name for name in made)


def test_the_page_holds_every_change_and_keeps_what_was_written_by_hand(tmp_path):
    cell = {
        "heading_deg": 0.1,
        "lateral_m": 1.0,
        "heading_early_deg": 0.2,
        "lateral_early_m": 2.0,
        "largest_A": 0.3,
    }
    one = {"heading_deg": [0.1] * 9, "lateral_m": [1.0] * 9, "by_scenario_deg": {"TS-01": 0.1}}
    way = {
        "heading_deg": [0.1],
        "lateral_m": [1.0],
        "late_heading_deg": [0.1, 0.2],
        "late_lateral_m": [1.0, 1.0],
    }
    number = {"label": "RudderWear.loss", "file": 0.15, "truth": 0.3, "held": 0.9} | {
        k: {"TS-01": [0.2]} for k in ("value", "half_95", "spread")
    }
    growth = {"how": {"off": way, "rows alone": way, "on": way}, "number": number}
    result = {
        "seeds": 1,
        "full": False,
        "voyages": 6,
        "change_s": CHANGE_S,
        "starts_s": ROUND_S,
        "changed": {"none": {"as it is": cell}},
        "lies": {"none": {"stuck": cell}},
        "midway": {name: {"off": one, "on": one, "told": one} for name in changes()},
        "named": {
            "seeds": 2,
            "change_s": 300.0,
            "late_s": 600.0,
            "starts_s": (180.0,),
            "growths": {"grows": growth},
        },
    }
    text = "\n".join(page(result))
    assert all(f"| {name}, on |" in text for name in changes())
    figure(result, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    (tmp_path / "a.md").write_text("old tables\n## What it says\n\nmine\n")
    assert (
        bench_output.kept(tmp_path / "a.md") == "\n## What it says\n\nmine\n"
        and bench_output.kept(tmp_path / "none.md") == ""
    )


def test_a_law_that_is_told_of_a_change_forgets_once_and_learns_on(ship):
    """Test: 0.2 off for twenty-five minutes, told at twenty. Expected: until then the law on board, then as
    one that began there."""
    told, board, fresh = (
        laws.ForgettingLaw(ship, scale_of(ship), 2, at_s=1200.0),
        *(Adaptation(ship, scale_of(ship), 2) for _ in range(2)),
    )
    for k, step in enumerate(stream(0.2)):
        told.learn(*step), board.learn(*step)
        if k < 959:
            assert told.numbers() == board.numbers()
        else:
            fresh.learn(*step)
    assert told.numbers() == fresh.numbers() != board.numbers()
