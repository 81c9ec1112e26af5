"""`twin init`: a first model of any ship from what its owner knows, and clear words where it cannot be."""

import json
from math import radians

import pytest

from bench.reference.hulls import HULLS
from twin.cli import main
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.first_model.first_estimate import OPTIONS, first_model
from twin.study.prediction.trial import turning_circle, zigzag

HULL = {  # length, beam, draught, and what else is known
    "2 m boat": (2.0, 0.34, 0.114, {"mass-kg": 40.0}),
    "2 m catamaran": (2.0, 1.08, 0.14, {"mass-kg": 65.0}),
    "12 m workboat": (12.0, 3.6, 1.2, {}),
    "20 m fishing boat": (20.0, 6.0, 2.4, {}),
    "105 m training ship": (105.0, 17.91, 5.966, {"block-coefficient": 0.508}),
    "135 m inland ship": (135.0, 11.4, 3.0, {"block-coefficient": 0.85}),
    "175 m container ship": (175.0, 25.4, 8.5, {"block-coefficient": 0.56, "service-speed-mps": 9.0}),
    "180 m bulk carrier": (180.0, 30.0, 10.5, {}),
    "320 m tanker": (320.0, 58.0, 20.8, {"block-coefficient": 0.81, "service-speed-mps": 7.97}),
    "400 m container ship": (400.0, 61.0, 16.0, {"service-speed-mps": 11.5, "shaft-speed-rpm": 80.0}),
}


def given(L, B, T, more):
    return (
        dict.fromkeys((option for option, *_ in OPTIONS), None)
        | {"length-pp-m": L, "beam-m": B, "draught-m": T}
        | more
    )


@pytest.mark.parametrize("hull", HULL)
def test_every_hull_sails_like_a_ship(hull, tmp_path):
    ship, _ = first_model(hull, given(*HULL[hull]))
    model = Model.of(ship)
    circle = turning_circle(model, radians(35))
    assert (
        2.0 <= circle.tactical_diameter <= 6.0
        and 2.0 <= circle.advance <= 5.0
        and 0.2 < circle.speed_left < 0.9
    )
    over = zigzag(model, radians(20), radians(20))
    assert len(over) >= 3 and 0.5 < over[0] < 30.0
    sources = {**ship.notes["particulars"], **ship.notes["derivatives"]}
    assert all(entry["source"] for entry in sources.values())
    used = {part for entry in sources.values() for part in entry["source"].split("; ")}
    assert used == set(ship.notes["sources"])


@pytest.mark.parametrize("key", ["kvlcc2", "container", "usv"])
def test_the_regressions_come_near_ships_that_were_measured(key):
    """The same ships from their model tests: added mass within 30 %, turning circle within 50 %. Calibration
    does the rest."""
    h = HULLS[key]
    C_b = h.m * 0.5 * h.L / h.B
    more = {
        "block-coefficient": C_b,
        "service-speed-mps": h.U0,
        "rudder-area-m2": h.A_R,
        "propeller-diameter-m": h.D_P,
        "x-g-m": h.x_G,
    }
    ship, _ = first_model(key, given(h.L, h.B, h.d, more))
    d, e = ship.derivatives, load(key).derivatives
    assert d.Y_vdot == pytest.approx(e.Y_vdot, rel=0.3) and d.N_rdot == pytest.approx(e.N_rdot, rel=0.5)
    assert d.N_ur == pytest.approx(e.N_ur, rel=0.6) and d.X_uu == pytest.approx(e.X_uu, rel=0.6)
    circle, measured = (turning_circle(Model.of(s), radians(35)) for s in (ship, load(key)))
    assert circle.tactical_diameter == pytest.approx(measured.tactical_diameter, rel=0.5)


def test_it_writes_a_ship_file_that_says_what_was_given_and_what_was_estimated(tmp_path, capsys):
    path = tmp_path / "alma.toml"
    arguments = ["--length-pp-m", "180", "--beam-m", "30", "--draught-m", "10.5", "--rudder-area-m2", "40"]
    assert main(["init", "MV Alma", *arguments, "-o", str(path), "--json", str(tmp_path / "a.json")]) == 0
    shown = capsys.readouterr().out
    assert "estimated" in shown and "next:" in shown and "twin calibrate" in shown
    ship = load(path)
    assert ship.name == "MV Alma" and ship.notes["particulars"]["A_R"]["source"] == "given"
    assert ship.notes["particulars"]["D_P"]["source"] != "given"
    told = json.loads((tmp_path / "a.json").read_text())
    assert told["schema_version"] == 1 and told["trial"]["tactical_diameter_L"] > 1


def test_her_inertia_is_hers_where_it_is_known():
    ship, _ = first_model("A", given(1.2, 0.29, 0.105, {"mass-kg": 23.8, "yaw-inertia-kgm2": 1.76}))
    assert ship.I_z == 1.76 and ship.notes["particulars"]["I_z"]["source"] == "given"


def test_a_shaft_speed_sets_the_thrust(tmp_path):
    from twin.study.prediction.trial import shaft_speed

    more = {
        "block-coefficient": 0.75,
        "service-speed-mps": 7.5,
        "shaft-speed-rpm": 105.0,
        "propeller-diameter-m": 6.2,
    }
    ship, _ = first_model("A", given(180.0, 30.0, 10.5, more))
    assert 60.0 * shaft_speed(Model.of(ship), 7.5) == pytest.approx(105.0, rel=0.01)


