"""The first model of a ship that actuators drive: what is told, what is taken, what is said."""

import pytest

from bench.boats.actuator_questions import from_sheet
from twin.cli import main
from twin.physics.ship import load
from twin.study.first_model.first_actuators import OVERRUN_DRAG


def test_a_screw_that_stands_still_holds_against_the_motion_and_a_jet_does_not():
    ferry, jet = from_sheet("ferry2"), from_sheet("jet")
    assert [a.drag for a in ferry.actuators] == [OVERRUN_DRAG, OVERRUN_DRAG, 0.0]  # the third is in a tunnel
    assert [a.drag for a in jet.actuators] == [0.0, 0.0]
    assert "Carlton" in ferry.notes["sources"]["CAR18"] and "CAR18" not in jet.notes["sources"]


def test_a_boat_of_thrusters_is_told_of_no_rudder(tmp_path, capsys):
    """Expected: neither the one propeller nor the rudder among its numbers, a circle that its thrusters sail;
    what was given of them all the same is said to be not used."""
    sheet = tmp_path / "thrusters.toml"
    sides = (("port", -0.4), ("starboard", 0.4))
    sheet.write_text(
        "".join(
            f'[[actuators]]\nname = "{name}"\nkind = "fixed_thruster"\nchannels = ["command"]\nx_m = -0.7\n'
            f"y_m = {y}\nahead_n = 40.0\nastern_n = 25.0\n"
            for name, y in sides
        )
    )
    boat = ["init", "Cat", "--length-pp-m", "1.8", "--beam-m", "1", "--draught-m", "0.16", "--mass-kg", "58"]
    boat += ["--service-speed-mps", "1.5", "--actuators", str(sheet)]
    assert main([*boat, "-o", str(tmp_path / "a.toml")]) == 0
    said = capsys.readouterr().out
    assert "rudder area" not in said and "propeller diameter" not in said and "35 deg" not in said
    assert "turning circle, one side stopped" in said
    assert main([*boat, "--rudder-area-m2", "0.02", "-o", str(tmp_path / "b.toml")]) == 0
    told = [line for line in capsys.readouterr().out.splitlines() if "rudder area (moveable)" in line]
    assert len(told) == 1 and told[0].endswith("not used: each actuator has its own")


PODS = """
[[actuators]]
name = "port"
kind = "azimuth"
channels = ["rate_rpm", "angle_deg"]
x_m = -32
y_m = -4.5
diameter_m = 2.6
[[actuators]]
name = "starboard"
kind = "azimuth"
channels = ["rate_rpm", "angle_deg"]
x_m = -32
y_m = 4.5
diameter_m = 2.6
[[actuators]]
name = "bow"
kind = "tunnel_thruster"
channels = ["command"]
x_m = 29
ahead_n = 85000
astern_n = 85000
"""


def supply_vessel(tmp_path, more=(), sheet=PODS):
    (tmp_path / "sheet.toml").write_text(sheet)
    vessel = ["init", "Supply", "--length-pp-m", "70", "--beam-m", "16", "--draught-m", "5.5", *more]
    vessel += ["--service-speed-mps", "6.5", "--actuators", str(tmp_path / "sheet.toml"), "--force"]
    code = main([*vessel, "-o", str(tmp_path / "s.toml")])
    return code, load(tmp_path / "s.toml") if code == 0 else None


def test_turns_that_are_given_set_the_thrust_of_actuators_that_nobody_told(tmp_path, capsys):
    """Expected: with K_T0 = 0.43 P/D - 0.02 and K_T1 = -K_T0/(1.1 P/D) of the one P/D with which 190 rpm keep
    6.5 m/s; what is told of one stays, and then one shaft speed says nothing of the two."""
    code, ship = supply_vessel(tmp_path, ["--shaft-speed-rpm", "190"])
    said = capsys.readouterr().out
    assert code == 0 and "190 rpm at 6.50 m/s (12.6 kn): as given" in said
    for a in ship.actuators[:2]:
        assert pytest.approx(-a.K_T0 * 0.43 / (1.1 * (a.K_T0 + 0.02)), rel=1e-3) == a.K_T1
    code, told = supply_vessel(
        tmp_path,
        ["--shaft-speed-rpm", "190"],
        PODS.replace("diameter_m = 2.6", "diameter_m = 2.6\nK_T0 = 0.5", 1),
    )
    assert told.actuators[0].K_T0 == 0.5 and told.actuators[1].K_T0 != ship.actuators[1].K_T0
    assert "--shaft-speed-rpm is not used: each actuator has its own" in capsys.readouterr().out


def test_turns_that_no_pitch_gives_are_refused_in_one_line(tmp_path, capsys):
    assert supply_vessel(tmp_path, ["--shaft-speed-rpm", "60"])[0] == 5
    assert "--shaft-speed-rpm 60 cannot drive it at 6.50 m/s" in capsys.readouterr().err


def test_each_actuator_is_printed_with_its_place_and_strength(tmp_path, capsys):
    supply_vessel(tmp_path)
    said = capsys.readouterr().out
    lines = [line for line in said.splitlines() if " m astern of midship" in line or "85000 N" in line]
    assert len(lines) == 3 and "4.5 m to port" in lines[0] and "4.5 m to starboard" in lines[1]
    assert "Wageningen" in lines[0] and lines[2].endswith("85000 N ahead, 85000 N astern at rest")


def test_two_shafts_have_the_wake_of_two(tmp_path):
    """Expected: Taylor's w = 0.55 C_b - 0.2 for them, 0.5 C_b - 0.05 for one."""
    shafts = PODS.replace('"azimuth"', '"propeller"').replace(
        '"angle_deg"]', '"angle_deg"]\nrudder_area_m2 = 4'
    )
    _, twin_screw = supply_vessel(tmp_path, sheet=shafts)
    _, one = supply_vessel(
        tmp_path, sheet=shafts.replace('"propeller"', '"azimuth"', 1).replace("rudder_area_m2 = 4", "", 1)
    )
    assert twin_screw.derivatives.w == pytest.approx(0.55 * twin_screw.C_b - 0.2, rel=1e-3)
    assert one.derivatives.w == pytest.approx(0.5 * one.C_b - 0.05, rel=1e-3)
    assert twin_screw.derivatives.kappa == pytest.approx(one.derivatives.kappa, rel=1e-3)
