"""Learning on board: it finds what is planted, it never leaves its bounds, and it stands still when it
should."""

import json
import random
from math import isfinite, sin

import pytest

from tests.thorough import thorough
from twin.live.learning.adapt import A_MAX, Adaptation
from twin.live.learning.learned_force import LearnedForce, scale_of
from twin.live.learning.residual import bundled, load
from twin.physics.state import Force


def made(ship, components=2):
    return Adaptation(ship, scale_of(ship), components)


def known(ship, hull=(0.5, 0.5, 0.5), rudder=(0.0, 0.3, 0.3)):
    S = scale_of(ship)
    sized = [Force(*(h * s for h, s in zip(f, S, strict=True))) for f in (hull, rudder)]
    return [sized[0], Force(), Force(0.4 * S.X), sized[1]]  # in the order of the core


def teach(adaptation, ship, truth, seconds=4000, dt=0.5, noise=0.1, seed=1, frozen=""):
    """Feed truth(row, its regressors) + noise; the regressors move as in manoeuvres."""
    dice = random.Random(seed)
    for k in range(int(seconds / dt)):
        t = dt * k
        forces = known(
            ship,
            hull=(0.5, 0.6 * sin(t / 35.0), 0.5 * sin(t / 30.0)),
            rudder=(0, sin(t / 50.0), sin(t / 45.0)),
        )
        q = adaptation.regressors([sin(t / 40.0), sin(t / 27.0 + 1.0)], forces)
        d = tuple(truth(r, adaptation._of_row(r, q)) + noise * dice.gauss(0.0, 1.0) for r in range(3))
        adaptation.learn(d, q, dt, frozen)
    return q


def test_it_finds_a_hull_force_that_is_20_percent_off(kvlcc2):
    adaptation = made(kvlcc2)
    teach(adaptation, kvlcc2, lambda r, q: 0.2 * q[2])
    found = {p.name: p for p in adaptation.parameters()}
    assert found["sway hull"].value == pytest.approx(0.2, abs=0.06)
    assert found["sway hull"].status == "estimated"


BEFORE = {  # what the law learned of this stream before it knew of the effects' numbers, to the last bit
    "surge hull": 0.197467375767115,
    "surge propeller": -0.0005763422988400406,
    "sway rudder": -0.09775649023860748,
    "yaw feature 2": 0.0017137539413891632,
    "yaw constant": -0.0007259170573265312,
}


def test_a_ship_without_effects_learns_bit_for_bit_what_she_did(kvlcc2):
    """Test: a stream made of sums and products alone, the same on every machine. Expected: the numbers of the
    law of before."""
    adaptation, S, dice, walk = made(kvlcc2), scale_of(kvlcc2), random.Random(5), [0.0] * 8
    for _ in range(3000):
        walk = [0.98 * x + 0.3 * (dice.random() - 0.5) for x in walk]
        hull, rudder = (
            Force(S.X * walk[0], S.Y * walk[1], S.N * walk[2]),
            Force(0.0, S.Y * walk[4], S.N * walk[5]),
        )
        q = adaptation.regressors(walk[6:], [hull, Force(), Force(0.4 * S.X + S.X * walk[3]), rudder])
        noise = [0.1 * (dice.random() - 0.5) for _ in range(3)]
        adaptation.learn(
            (0.2 * walk[0] + noise[0], 0.2 * walk[1] - 0.1 * walk[4] + noise[1], 0.1 * walk[5] + noise[2]),
            q,
            0.5,
            "",
        )
    found = {p.name: p.value for p in adaptation.parameters()}
    assert {name: found[name] for name in BEFORE} == BEFORE
    assert adaptation.correction(q) == (0.07604378070045646, 0.16832388416106928, -0.005521047532571734)
    assert not adaptation.named and adaptation.named.effects == ()


def test_with_nothing_to_find_the_gate_stays_shut(kvlcc2):
    adaptation = made(kvlcc2)
    rows = teach(adaptation, kvlcc2, lambda r, q: 0.0)
    assert max(abs(x) for x in adaptation.correction(rows)) < 0.02
    assert {p.status for p in adaptation.parameters()} == {"unestimated"}


def test_M12_whatever_it_is_fed_it_stays_finite_and_inside_its_bounds(kvlcc2):
    """Test: hostile regressors and forces. Expected: every number in its box, the whole in the ball,
    nothing that is no number."""
    adaptation = made(kvlcc2)
    dice = random.Random(7)
    for _ in range(4000):
        q = [dice.choice((-3.0, 3.0)) for _ in range(2)]
        rows = adaptation.regressors(q, known(kvlcc2, hull=[dice.uniform(-1e3, 1e3) for _ in range(3)]))
        d = tuple(dice.choice((-1e6, 1e6, 0.0, 1e300)) for _ in range(3))
        adaptation.learn(d, rows, dice.choice((0.01, 0.1, 0.9)), "")
        assert adaptation.norm() <= A_MAX + 1e-12
    for p in adaptation.parameters():
        assert isfinite(p.value) and p.low <= p.value <= p.high and isfinite(p.sigma)
    assert all(isfinite(x) for x in adaptation.correction(rows))