def test_two_propellers_push_twice_as_hard_and_each_rudder_feels_one_of_them():
    one, two = (
        first_model("x", given(51.5, 8.6, 2.3, {"pitch-ratio": 1.2, "propellers": count}))[0].derivatives
        for count in (1.0, 2.0)
    )
    assert pytest.approx(2.0 * one.K_T0) == two.K_T0 and pytest.approx(2.0 * one.K_T1, rel=1e-3) == two.K_T1
    # half of each slipstream a rudder, which is less high and so stands more of it
    assert two.kappa * 2.0 > one.kappa
    full = [
        first_model(
            "x", given(51.5, 8.6, 2.3, {"rudder-area-m2": 1.5 * n, "rudder-height-m": 1.5, "propellers": n})
        )[0]
        for n in (1.0, 2.0)
    ]
    # two of the same are as slender as one
    assert pytest.approx(full[0].derivatives.C_L, rel=1e-6) == full[1].derivatives.C_L
    assert two.w < one.w


def test_it_warns_where_the_regressions_know_no_such_hull():
    _, warnings = first_model("Cat", given(2.0, 1.08, 0.14, {"mass-kg": 65.0}))
    assert any("L/B = 1.85" in w and "Clarke" in w for w in warnings)
    told = {
        "block-coefficient": 0.81,
        "frontal-area-m2": 1200.0,
        "lateral-area-m2": 3300.0,
        "service-speed-mps": 7.97,
    }
    assert first_model("V", given(320.0, 58.0, 20.8, told))[1] == []
    (guessed,) = first_model("V", given(320.0, 58.0, 20.8, told | {"service-speed-mps": None}))[1]
    assert "U_0: guessed by size only" in guessed


BAD = {
    "negative length": ("--length-pp-m -2 --beam-m 1 --draught-m .1", 5, "--length-pp-m -2"),
    "beam in feet": ("--length-pp-m 180 --beam-m 98.4 --draught-m 10", 5, "--beam-m 98.4"),
    "length and beam swapped": ("--length-pp-m 30 --beam-m 80 --draught-m 10", 5, "Check the order"),
    "mass in tonnes": ("--length-pp-m 180 --beam-m 30 --draught-m 10 --mass-kg 43000", 5, "Check the mass"),
    "two masses": (
        "--length-pp-m 180 --beam-m 30 --draught-m 10 --mass-kg 4e7 --block-coefficient .5",
        5,
        "Leave one of them out",
    ),
    "a centre of gravity in the bow": (
        "--length-pp-m 180 --beam-m 30 --draught-m 10 --x-g-m 40",
        5,
        "more than 0.15 of the length from midship",
    ),
    "a spinning top": (
        "--length-pp-m 180 --beam-m 30 --draught-m 10 --yaw-inertia-kgm2 1e9",
        5,
        "is a radius of 0.03 L",
    ),
    "nan": ("--length-pp-m nan --beam-m 30 --draught-m 10", 5, "--length-pp-m nan"),
    "a shaft that races": (
        "--length-pp-m 180 --beam-m 30 --draught-m 10 --shaft-speed-rpm 5000 --propeller-diameter-m 5",
        5,
        "no usual pitch",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_what_cannot_be_right_is_refused_in_one_line(case, tmp_path, capsys):
    arguments, code, words = BAD[case]
    path = tmp_path / "x.toml"
    assert main(["init", "X", *arguments.split(), "-o", str(path)]) == code
    said = capsys.readouterr().err
    assert words in said and said.count("\n") == 1 and not path.exists()


def test_a_word_for_a_number_is_a_mistake_in_usage(tmp_path, capsys):
    with pytest.raises(SystemExit) as end:
        main(
            [
                "init",
                "X",
                "--length-pp-m",
                "long",
                "--beam-m",
                "1",
                "--draught-m",
                "1",
                "-o",
                str(tmp_path / "x.toml"),
            ]
        )
    assert end.value.code == 2


def test_a_place_that_cannot_be_written_is_said(tmp_path, capsys):
    arguments = ["--length-pp-m", "180", "--beam-m", "30", "--draught-m", "10.5"]
    assert main(["init", "X", *arguments, "-o", str(tmp_path / "none" / "x.toml")]) == 1
    assert "cannot be written" in capsys.readouterr().err


def test_a_fine_hull_that_would_not_go_straight_and_two_fullnesses_are_said(tmp_path, capsys):
    said = ["--length-pp-m", "175", "--beam-m", "25.4", "--draught-m", "8.5", "--mass-kg", "21752550"]
    assert main(["init", "S175", *said, "--block-coefficient", "0.559", "-o", str(tmp_path / "a.toml")]) == 0
    page = capsys.readouterr().out
    assert (
        "so fine a hull (C_b 0.56)" in page
        and ("gives C_b = 0.5617, which is used") in page
        and "many full ships" not in page
    )
    assert main(["init", "S175", *said, "-o", str(tmp_path / "b.toml")]) == 0
    assert "which is used" not in capsys.readouterr().out


def test_what_is_given_and_is_no_particular_is_told_as_given(tmp_path, capsys):
    main(
        [
            "init",
            "MV Alma",
            *["--length-pp-m", "180", "--beam-m", "30", "--draught-m", "10.5"],
            "--shaft-speed-rpm",
            "110",
            "--rudder-height-m",
            "7",
            "-o",
            str(tmp_path / "a.toml"),
        ]
    )
    said = capsys.readouterr().out
    assert "--shaft-speed-rpm 110, --rudder-height-m 7" in said and "110 rpm" in said and "as given" in said
    main(
        [
            "init",
            "MV Alma",
            *["--length-pp-m", "180", "--beam-m", "30", "--draught-m", "10.5"],
            "-o",
            str(tmp_path / "b.toml"),
        ]
    )
    said = capsys.readouterr().out
    assert "compare it with the bridge's" in said and "also given" not in said
