"""Forces of actuators that are kept along one motion are the forces, to the last digit."""

from dataclasses import replace

import numpy as np
import pytest

from tests.physics.test_actuators import PORT, ship_with
from twin.physics.actuators import KINDS, KeptForces
from twin.physics.actuators.actuator import Actuator
from twin.physics.actuators.kept_forces import READ_OF_SHIP
from twin.physics.particulars import PARTICULARS
from twin.physics.ship import DERIVATIVES, load

U, V, R = (np.linspace(a, b, 5) for a, b in ((-0.4, 1.6), (0.2, -0.1), (0.1, -0.2)))
TOLD = {
    "rate_rpm": np.linspace(-9.0, 12.0, 5),
    "angle_deg": np.linspace(-0.4, 0.5, 5),
    "pitch_ratio": U + 1.0,
}
# channel: its name in SI
SI = {"rate_rpm": "rate", "angle_deg": "angle", "pitch_ratio": "pitch"}
SCREW = {"name": "port", "x_m": -0.4, "y_m": -0.3, "diameter_m": 0.2, "K_T0": 0.4, "K_T1": -0.4}


def vessel(kind):
    """A boat with one actuator of this kind, whose turns, angle and pitch are recorded as its kind has them,
    and what is told of it."""
    has = ["rate_rpm"]
    has += ["angle_deg"] * ("angle" in KINDS[kind].needs + KINDS[kind].may)
    has += ["pitch_ratio"] * ("pitch" in KINDS[kind].needs)
    rudder = {"rudder_area_m2": 0.02} if "angle" in KINDS[kind].may else {}
    ship = ship_with(SCREW | {"kind": kind, "channels": has} | rudder)
    return ship, {f"port.{SI[c]}": TOLD[c] for c in has}


def force(ship, orders):
    return np.array([np.broadcast_to(x, U.shape) for x in ship.actuators[0].force(orders, U, V, R, ship)])


@pytest.mark.parametrize("kind", KINDS)
def test_of_its_ship_a_kind_reads_no_more_than_it_says(kind):
    """What is kept counts as unchanged while these numbers are: one that is forgotten would be overlooked."""
    ship, orders = vessel(kind)
    before = force(ship, orders)
    for name in (f.name for f in DERIVATIVES if f.name not in KINDS[kind].reads):
        changed = ship.with_derivatives(**{name: getattr(ship.derivatives, name) + 0.13})
        assert np.array_equal(force(changed, orders), before), name
    for name in (f.name for f in PARTICULARS if f.name not in READ_OF_SHIP):
        assert np.array_equal(force(replace(ship, **{name: 1.3 * getattr(ship, name) + 0.1}), orders), before)


@pytest.mark.parametrize("kind", KINDS)
def test_a_number_that_a_kind_reads_gives_another_force(kind):
    ship, orders = vessel(kind)
    kept = KeptForces().orders(orders)
    before = force(ship, kept)
    assert np.array_equal(before, force(ship, orders))
    for name in KINDS[kind].reads:
        changed = ship.with_derivatives(**{name: getattr(ship.derivatives, name) + 0.13})
        assert np.array_equal(force(changed, kept), force(changed, orders))
        assert name == "t_R" or not np.array_equal(force(changed, kept), before)
    for number in ("gain", "sag", "K_T1"):
        changed = ship.with_derivatives(**{f"port.{number}": 0.7})
        assert np.array_equal(force(changed, kept), force(changed, orders))
        assert not np.array_equal(force(changed, kept), before)


def test_a_force_is_worked_out_once_for_all_ships_that_differ_in_their_hull(monkeypatch):
    ship, orders = vessel("azimuth")
    kept, count = KeptForces().orders(orders), []
    azimuth = KINDS["azimuth"].force

    def counted(*told):
        count.append(told)
        return azimuth(*told)

    monkeypatch.setattr(Actuator, "of_kind", property(lambda self: counted))
    for Y_uv in (-0.4, -0.5, -0.6):
        force(ship.with_derivatives(Y_uv=Y_uv), kept)
    assert len(count) == 1
    force(ship.with_derivatives(**{"port.gain": 0.9}), kept)
    assert len(count) == 2


def test_in_another_motion_and_behind_other_orders_nothing_is_kept():
    ship = ship_with(PORT)
    a, kept = ship.actuators[0], KeptForces()
    first, other = {"port.command": U / 2.0}, {"port.command": U / 3.0}
    for orders in (first, other):
        for u in (U, U + 0.1, U):
            assert np.array_equal(
                a.force(kept.orders(orders), u, V, R, ship)[0], a.force(orders, u, V, R, ship)[0]
            )
    assert kept.orders(None) is None and load("kvlcc2").actuators == ()
