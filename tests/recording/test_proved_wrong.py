"""A proved mistake stops whoever would judge the voyage, before any number; who accepts it goes on."""

import json

import numpy as np
import pytest

import twin
from twin.cli import main
from twin.errors import DataError, SettingsError
from twin.recording.checks import of_voyages, run_checks
from twin.recording.read import read_voyage

KNOT = 1852.0 / 3600.0
VELOCITIES = ("surge_velocity_mps", "sway_velocity_mps")


def knots(columns):
    return columns | {name: columns[name] / KNOT for name in VELOCITIES}


PLANTED = {
    "knots": (knots, 'unit = "kn" for surge_velocity_mps', "velocity_frame"),
    "radians": (
        lambda c: c | {"heading_true_north_deg": np.radians(c["heading_true_north_deg"])},
        'unit = "rad" for heading_true_north_deg',
        "velocity_frame",
    ),
    "milliseconds": (
        lambda c: c | {"time_s": 1000.0 * c["time_s"]},
        '[time] unit = "ms"',
        "velocity_frame",
    ),
    "rudder to port": (
        lambda c: c | {"rudder_angle_deg": -c["rudder_angle_deg"]},
        "sign = -1 for rudder_angle_deg",
        "rudder_sign",
    ),
}


@pytest.fixture(params=PLANTED)
def planted(request, sail, write_csv):
    plant, remedy, check = PLANTED[request.param]
    return write_csv(plant(sail(450.0))), remedy, check


def one_line(error):
    assert "\n" not in str(error) and error.exit_code == 4
    return str(error)


def test_a_table_of_our_own_columns_with_a_mistake_is_judged_by_nobody(planted):
    path, remedy, check = planted
    ship, voyage = twin.Ship.load("container"), twin.read_voyage(path)
    with pytest.raises(DataError) as caught:
        twin.compare(ship, voyage)
    said = one_line(caught.value)
    assert said.startswith("voyage: not judged.") and remedy in said
    assert f"twin import {path} --map" in said and f"--accept {check}" in said


@pytest.mark.parametrize(
    "judge",
    [
        lambda ship, v: twin.diagnose(ship, v),
        lambda ship, v: twin.calibrate(ship, v),
        lambda ship, v: twin.add(ship, "HullFouling", v),
        lambda ship, v: twin.tube(ship, v),
        lambda ship, v: twin.instruments(ship, v),
    ],
    ids=("diagnose", "calibrate", "add", "tube", "instruments"),
)
def test_every_judge_asks_first(judge, sail, write_csv):
    voyage = twin.read_voyage(write_csv(knots(sail(450.0))))
    with pytest.raises(DataError, match=r"not judged\. velocity_frame: .*knots"):
        judge(twin.Ship.load("container"), voyage)


@pytest.mark.parametrize("verb", ["compare", "diagnose"])
def test_the_command_ends_with_4_and_prints_no_number(verb, sail, write_csv, capsys):
    path = write_csv(knots(sail(450.0)))
    assert main([verb, str(path), "--ship", "container", "--json", "-"]) == 4
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("DataError: ") == 1 and "in knots" in said.err


def test_the_remedy_as_a_map_of_one_line_gives_back_the_truth(sail, write_csv, tmp_path):
    columns = sail(450.0)
    path, by = write_csv(knots(columns)), tmp_path / "m.toml"
    by.write_text("[columns]\n" + "\n".join(f'{name} = {{ unit = "kn" }}' for name in VELOCITIES) + "\n")
    voyage = twin.read_voyage(path, by)
    assert of_voyages([voyage]) and not any(c.unusable for c in run_checks(voyage))
    np.testing.assert_allclose(voyage["surge_velocity_mps"], columns["surge_velocity_mps"], rtol=1e-6)


def test_what_its_owner_accepted_at_import_is_judged(sail, write_csv, tmp_path):
    path, out = write_csv(knots(sail(450.0))), tmp_path / "v.mcap"
    assert main(["import", str(path), "-o", str(out)]) == 4
    assert main(["import", str(path), "-o", str(out), "--accept", "velocity_frame"]) == 0
    voyage = read_voyage(out)
    assert voyage.meta["accepted"] == ["velocity_frame"]
    told = {c["check"]: c for c in of_voyages([voyage])}["velocity_frame"]
    assert told["proved"] and not told["ok"], "it is still said"
    assert not twin.check_voyage(None, voyage).refused()


def test_accepting_another_check_does_not_let_it_pass(sail, write_csv):
    path = write_csv(knots(sail(450.0)))
    with pytest.raises(DataError, match="velocity_frame"):
        of_voyages([twin.read_voyage(path, accept=["rudder_sign"])])
    assert of_voyages([twin.read_voyage(path, accept=["velocity_frame"])])
    with pytest.raises(SettingsError, match="Did you mean 'velocity_frame'"):
        twin.read_voyage(path, accept=["velocity_fram"])


def test_a_voyage_of_a_dataframe_says_what_to_do_in_python(sail):
    import pandas

    voyage = twin.Voyage.from_dataframe(pandas.DataFrame(knots(sail(450.0))), "june")
    with pytest.raises(DataError) as caught:
        of_voyages([voyage])
    said = one_line(caught.value)
    assert "june: not judged" in said and "voyage.with_meta(accepted=['velocity_frame'])" in said
    assert "twin import" not in said and of_voyages([voyage.with_meta(accepted=["velocity_frame"])])


def test_a_healthy_voyage_and_one_that_asks_for_a_look_go_through(sail, write_csv):
    doubts = [c for c in of_voyages([read_voyage(write_csv(sail(200.0)))]) if not c["ok"]]
    assert [c["check"] for c in doubts] == ["duration"]
    assert json.dumps(doubts)
