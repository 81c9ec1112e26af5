"""The named effects' numbers on board: they arrive where they should, never leave their boxes, and stand
still when they should."""

import json
import random
from math import isfinite, sin

import pytest

from twin.live.learning.adapt import Adaptation
from twin.live.learning.adapted_row import SIZES
from twin.live.learning.learned_force import LearnedForce, scale_of
from twin.live.learning.movable import movable
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Force

DT = 0.5
# what one prior deviation of each number does, in units of the force scale
MOTION = ((0.1, 0.5, 0.45), (0.4, 0.05, 0.02))


@pytest.fixture(scope="module")
def worn():
    ship = load("kvlcc2")
    return ship.with_effects(find("RudderWear")(loss=0.15), find("HullFouling")(extra=0.2))


def made(ship, rows=True):
    return Adaptation(ship, scale_of(ship), 2, rows)


def columns(t):
    """Of loss and extra: (surge, sway, yaw) each, as in manoeuvres."""
    swing = (sin(t / 45.0), 0.8 + 0.3 * sin(t / 61.0 + 1.0))
    return [[size * x for size in sizes] for x, sizes in zip(swing, MOTION, strict=True)]


def teach(adaptation, truth, seconds=4000, noise=0.1, seed=1, frozen="", lie=lambda k, d: d, start_s=0.0):
    """Feed what is missing when the numbers truly are `truth` (in prior deviations from the file's)."""
    dice = random.Random(seed)
    for k in range(int(seconds / DT)):
        t = start_s + DT * k
        c = columns(t)
        q = (
            [
                sin(t / 40.0),
                sin(t / 27.0 + 1.0),
                *(0.3 * sin(t / (33.0 + 5 * i) + i) for i in range(3 * SIZES)),
            ]
            if adaptation._rows
            else []
        )
        q = q if q else [0.0] * (2 + 3 * SIZES)
        d = [
            sum(x * line[r] for x, line in zip(truth, c, strict=True)) + noise * dice.gauss(0.0, 1.0)
            for r in range(3)
        ]
        adaptation.learn(tuple(lie(k, d)), [*q, *c[0], *c[1]], DT, frozen)
    return adaptation


def published(adaptation):
    return {p.name: p for p in adaptation.parameters()}


def test_both_numbers_arrive_in_their_own_units_with_intervals_that_hold_them(worn):
    found = published(teach(made(worn), (1.0, 0.8)))
    loss, extra = found["RudderWear.loss"], found["HullFouling.extra"]
    assert (
        abs(loss.value - 0.30) < 1.96 * loss.sigma < 0.05 and loss.status == "estimated" and loss.unit == "-"
    )
    assert abs(extra.value - 0.40) < 1.96 * extra.sigma < 0.1 and extra.status == "estimated"
    # two prior deviations from the file's, or the catalogue's end
    assert (loss.low, loss.high) == pytest.approx((0.0, 0.45))


def test_a_number_that_grows_is_followed(worn):
    adaptation = teach(made(worn), (0.0, 0.0), seconds=1200)
    assert abs(published(adaptation)["RudderWear.loss"].value - 0.15) < 0.02
    teach(adaptation, (1.0, 0.0), seconds=1500, seed=2, start_s=1200.0)
    assert abs(published(adaptation)["RudderWear.loss"].value - 0.30) < 0.02
    acting = {type(e).__name__: e for e in adaptation.named.effects}
    assert acting["RudderWear"].loss == pytest.approx(0.30, abs=0.03) and acting[
        "HullFouling"
    ].extra == pytest.approx(0.2, abs=0.02)


def test_without_a_network_the_effects_are_learned_alone(worn):
    adaptation = teach(made(worn, rows=False), (1.0, 0.0))
    assert set(published(adaptation)) == {"RudderWear.loss", "HullFouling.extra"}
    assert published(adaptation)["RudderWear.loss"].value == pytest.approx(0.30, abs=0.02)


def test_with_nothing_to_find_next_to_nothing_acts(worn):
    adaptation = made(worn)
    acted = []
    for part in range(40):
        teach(adaptation, (0.0, 0.0), seconds=100, seed=part, start_s=100.0 * part)
        acted.append(max(map(abs, adaptation.named.acting())))
    assert max(acted) < 0.15 and sum(acted) / len(acted) < 0.03  # prior deviations


