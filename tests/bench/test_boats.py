"""The reference sea's boats with several actuators: they sail as such craft do, hide what is asked, and speak by
their actuators' names."""

import ast
import math
from pathlib import Path

import numpy as np
import pytest

import bench.reference.boats as boats
from bench.boats.actuator_questions import QUESTIONS, from_sheet
from bench.cli import main
from bench.reference.boats import CRAFT, BoatCase, BoatSea, builders_sheet, sail
from bench.reference.boats.drives import KINDS, screw
from bench.reference.boats.helmsman import BoatLeg
from tests.thorough import one_of
from twin.live.log_replay import replay
from twin.live.signals.config import Settings
from twin.physics.ship import load, save


def steady(name, manoeuvre="straight", hidden=(), lengths=40.0, **case):
    sea = BoatSea(BoatCase(name, manoeuvre, hidden, noisy=False, wind=(0.0, 0.0), **case))
    for _ in range(round(10.0 * lengths * sea.craft.L / sea.craft.U0)):
        sea.step()
    return sea


@pytest.mark.parametrize("name", CRAFT)
def test_left_alone_it_goes_straight_near_its_service_speed(name):
    sea = steady(name)
    *_, u, v, r = sea.state
    assert 0.8 < u / sea.craft.U0 < 1.25
    assert abs(v) < 0.01 * u and abs(r) * sea.craft.L / u < 0.01


def turned(name, helm):
    sea = BoatSea(BoatCase(name, "straight", noisy=False, wind=(0.0, 0.0)))
    sea.helmsman.leg = BoatLeg(1e9, 0.75, helm)
    sea.helmsman._until = 1e9
    for _ in range(round(200.0 * sea.craft.L / sea.craft.U0)):
        sea.step()
    return sea.state


@pytest.mark.parametrize("name", CRAFT)
def test_helm_to_starboard_turns_it_to_starboard_and_to_port_the_mirror_of_that(name):
    *_, psi_0, _, _, _ = BoatSea(BoatCase(name, "straight", noisy=False)).state
    right, left = turned(name, 0.5), turned(name, -0.5)
    assert right[5] > 0.02 * CRAFT[name].U0 / CRAFT[name].L
    assert left[3:] == pytest.approx((right[3], -right[4], -right[5]), rel=1e-6)
    assert left[2] - psi_0 == pytest.approx(psi_0 - right[2], rel=1e-6)


def test_the_bow_thruster_pushes_the_bow_where_it_is_told_and_little_at_speed():
    slow, fast = (steady("ferry2", lengths=0.1) for _ in range(2))
    moved = []
    for sea, speed in ((slow, 0.2), (fast, 5.0)):
        sea.state = (0.0, 0.0, 0.0, speed, 0.0, 0.0)
        before = sea._rates(sea.state)[5]
        next(one for one in sea.turning if one.drive.name == "bow").n = 6.0
        moved.append(sea._rates(sea.state)[5] - before)
    assert moved[0] > 10.0 * moved[1] > 0.0


def test_a_screw_by_hand():
    d = CRAFT["catamaran"].drives[0]
    area, slip = 0.25 * math.pi * 0.19**2, 20.0 * 0.15 - 1.0
    assert screw(d, 20.0, 1.0, 1025.0) == pytest.approx(0.5 * 1025.0 * area * 0.8 * slip**2)
    assert screw(d, -20.0, 0.0, 1025.0) == pytest.approx(-0.65 * 0.5 * 1025.0 * area * 0.8 * 3.0**2)


def test_a_worn_or_lost_thruster_pulls_the_craft_to_its_side():
    whole, worn, lost = (
        steady("catamaran", hidden=h, lengths=20.0).state
        for h in ((), (("worn.port", 0.18),), (("lost.port", 1.0),))
    )
    assert abs(whole[5]) < 1e-3 and lost[5] < worn[5] < -1e-3  # to port
    assert lost[3] < worn[3] < whole[3]


