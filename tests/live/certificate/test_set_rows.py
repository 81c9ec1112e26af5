"""The live bound of Theorem 2 in the usual set and beyond it."""

import json
from dataclasses import replace

import pytest

from twin.live.certificate.certificate import Certificate, certify, digest
from twin.live.certificate.observer_tube import Tube
from twin.live.certificate.set_rows import SetRows
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation

ALL = (True, True, True)
SHIP = load("kvlcc2")
MOST = 0.5 * SHIP.U_0 / SHIP.L_pp  # of the usual set's rate of turn [rad/s]


@pytest.fixture(scope="module")
def c():
    return certify(Model.of(SHIP), 0.3, 0.1, 3, reach=True)


@pytest.fixture(scope="module")
def usual(c):
    return replace(c, reach=None)


def turning(share, **more):
    """A motion in the middle of the set but for its rate of turn: a share of the usual greatest."""
    return Situation(**{"u": 5.0, "u_r": 5.0, "v_r": 0.0, "r": share * MOST, "delta": 0.1, "n": 1.0} | more)


def run(tube, shares, within=(0.0, 0.0, 0.0)):
    """The bound of r after each tick that begins where `outside` was asked last."""
    bounds = []
    for share in shares:
        assert tube.outside(turning(share), within) is None
        bounds.append(tube.step(ALL)[2])
    return bounds


def test_the_wider_set_is_steeper_and_takes_the_same_gain(c):
    there = c.in_reach()
    assert there.K == c.K and there.noise == c.noise and there.reach is None
    assert there.operating.ranges == c.operating.reach
    assert all(a > b for a, b in zip(there.bound, c.bound, strict=True))


def test_endless_slopes_are_no_set_to_follow_a_bound_in(c):
    assert c.reach.bounded and not replace(c.reach, hi=((float("inf"),) * 3,) * 3).bounded


def test_well_inside_the_usual_set_the_bound_is_the_usual_one(c, usual):
    at_sea, alone = Tube(c), Tube(usual)
    assert run(at_sea, [0.0] * 50)[-1] == pytest.approx(run(alone, [0.0] * 50)[-1])


def test_beyond_the_usual_set_the_bound_is_that_of_the_wider_one_and_nothing_is_said_to_be_outside(c, usual):
    """Test: a turn of 1.2 times the greatest. Expected: the usual set alone ends there; with the wider one the bound
    settles where that one has it."""
    assert "rate of turn" in Tube(usual).outside(turning(1.2), (0.0, 0.0, 0.0))
    assert run(Tube(c), [1.2] * 3000)[-1] == pytest.approx(c.in_reach().bound[2], rel=1e-6)


def test_after_the_turn_the_usual_slopes_count_when_no_late_measurement_looks_back_on_it(c):
    """Expected: a tick beyond acts on the ticks of a window, and on none after it."""
    tube, table = Tube(c), []
    for share in [0.0] * 20 + [1.2] + [0.0] * 20:
        assert tube.outside(turning(share), (0.0, 0.0, 0.0)) is None
        tube.step(ALL)
        table.append(tube._beyond > 0)
    assert table == [False] * 20 + [True] * tube.window + [False] * (21 - tube.window)


def test_until_it_is_asked_where_the_ship_is_the_wider_slopes_count(c):
    assert Tube(c).step(ALL)[2] > run(Tube(c), [0.0])[0]


def test_near_the_end_of_the_usual_set_the_wider_slopes_count_already(c):
    """Test: as near to its end as the ship can come in a tick, or as the bound leaves open. Expected: as beyond it."""
    middle, beyond = run(Tube(c), [0.0])[0], run(Tube(c), [1.2])[0]
    assert run(Tube(c), [0.999]) == [beyond] and run(Tube(c), [0.9]) == [middle]
    assert run(Tube(c), [0.9], (0.0, 0.0, 0.1 * MOST)) == [beyond]


def test_a_tick_that_lasts_so_long_that_the_ship_may_leave_the_usual_set_goes_by_the_wider(c, usual):
    def late(tube, share):
        tube.outside(turning(share), (0.0, 0.0, 0.0))
        return tube.step(ALL, dt=0.3)[2]

    assert late(Tube(c), 0.0) == pytest.approx(late(Tube(usual), 0.0))
    assert late(Tube(c), 0.97) > late(Tube(usual), 0.97)


def test_a_rising_sea_moves_the_ship_out_of_the_usual_set_sooner(c):
    """Test: where the ship just stays in the set in calm water, waves of 4 m come up. Expected: the wider slopes."""
    calm, waves = Tube(c), Tube(c)
    u = c.operating.ranges["u"][1] - 1.001 * c.h * SetRows(c).way[0]
    for tube in (calm, waves):
        assert tube.outside(turning(0.0, u=u, u_r=u), (0.0, 0.0, 0.0)) is None
    calm.step(ALL)
    waves.step(ALL, H_s=4.0)
    assert calm._beyond == 0 and waves._beyond > 0


def test_what_is_beyond_both_sets_is_said_with_the_ends_of_the_wider_one(c):
    told = Tube(c).outside(turning(1.7), (0.0, 0.0, 0.0))
    assert "rate of turn" in told and "68.5" in told
    assert "rudder" in Tube(c).outside(turning(0.0, delta=0.7), (0.0, 0.0, 0.0))


def test_the_file_keeps_the_wider_set_and_one_of_another_ship_is_refused(c):
    """Expected: the same certificate again; a wider set that does not belong to the usual one is no certificate."""
    assert Certificate.from_json(c.to_json()) == c
    for name, value in (
        ("operating", None),
        ("most", [0.1, -0.1, 0.1]),
        ("bend", c.plant.bend),
        ("moved", []),
    ):
        table = json.loads(c.to_json())
        if value is None:
            table["reach"]["operating"]["ranges"]["r"] = [-1.0, 1.0]
        else:
            table["reach"][name] = value
        version, _ = table.pop("version"), table.pop("sha256")
        with pytest.raises(ValueError, match="does not follow"):
            Certificate.from_json(json.dumps({"version": version, "sha256": digest(table), **table}))
