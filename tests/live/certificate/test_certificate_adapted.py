"""The certificate of a ship whose effects' numbers move on board: everything holds wherever in their boxes
they are."""

from math import pi, sin

import numpy as np
import pytest

from twin.live.certificate import certificate as cert
from twin.live.certificate.certificate import certify
from twin.live.certificate.enclosure import contribution, points_of, sampled, situation_of, slopes
from twin.live.certificate.observer_tube import Tube
from twin.live.certificate.store import kept
from twin.live.learning.movable import adaptable, movable, moved
from twin.live.observer.estimate import gain_for
from twin.physics.effects import BUILT_IN, find
from twin.physics.model import CORE, Model
from twin.physics.ship import load
from twin.physics.state import Situation

SHIP = load("kvlcc2")
KINDS = [kind for kind in BUILT_IN if adaptable(kind.plausible(SHIP))]
QUIET = {"noise": (0.0, 0.0, 0.0), "disturbance": (0.0, 0.0, 0.0)}


def models(model, numbers, count):
    """The model at the corners where all numbers are low or high, and anywhere between."""
    rng = np.random.default_rng(1)
    shares = [np.zeros(len(numbers)), np.ones(len(numbers)), *rng.random((count, len(numbers)))]
    for share in shares:
        yield Model(
            model.ship,
            moved(
                model.effects,
                numbers,
                [m.low + x * (m.high - m.low) for m, x in zip(numbers, share, strict=True)],
            ),
        )


@pytest.mark.parametrize("Kind", KINDS, ids=lambda kind: kind.__name__)
def test_slopes_and_distance_hold_for_every_number_in_its_box(Kind):
    """Test: the equations of motion at random numbers and motions. Expected: slopes inside the sure ones, and
    nu_dot no further from that of the ship file's numbers than `moved` says."""
    model = Model.of(SHIP).but(Kind.plausible(SHIP))
    numbers, ranges = movable(model.effects, SHIP), {**cert.of_ship(model).ranges, "stream": (0.0, 0.0)}
    sure = slopes(model, ranges, dict.fromkeys(ranges, 3), numbers)
    s, names = situation_of(points_of(ranges, 1000, 2)), frozenset((*CORE, Kind.__name__))
    start = [x.value for x in contribution(model, s, names)]
    furthest = np.zeros(3)
    for other in models(model, numbers, 6):
        seen = sampled(other, ranges, count=500)
        for i in range(3):
            for j in range(4):
                assert sure.lo[i][j] <= seen.lo[i][j] <= seen.hi[i][j] <= sure.hi[i][j]
        away = [np.abs(x.value - y).max() for x, y in zip(contribution(other, s, names), start, strict=True)]
        furthest = np.maximum(furthest, away)
    assert (furthest <= np.array(sure.moved) * (1.0 + 1e-9)).all() and furthest.max() > 0.0
    assert np.isfinite(sure.lo).all() and np.isfinite(sure.moved).all()


def test_a_ship_without_effects_has_the_certificate_she_had():
    plain = Model.of(SHIP)
    assert certify(plain, 0.3, 0.1, adapted=True) == certify(plain, 0.3, 0.1)


@pytest.mark.parametrize("Kind", KINDS, ids=lambda kind: kind.__name__)
def test_each_effect_may_move_and_the_usual_gain_of_a_tanker_still_holds(Kind):
    """Expected: a bound, and a wider one: what moves has its price."""
    model = Model.of(SHIP).but(Kind.plausible(SHIP))
    still, moving = (certify(model, gain_for(SHIP), 0.1, adapted=a) for a in (False, True))
    assert (
        moving.ok
        and all(a <= b for a, b in zip(still.bound, moving.bound, strict=True))
        and moving.margin <= still.margin
    )
    assert sum(moving.plant.moved) > 0.0 == sum(still.plant.moved)


def test_a_certificate_of_numbers_that_stand_still_is_not_taken_for_one_of_numbers_that_move(tmp_path):
    model, path = Model.of(SHIP).but(find("RudderWear")(loss=0.2)), tmp_path / "c.json"
    still = kept(path, model, 0.3, 0.1, adapted=False)
    moving = kept(path, model, 0.3, 0.1, adapted=True)
    assert moving.fingerprint != still.fingerprint and moving.bound[2] > still.bound[2]
    assert kept(path, model, 0.3, 0.1, adapted=True) == moving


def run(certificate, model, numbers, seconds=150.0, h=0.1):
    """Whether an observer stays inside the tube whose numbers an adversary moves: each sample to the end of
    its box that makes the yaw error grow. Measurements are exact; nothing else is wrong."""
    ends = [
        Model(model.ship, moved(model.effects, numbers, [getattr(m, e) for m in numbers]))
        for e in ("low", "high")
    ]
    tube, K, largest = Tube(certificate, start=(1e-6, 1e-6, 1e-9)), certificate.K, np.zeros(3)
    state, nu = (0.0, 0.0, 0.0, 0.75 * SHIP.U_0, 0.0, 0.0), np.array([0.75 * SHIP.U_0, 0.0, 0.0])
    for k in range(int(seconds / h)):
        delta = 0.6 * sin(2.0 * pi * k * h / 60.0)
        before = (*state[:3], *nu)
        state = model.step(state, Situation(delta=delta, n=1.2), h)
        tried = [np.array(m.step(before, Situation(delta=delta, n=1.2), h)[3:]) for m in ends]
        error = nu[2] - state[5]
        guess = max(tried, key=lambda x: (x[2] - state[5]) * (1.0 if error >= 0.0 else -1.0))
        nu = guess + h * np.array(K) * (np.array(state[3:]) - guess)
        beta = tube.step((True, True, True))
        at = Situation(u=state[3], v=state[4], r=state[5], u_r=state[3], v_r=state[4], delta=delta, n=1.2)
        assert certificate.operating.outside(at) is None
        largest = np.maximum(largest, np.abs(nu - np.array(state[3:])) / np.array(beta))
    return largest


def test_an_adversary_who_moves_the_numbers_never_leaves_the_tube():
    """Expected: inside the tube of moving numbers, and far outside that of numbers that stand still, which
    promises nothing here."""
    model = Model.of(SHIP).but(find("RudderWear")(loss=0.2), find("HullFouling")(extra=0.3))
    numbers = movable(model.effects, SHIP)
    moving, still = (certify(model, gain_for(SHIP), 0.1, adapted=a, **QUIET) for a in (True, False))
    assert moving.ok and still.ok
    share = run(moving, model, numbers)
    assert share.max() <= 1.0 and share.max() > 0.1
    assert run(still, model, numbers).max() > 1.0
