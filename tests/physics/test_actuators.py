"""Actuators as parts: forces are sums over them, and what a ship file said before gives the same numbers."""

import pickle
import tomllib
from math import pi, radians

import numpy as np
import pytest

from twin.errors import SettingsError
from twin.physics.actuators import KINDS, Actuator
from twin.physics.actuators.kinds import OF_WAKE
from twin.physics.effects import BUILT_IN, OF_ACTUATORS, find, of_ship
from twin.physics.model import Model
from twin.physics.ship import from_table, load, text, to_table
from twin.physics.state import Situation

PORT = {
    "name": "port",
    "kind": "fixed_thruster",
    "channels": ["command"],
    "x_m": -0.4,
    "y_m": -0.3,
    "ahead_n": 50.0,
    "astern_n": 25.0,
    "slow": 0.0,
}
MOTION = {"u": 1.1, "v": 0.2, "r": 0.1}


def ship_with(*tables, name="usv"):
    return from_table(to_table(load(name)) | {"actuators": list(tables)})


def single_screw_as_part(name="kvlcc2"):
    s = load(name)
    d = s.derivatives
    return ship_with(
        {
            "name": "main",
            "kind": "propeller",
            "channels": ["rate_rpm", "angle_deg"],
            "x_m": d.x_R * s.L_pp,
            "diameter_m": s.D_P,
            "K_T0": d.K_T0,
            "K_T1": d.K_T1,
            "rudder_area_m2": s.A_R,
        },
        name=name,
    )


def test_a_propeller_with_its_rudder_as_a_part_gives_the_same_to_the_last_digit():
    for n, delta in ((1.2, 0.2), (0.6, -0.4), (-0.5, 0.1)):
        before = Model(load("kvlcc2")).nu_dot(Situation(u=7.0, v=0.4, r=0.003, delta=delta, n=n))
        told = {"main.rate": n, "main.angle": delta}
        assert Model(single_screw_as_part()).nu_dot(Situation(u=7.0, v=0.4, r=0.003, orders=told)) == before


def test_a_ship_file_without_actuators_has_no_line_of_them():
    ship = load("kvlcc2")
    assert ship.actuators == () and "actuators" not in text(to_table(ship))
    assert of_ship(ship).keys() >= {e.__name__ for e in BUILT_IN}
    assert not any("." in name for name in of_ship(ship))


def test_a_thruster_by_hand():
    a = ship_with(PORT).actuator("port")
    X, Y, N = a.force({"port.command": 0.5}, 0.0, 0.0, 0.0, load("usv"))
    assert (pytest.approx(50.0 * 0.25, abs=1e-3), 0.0) == (X, Y)
    assert pytest.approx(0.3 * 12.5, abs=1e-3) == N  # on the port side it turns the ship to starboard


def test_an_azimuth_by_hand():
    table = PORT | {"kind": "azimuth", "channels": ["thrust_n", "angle_deg"], "y_m": 0.2}
    ship = ship_with(table)
    X, Y, N = ship.actuator("port").force({"port.thrust": 10.0, "port.angle": radians(30.0)}, 0, 0, 0, ship)
    assert pytest.approx(10.0 * 3**0.5 / 2) == X and pytest.approx(5.0) == Y
    assert pytest.approx(-0.4 * 5.0 - 0.2 * X) == N


def test_an_outboard_turned_like_a_rudder_to_starboard_turns_the_ship_to_starboard():
    ship = ship_with(PORT | {"kind": "outboard", "channels": ["thrust_n", "angle_deg"], "y_m": 0.0})
    _, Y, N = ship.actuator("port").force({"port.thrust": 10.0, "port.angle": 0.3}, 0, 0, 0, ship)
    assert Y < 0.0 < N


def test_the_blades_of_a_controllable_pitch_propeller_at_none_give_no_thrust_at_rest():
    table = {"name": "main", "kind": "controllable_pitch", "channels": ["rate_rpm", "pitch_ratio"]}
    ship = ship_with(table | {"diameter_m": 0.2, "pitch_ratio": 0.9})
    full, none, half = (
        ship.actuator("main").force({"main.rate": 10.0, "main.pitch": p}, 0, 0, 0, ship)[0]
        for p in (0.9, 0.0, 0.45)
    )
    assert none == 0.0 and full == pytest.approx(2.0 * half) and full > 0.0


def told_of(a: Actuator, k=1.0):
    usual = {"command": 0.4, "pwm": 1650.0, "rate": 9.0, "thrust": 8.0, "angle": 0.3, "pitch": 0.6}
    return {f"{a.name}.{n}": usual[n] * k for n in a.attributes}