def test_a_worn_screw_leaves_the_rudder_behind_it_what_does_not_come_from_its_race():
    seas = (
        BoatSea(BoatCase("ferry2", hidden=h, noisy=False))
        for h in ((), (("screw.port", 0.18),), (("worn.port", 0.18),))
    )
    whole, blades, all_of_it = (
        KINDS["shaft"](sea.turning[0].drive, 4.0, 0.2, 5.0, 0.0, 1025.0)[1] * (1.0 - sea.hidden["port"].worn)
        for sea in seas
    )
    assert all_of_it == pytest.approx(0.82 * whole) and 0.88 < blades / whole < 0.99
    with pytest.raises(ValueError, match="no screw"):
        BoatSea(BoatCase("jet", hidden=(("screw.port", 0.18),)))


def test_a_late_drive_is_behind_its_record_and_a_silent_one_has_none():
    late = sail(BoatCase("jet", "mixed", (("late.port", 0.5),), noisy=False), 60.0)
    whole = sail(BoatCase("jet", "mixed", noisy=False), 60.0)
    jump = int(np.argmax(np.abs(np.diff(late["port.rate_rpm"]))))
    change = [np.abs(np.diff(x["port.rate_rpm"]))[jump] for x in (late, whole)]
    assert change[0] > 2.0 * change[1]  # an order jumps, a motor does not
    silent = sail(BoatCase("jet", "mixed", (("silent.port", 1.0),)), 60.0)
    assert np.isfinite(silent["port.rate_rpm"][:300]).all() and np.isnan(silent["port.rate_rpm"][300:]).all()
    assert np.isfinite(silent["starboard.rate_rpm"]).all()


@pytest.mark.parametrize("text", ["worn.stern", "burnt.port", "worn", "turned.port"])
def test_what_a_craft_cannot_hide_is_refused_by_name(text):
    with pytest.raises(ValueError, match=r"port|angle"):
        BoatSea(BoatCase("catamaran", hidden=((text, 1.0),)))


def test_the_same_seed_gives_the_same_voyage():
    one, two = (sail(BoatCase("ferry4", seed=5), 20.0) for _ in range(2))
    for name, column in one.items():
        assert np.array_equal(column, two[name], equal_nan=True)


def test_nothing_of_the_twin_is_in_the_boats():
    for path in Path(boats.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not any(name.split(".")[0] == "twin" for name in names), path


@pytest.mark.parametrize("name", one_of(CRAFT, 2))
def test_a_builders_sheet_makes_a_ship_that_the_loop_sails_with(name, tmp_path):
    """Test: sheet, twin init, a minute of the sea, loop. Expected: in every tick on measurements, the names
    of the drives in the forces."""
    assert main(["sea", "--hull", name, "--sheet", str(tmp_path / "a.toml")]) == 0
    ship = from_sheet(name)
    save(ship, tmp_path / "ship.toml")
    assert {a.name for a in load(tmp_path / "ship.toml").actuators} == {d.name for d in CRAFT[name].drives}
    assert (tmp_path / "a.toml").read_text() == builders_sheet.text(name)
    from bench.boats.actuator_questions import voyage
    from twin.recording.write import write_voyage

    sailed = voyage(name, 3)
    write_voyage(sailed, tmp_path / "v.mcap")
    settings = Settings({"ship.file": str(tmp_path / "ship.toml"), "prediction.horizons_s": [10.0]})
    summary = replay(tmp_path / "v.mcap", settings)
    assert summary.modes.get("physics only", 0) > 0.98 * summary.ticks
    assert {a[2] for asked in QUESTIONS.values() for a in asked} - {""}


def test_a_hull_of_one_screw_has_no_sheet(tmp_path, capsys):
    assert main(["sea", "--hull", "usv", "--sheet", str(tmp_path / "a.toml")]) == 2
    assert "several actuators" in capsys.readouterr().err
    assert (
        main(
            [
                "sea",
                "--hull",
                "jet",
                "--csv",
                str(tmp_path / "v.csv"),
                "--duration",
                "5",
                "--hidden",
                "worn.bow",
            ]
        )
        == 5
    )
    assert "worn.bow" in capsys.readouterr().err and not (tmp_path / "v.csv").exists()