def test_what_only_follows_the_moment_stays_behind_the_gate(worn):
    """Test: a force along the columns that wanders within half a ship length. Expected: hardly anything
    acts."""
    adaptation, dice, wander, acted = made(worn), random.Random(3), 0.0, []
    for k in range(6000):
        wander = 0.975 * wander + 0.15 * dice.gauss(0.0, 1.0)
        c = columns(DT * k)
        d = tuple(wander * c[0][r] for r in range(3))
        adaptation.learn(d, [0.0] * (2 + 3 * SIZES) + c[0] + c[1], DT, "")
        acted.append(adaptation.named.acting()[0] ** 2)
    assert sum(acted[1000:]) / len(acted[1000:]) < 0.15 * 0.15**2 / (1 - 0.975**2)


def test_the_rows_give_back_what_a_name_explains(worn):
    """Test: the rudder's size is a regressor of a row as well, and the force that misses is the worn
    rudder's. Expected: number and row together never give more than a quarter above what is missing, and at
    the end what is missing."""
    adaptation, dice = made(worn), random.Random(4)
    sway = 2 + SIZES + 1  # the rudder of the row
    for k in range(8000):
        t = DT * k
        c, q = (
            columns(t),
            [sin(t / 40.0), sin(t / 27.0 + 1.0)] + [0.2 * sin(t / (30.0 + i)) for i in range(3 * SIZES)],
        )
        q[sway], missing = -c[0][1] / 0.15, c[0][1]
        adaptation.learn(
            (c[0][0] + 0.05 * dice.gauss(0.0, 1.0), missing + 0.05 * dice.gauss(0.0, 1.0), c[0][2]),
            q + c[0] + c[1],
            DT,
            "",
        )
        given = adaptation.correction(q)[1] + adaptation.named.acting()[0] * c[0][1]
        if abs(missing) > 0.2:
            assert given / missing < 1.25
    assert published(adaptation)["RudderWear.loss"].value == pytest.approx(0.30, abs=0.02)
    assert given == pytest.approx(missing, abs=0.05)


@pytest.mark.parametrize("seed", range(3))
def test_M12_whatever_they_are_fed_they_stay_finite_and_in_their_boxes(worn, seed):
    """Test: columns at their ends, forces of any size and none. Expected: every value in its box at every
    step, effects that the catalogue accepts."""
    adaptation, dice = made(worn), random.Random(seed)
    wild = (-1e6, 1e6, 0.0, 1e300, -1e300, float("nan"), float("inf"))
    for _ in range(3000):
        c = [dice.choice((-5.0, 5.0, dice.uniform(-5.0, 5.0))) for _ in range(6)]
        d = tuple(dice.choice(wild) if dice.random() < 0.3 else dice.uniform(-50.0, 50.0) for _ in range(3))
        adaptation.learn(d, [0.0] * (2 + 3 * SIZES) + c, dice.choice((0.01, 0.1, 0.9)), "")
        for p in adaptation._of_effects():
            assert isfinite(p.value) and p.low <= p.value <= p.high and isfinite(p.sigma)
        for e in adaptation.named.effects:
            e.check(worn)
    assert 0.0 <= adaptation.named.gate <= 1.0


def test_outliers_and_drop_outs_do_not_lead_them_astray(worn):
    dice = random.Random(5)
    out = teach(
        made(worn),
        (1.0, 0.0),
        lie=lambda k, d: [x + 10.0 * dice.gauss(0.0, 1.0) * (dice.random() < 0.03) for x in d],
    )
    assert published(out)["RudderWear.loss"].value == pytest.approx(0.30, abs=0.04)
    holes = made(worn)
    for part in range(20):
        teach(
            holes, (1.0, 0.0), seconds=200, seed=part, start_s=200.0 * part, frozen="out" if part % 2 else ""
        )
    assert published(holes)["RudderWear.loss"].value == pytest.approx(0.30, abs=0.04)