def one_of_each():
    pods = ["rate_rpm", "angle_deg"]
    turned = {
        k: PORT | {"name": k, "kind": k, "channels": ["command", "angle_deg"]}
        for k in ("azimuth", "waterjet", "outboard")
    }
    own = {"diameter_m": 0.2, "rudder_area_m2": 0.02, "x_m": -1.0}
    return ship_with(
        *turned.values(),
        PORT | {"name": "fixed_thruster", "channels": ["pwm_us"]},
        PORT | {"name": "tunnel_thruster", "kind": "tunnel_thruster", "x_m": 1.0, "half_mps": 1.0},
        {"name": "propeller", "kind": "propeller", "channels": pods, **own},
        {
            "name": "controllable_pitch",
            "kind": "controllable_pitch",
            "channels": [*pods, "pitch_ratio"],
            **own,
        },
    )


@pytest.mark.parametrize("kind", KINDS)
def test_floats_arrays_and_tensors_agree_on_every_kind(kind):
    torch = pytest.importorskip("torch")
    ship = one_of_each()
    a = ship.actuator(kind)
    one = a.force(told_of(a), 1.1, 0.2, 0.1, ship)
    rows = a.force({k: np.array([x, x]) for k, x in told_of(a).items()}, np.full(2, 1.1), 0.2, 0.1, ship)
    leaf = {k: torch.tensor(x, dtype=torch.float64, requires_grad=True) for k, x in told_of(a).items()}
    tensors = a.force(leaf, torch.tensor(1.1, dtype=torch.float64), 0.2, 0.1, ship)
    for x, row, tensor in zip(one, rows, tensors, strict=True):
        assert np.allclose(row, x, rtol=1e-12) and float(tensor) == pytest.approx(float(x), rel=1e-12)
    sum(tensors).backward()
    assert all(np.isfinite(float(x.grad)) for x in leaf.values() if x.grad is not None)


def test_the_file_of_a_ship_with_actuators_says_that_the_one_propeller_and_rudder_are_not_used():
    """Expected: of one propeller and its rudder every number with thrusters alone; with a shaft and a rudder
    behind it only what each of these has of its own."""

    def not_used(*tables):
        lines = text(to_table(ship_with(*tables))).splitlines()
        return [
            line.split()[0] for line in lines if line.endswith("; not used: the actuators have their own")
        ]

    own, shaft = ["D_P", "A_R", "K_T0", "K_T1", "x_R"], PORT | {"kind": "propeller", "diameter_m": 0.2}
    assert set(not_used(PORT)) == {*own, *OF_WAKE}
    assert not_used(PORT, shaft | {"name": "starboard"}) == own


def test_every_kind_is_written_and_read_back_the_same():
    ship = one_of_each()
    again = from_table(tomllib.loads(text(to_table(ship))))
    assert again.actuators == ship.actuators and len(again.actuators) == len(KINDS)


def test_an_effect_is_of_one_named_actuator():
    ship = ship_with(PORT, PORT | {"name": "starboard", "y_m": 0.3})
    told = {"port.command": 0.5, "starboard.command": 0.5}
    worn = find("ThrusterWear.port")(loss=0.18)
    worn.check(ship)
    s = Situation(**MOTION, orders=told)
    forces = Model(ship, (worn,)).known(s)
    assert pytest.approx(-0.18 * forces["port"].X) == forces["ThrusterWear.port"].X
    assert pytest.approx(-0.18 * forces["port"].N) == forces["ThrusterWear.port"].N
    assert find("ThrusterWear.port") is type(worn) and find("ThrusterWear.starboard") is not type(worn)
    assert pickle.loads(pickle.dumps(worn)) == worn


def test_a_worn_rudder_leaves_the_thrust_of_the_screw_before_it():
    own = {"diameter_m": 0.2, "rudder_area_m2": 0.02, "x_m": -1.0, "y_m": 0.3}
    ship = ship_with(
        {"name": "port", "kind": "propeller", "channels": ["rate_rev_s", "angle_deg"], **own},
        PORT | {"name": "bow"},
    )
    worn, s = find("SteeringWear.port")(loss=0.25), Situation(**MOTION, orders={"bow.command": 0.0})
    told = {"bow.command": 0.0, "port.rate": 9.0}
    for angle in (0.0, 0.3):
        s.orders = told | {"port.angle": angle}
        forces = Model(ship, (worn,)).known(s)
        straight = ship.actuator("port").but(A_R=0.0)
        screw = straight.force(s.orders, s.u_r, s.v_r, s.r, ship)
        for axis, thrust in zip(("X", "Y", "N"), screw, strict=True):
            rudder = getattr(forces["port"], axis) - thrust
            assert getattr(forces["SteeringWear.port"], axis) == pytest.approx(-0.25 * rudder)
    assert "SteeringWear.bow" not in of_ship(ship) and "SteeringWear.port" in of_ship(ship)


def test_an_angle_offset_turns_what_the_azimuth_does():
    ship = ship_with(PORT | {"kind": "azimuth", "channels": ["thrust_n", "angle_deg"]})
    effect = find("AngleOffset.port")(offset=radians(6.0))
    s = Situation(orders={"port.thrust": 10.0, "port.angle": 0.5 * pi})
    got, turned = effect.force(s, ship), 0.5 * pi + radians(6.0)
    assert pytest.approx(10.0 * np.cos(turned)) == got.X and pytest.approx(10 * np.sin(turned) - 10) == got.Y