def test_a_number_at_its_bound_is_called_invalid(kvlcc2):
    adaptation = made(kvlcc2)
    teach(adaptation, kvlcc2, lambda r, q: 0.6 * q[2], noise=0.01)
    assert "invalid" in {p.status for p in adaptation.parameters()}


def test_while_frozen_nothing_changes(kvlcc2):
    adaptation = made(kvlcc2)
    teach(adaptation, kvlcc2, lambda r, q: 0.2 * q[2], seconds=200, frozen="a sensor is out")
    assert adaptation.updates == 0 and adaptation.norm() == 0.0 and adaptation.frozen == "a sensor is out"


def test_without_a_manoeuvre_there_is_nothing_to_learn_from(kvlcc2):
    adaptation = made(kvlcc2)
    rows = adaptation.regressors([0.1, 0.2], known(kvlcc2))
    for _ in range(4000):
        adaptation.learn((0.3, 0.3, 0.3), rows, 0.5, "")
    assert "manoeuvre" in adaptation.frozen and adaptation.norm() < 0.2


def test_M12_saved_numbers_come_back_clamped_and_must_prove_themselves_again(kvlcc2, tmp_path):
    adaptation = made(kvlcc2)
    rows = teach(adaptation, kvlcc2, lambda r, q: 0.2 * q[2])
    path = tmp_path / "adaptation.json"
    table = json.loads(adaptation.saved("mark"))
    table["rows"][0]["a"][0] = 1e9
    path.write_text(json.dumps(table))
    again = made(kvlcc2)
    again.restore(path, "mark")
    values = {p.name: p.value for p in again.parameters()}
    assert values["sway hull"] == pytest.approx(
        {p.name: p.value for p in adaptation.parameters()}["sway hull"]
    )
    assert values["surge feature 1"] <= 0.5 and again.correction(rows) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "text",
    (
        "",
        "{",
        "[]",
        '{"mark": "mark", "rows": [1, 2, 3]}',
        '{"mark": "mark", "rows": []}',
        '{"mark": "mark", "rows": [{"a": [NaN]}, {}, {}]}',
        f'{{"mark": "mark", "rows": [{{"a": [{10**400}]}}, {{}}, {{}}]}}',
        "[" * 100_000,
    ),
)
def test_M12_a_garbage_file_is_left_out_and_said(kvlcc2, tmp_path, text):
    path = tmp_path / "adaptation.json"
    path.write_text(text)
    adaptation = made(kvlcc2)
    adaptation.restore(path, "mark")
    assert adaptation.norm() == 0.0 and "begins anew" in adaptation.notes[0]


def test_M12_numbers_of_another_network_are_left_out(kvlcc2, tmp_path):
    path = tmp_path / "adaptation.json"
    path.write_text(made(kvlcc2).saved("theirs"))
    adaptation = made(kvlcc2)
    adaptation.restore(path, "mine")
    assert "another ship or network" in adaptation.notes[0]


@thorough
def test_it_learns_from_a_ship_whose_rudder_is_weaker_than_the_model_thinks(kvlcc2, make_bridge):
    """Test: a rudder of 80 % in a zigzag, perfect instruments. Expected: the yaw error falls, the
    correction is small and named."""
    from dataclasses import replace

    from twin.physics.model import Model

    learned = LearnedForce(kvlcc2, load(bundled(kvlcc2), kvlcc2))
    bridge = make_bridge(loop={"learned": learned}, noise=0.2)
    bridge.sailing.model = Model.of(replace(kvlcc2, A_R=0.8 * kvlcc2.A_R))
    bridge.run(700.0)
    values = {p.name: p.value for p in learned.adaptation.parameters()}
    assert values["yaw rudder"] < -0.02
    assert learned.adaptation.updates > 1000


def test_what_only_follows_the_moment_stays_behind_the_gate(kvlcc2):
    """Test: an unexplained force that wanders by itself within half a ship length, and tells nothing of the
    next. Expected: the gate asks the numbers of a while ago, and they do not help: hardly anything acts, at
    any time."""
    adaptation, dice, wander = made(kvlcc2), random.Random(3), [0.0, 0.0, 0.0]
    acted = []
    for k in range(6000):
        t = 0.5 * k
        wander = [0.975 * x + 0.05 * dice.gauss(0.0, 1.0) for x in wander]
        forces = known(
            kvlcc2,
            hull=(0.5, 0.6 * sin(t / 35.0), 0.5 * sin(t / 30.0)),
            rudder=(0, sin(t / 50.0), sin(t / 45.0)),
        )
        q = adaptation.regressors([sin(t / 40.0), sin(t / 27.0 + 1.0)], forces)
        adaptation.learn(tuple(wander), q, 0.5, "")
        acted.append(sum(x * x for x in adaptation.correction(q)))
    assert sum(acted[1000:]) / len(acted[1000:]) < 0.15 * 3 * 0.05**2 / (1 - 0.975**2)