def test_an_adversarys_square_waves_hardly_act(worn):
    lie = lambda k, d: [x + (1.0 if (k // p) % 2 else -1.0) for x, p in zip(d, (40, 55, 70), strict=True)]
    adaptation, acted = made(worn), []
    for part in range(40):
        teach(adaptation, (0.0, 0.0), seconds=100, seed=part, start_s=100.0 * part, lie=lie)
        acted.append(max(map(abs, adaptation.named.acting())))
    assert max(acted) < 0.7 and sum(acted) / len(acted) < 0.15


def test_while_frozen_and_without_a_manoeuvre_nothing_changes(worn):
    frozen = teach(made(worn), (1.0, 1.0), seconds=300, frozen="a sensor is out")
    assert frozen.named.x == [0.0, 0.0] and frozen.named.effects is worn.effects
    straight = made(worn)
    for _ in range(4000):
        straight.learn((0.3, 0.3, 0.3), [0.1] * (2 + 3 * SIZES) + [0.2] * 6, DT, "")
    assert "manoeuvre" in straight.frozen and max(map(abs, straight.named.acting())) < 0.3


def test_a_number_at_the_end_of_its_box_is_called_invalid(worn):
    found = published(teach(made(worn), (4.0, 0.0), noise=0.01))
    assert (
        found["RudderWear.loss"].value == found["RudderWear.loss"].high
        and found["RudderWear.loss"].status == "invalid"
    )


def test_M12_saved_numbers_come_back_clamped_and_must_prove_themselves_again(worn, tmp_path):
    adaptation = teach(made(worn), (1.0, 0.0))
    path = tmp_path / "adaptation.json"
    table = json.loads(adaptation.saved("mark"))
    table["effects"]["HullFouling.extra"] = 1e9
    path.write_text(json.dumps(table))
    again = made(worn)
    again.restore(path, "mark")
    found = published(again)
    assert found["RudderWear.loss"].value == pytest.approx(published(adaptation)["RudderWear.loss"].value)
    assert found["HullFouling.extra"].value == pytest.approx(found["HullFouling.extra"].high)
    assert (
        again.named.gate == 0.0
        and again.named.effects is worn.effects
        and found["RudderWear.loss"].status == "unestimated"
    )


@pytest.mark.parametrize(
    "effects",
    ({}, {"RudderWear.loss": float("nan"), "HullFouling.extra": 0.1}, {"RudderWear.loss": "x"}, [], None),
)
def test_M12_garbage_instead_of_numbers_is_left_out_and_said(worn, tmp_path, effects):
    path = tmp_path / "adaptation.json"
    path.write_text(json.dumps(json.loads(made(worn).saved("mark")) | {"effects": effects}))
    adaptation = made(worn)
    adaptation.restore(path, "mark")
    assert adaptation.named.x == [0.0, 0.0] and "begins anew" in adaptation.notes[0]


def test_in_the_loop_a_worn_rudder_is_found_and_acts_in_the_known_force(kvlcc2, make_bridge):
    """Test: a rudder that lost 0.5 where the ship file says 0.3, a zigzag, no network. Expected: the number
    grows to the truth, the force that is published as known is that of the number, the mode stays physics
    only."""
    ship = kvlcc2.with_effects(find("RudderWear")(loss=0.3))
    learned = LearnedForce(ship, None, "none in this test")
    bridge = make_bridge(ship, loop={"learned": learned}, noise=0.2)
    bridge.sailing.model = Model.of(kvlcc2.with_effects(find("RudderWear")(loss=0.5)))
    ticks = bridge.run(900.0)
    said = {p.name: p for tick in ticks[-20:] for p in tick.parameters}
    assert (
        said["RudderWear.loss"].value == pytest.approx(0.5, abs=0.05)
        and said["RudderWear.loss"].status == "estimated"
    )
    forces = {f.name: f for f in ticks[-1].known}
    acting = learned.effects[0].loss
    assert (
        forces["RudderWear"].N_Nm == pytest.approx(-acting * forces["rudder"].N_Nm, rel=1e-6) and acting > 0.4
    )
    assert ticks[-1].mode == "physics only"


def test_a_ship_without_effects_and_network_learns_nothing_and_pays_nothing(kvlcc2, make_bridge):
    learned = LearnedForce(kvlcc2, None, "none in this test")
    make_bridge(loop={"learned": learned}).run(20.0)
    assert learned.adaptation is None and not learned.evidence.ready and movable(kvlcc2.effects, kvlcc2) == ()


def test_the_learned_forces_scale_is_the_columns_scale(worn):
    """Expected: one prior deviation of the loss shows in `shift` as its columns say."""
    adaptation = teach(made(worn), (1.0, 0.0))
    c = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]
    acting = adaptation.named._acting[0]
    assert adaptation.named.shift(c) == pytest.approx((acting, 2.0 * acting, 3.0 * acting)) and acting > 0.8
    assert isinstance(scale_of(worn), Force)