def test_the_catalogue_of_a_ship_with_thrusters_holds_their_effects_and_no_rudders():
    known = of_ship(ship_with(PORT))
    assert {"ThrusterWear.port", "ThrusterZero.port", "ActuatorLag.port"} <= known.keys()
    assert not {"AngleOffset.port", "RudderWear", "SteeringLag", "PropellerWear"} & known.keys()


def test_effects_of_actuators_stand_in_a_ship_file():
    table = to_table(ship_with(PORT)) | {"effects": {"ThrusterWear.port": {"loss": 0.2}}}
    ship = from_table(table)
    assert from_table(tomllib.loads(text(to_table(ship)))).effects == ship.effects


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"kind": "sail"}, "sailing vessel"),
        ({"kind": "fixed_truster"}, "fixed_thruster"),
        ({"channels": ["pitch_ratio"]}, "how hard it pushes"),
        ({"channels": ["command", "angle_deg"]}, "has no angle"),
        ({"kind": "azimuth"}, "needs its angle"),
        ({"ahead_n": -3.0}, "lies outside"),
        ({"ahead_n": {"value": 5.0, "unit": "kN"}}, "unit 'kN', but 'N' is expected"),
        ({"name": "Port side"}, "small letters"),
        ({"channels": ["rate_rpm"]}, "diameter_m"),
        ({"ahead": 3.0}, "ahead_n"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(change, said):
    with pytest.raises(SettingsError, match=said) as error:
        ship_with(PORT | change)
    assert "\n" not in str(error.value)


def test_an_effect_of_an_actuator_that_the_ship_has_not_is_refused():
    with pytest.raises(SettingsError, match="no actuator is called"):
        find("ThrusterWear.stern")(loss=0.1).check(ship_with(PORT))
    with pytest.raises(SettingsError, match="of one actuator"):
        find("ThrusterWear")
    assert all(e.__doc__ and e.source for e in OF_ACTUATORS)


def test_what_several_of_one_make_have_alike_is_the_sum_of_what_each_has():
    """Expected: asked about where two of one make can have it, told of both, and refused of an effect that
    each has for itself."""
    starboard = PORT | {"name": "starboard", "y_m": -PORT["y_m"]}
    bow = PORT | {"name": "bow", "kind": "tunnel_thruster"}
    ship = ship_with(PORT, starboard, bow)
    alike = [name for name in of_ship(ship) if "+" in name]
    assert alike == ["ThrusterWear.port+starboard", "ActuatorLag.port+starboard"]
    both = find("ThrusterWear.port+starboard")
    assert both.sentence(ship).startswith("The port thruster and the starboard thruster give less thrust")
    s = Situation(
        u=1.0, v=0.1, r=0.05, orders={"port.command": 0.6, "starboard.command": 0.3, "bow.command": 0.0}
    )
    Model.of(ship).nu_dot(s)
    each = [find(f"ThrusterWear.{name}")(loss=0.2).force(s, ship) for name in ("port", "starboard")]
    together = both(loss=0.2).force(s, ship)
    assert together.X < 0.0 and np.allclose(together, np.sum(each, axis=0), rtol=1e-12)
    assert pickle.loads(pickle.dumps(both(loss=0.2))) == both(loss=0.2)
    with pytest.raises(SettingsError, match="no actuator is called 'stern'"):
        find("ThrusterWear.port+stern")(loss=0.1).check(ship)
    with pytest.raises(SettingsError, match="of one actuator alone"):
        find("ThrusterZero.port+starboard")


@pytest.mark.parametrize("effect, said", [
    ("ThrusterWear.port", "The port thruster gives less thrust"),
    ("ThrusterWear.bow", "The bow thruster gives less thrust"),
    ("AngleOffset.main", "The main rudder's zero is not where"),
    ("SteeringWear.main", "The rudder behind the main propeller gives less force"),
    ("ActuatorLag.azimuth_1", "The azimuth 1 answers late"),
])  # fmt: skip
def test_the_sentence_of_an_effect_names_its_actuator_as_a_seafarer_does(effect, said):
    """Expected: name and kind of the ship's actuator, neither of them twice; without a ship its name alone;
    of a family no name."""
    main = {
        "name": "main", "kind": "propeller", "channels": ["rate_rpm", "angle_deg"], "x_m": -0.4,
        "diameter_m": 0.1, "K_T0": 0.4, "K_T1": -0.4, "rudder_area_m2": 0.01,
    }  # fmt: skip
    bow = PORT | {"name": "bow", "kind": "tunnel_thruster"}
    pod = PORT | {"name": "azimuth_1", "kind": "azimuth", "channels": ["command", "angle_deg"]}
    ship = ship_with(PORT, main, bow, pod)
    assert find(effect).sentence(ship).startswith(said) and "this actuator" not in find(effect).sentence(ship)
    owner = effect.partition(".")[2]
    assert f"actuator {owner}" in find(effect).sentence().lower()
    assert all("this actuator" in e.sentence().lower() for e in OF_ACTUATORS)
