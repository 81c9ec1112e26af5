"""`twin add`: fits only what it was asked for, proves the fall where it was not fitted, and refuses when
there is none."""

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from bench.small_boats import ship_of
from tests.thorough import thorough
from twin.cli import main
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load, to_table
from twin.recording.write import write_voyage
from twin.study.prediction.openloop import HORIZONS_S, predict
from twin.study.prediction.path_prior import prior
from twin.study.track.track import track
from twin.study.update.added import FARTHER, effect_lines, notes, sailing_time, verdict
from twin.study.update.adding import UNTOUCHED, Number, fitted
from twin.study.update.addition import add
from twin.study.update.fall import Fall
from twin.study.update.proof import HeldOutProof, block_interval, prove

TIME_S = 320.0 / 7.97388  # L/U_0 of the bundled tanker


@pytest.fixture(scope="module")
def stream(make, kvlcc2):
    current = find("Current").absent(kvlcc2).but(north=-0.3, east=0.5)
    return lambda seed=0: make(current, seed=seed, name=f"stream{seed}")


@pytest.fixture(scope="module")
def added(stream, tmp_path_factory):
    """A current added to the bundled ship, by the command line; (exit code, ship file, JSON)."""
    folder = tmp_path_factory.mktemp("added")
    out, result = folder / "better.toml", folder / "add.json"
    write_voyage(stream(0), folder / "a.mcap"), write_voyage(stream(1), folder / "b.mcap")
    words = ["--voyage", folder / "a.mcap", "--held-out", folder / "b.mcap", "-o", out, "--json", result]
    code = main(["add", "Current", "--ship", "kvlcc2", *map(str, words)])
    return code, out, json.loads(result.read_text())


def test_a_hidden_current_is_found_and_the_error_falls_to_the_noise(added):
    code, path, result = added
    (effect,) = load(path).effects
    assert code == 0 and result["accepted"]
    assert effect.north == pytest.approx(-0.3, abs=0.05) and effect.east == pytest.approx(0.5, abs=0.05)
    for p in result["parameters"]["Current"].values():
        assert p["low95"] <= {True: -0.3, False: 0.5}[p["value"] < 0] <= p["high95"]
    last = result["horizons"][-1]
    assert last["after"]["position_mae_m"] < 0.1 * last["before"]["position_mae_m"]
    assert last["after"]["position_mae_m"] < 2.5 * last["noise_floor"]["position_mae_m"]


def test_the_core_stays_as_it_was_and_so_does_the_bundled_ship(added, kvlcc2):
    _, path, result = added
    assert load(path).derivatives == kvlcc2.derivatives == load("kvlcc2").derivatives
    assert any("core" in note for note in result["notes"])


def test_the_ship_file_remembers_voyages_interval_errors_and_date(added):
    _, path, result = added
    ship = load(path)
    step = ship.notes["history"][-1]
    assert step["added"] == ["Current"] and step["interval"] == "95 %" and not step["forced"]
    assert [len(v["sha256"]) for v in (*step["voyages"], *step["held_out"])] == [64, 64]
    assert [e["horizon_s"] for e in step["errors"]] == [10.0, 60.0, 120.0]
    assert step["errors"][-1]["after_m"] < step["errors"][-1]["before_m"]
    entry = to_table(ship)["effects"]["Current"]["east"]
    assert (
        entry["value"] == result["parameters"]["Current"]["east"]["value"]
        and entry["low95"] < entry["high95"]
    )


def test_without_a_held_out_voyage_the_last_third_is_held_back_and_it_is_said(sailed, stream, kvlcc2):
    made = add(kvlcc2, [find("Current")], [sailed(stream())])
    assert made.result["accepted"] and made.result["held_out"][0]["part"] == "last third"
    assert any("last third" in n for n in made.result["notes"])
    assert made.held[0].t[0] == pytest.approx(1000.0, abs=2.0)


def test_an_effect_that_is_not_there_is_refused_with_the_numbers_and_nothing_is_written(
    verb, on_disk, make, tmp_path, capsys
):
    out, result = tmp_path / "worse.toml", tmp_path / "r.json"
    words = ("--ship", "kvlcc2", "--voyage", on_disk(make()), "-o", out, "--json", result)
    assert verb("add", "PropellerWalk", *words) == 3
    assert not out.exists() and not json.loads(result.read_text())["accepted"]
    error = capsys.readouterr().err
    assert "ThresholdError: not" in error and "log likelihood ratio" in error and "--force" in error
    assert verb("add", "PropellerWalk", *words, "--force") == 0
    assert load(out).notes["history"][-1]["forced"] and json.loads(result.read_text())["forced"]


def test_a_fault_that_moves_no_track_is_judged_by_the_instrument_it_touches(sailed, make, kvlcc2):
    scale = find("SpeedLogScale").absent(kvlcc2).but(scale=-0.08)
    made = add(kvlcc2, [find("SpeedLogScale")], [sailed(make(scale))])
    assert made.proof.proved and "surge_velocity_through_water_mps" in made.fall.measure
    scale = made.result["parameters"]["SpeedLogScale"]["scale"]
    assert scale["low95"] < -0.08 < scale["high95"] < 0.0 and not scale["at_box_end"]


def test_a_log_of_one_axis_is_judged_by_the_axis_it_has(sailed, make, kvlcc2):
    """The scale of a log touches the drift through the water too, which most ships do not measure."""
    whole = make(find("SpeedLogScale").absent(kvlcc2).but(scale=-0.08))
    kept = {k: x for k, x in whole.columns.items() if k != "sway_velocity_through_water_mps"}
    made = add(kvlcc2, [find("SpeedLogScale")], [sailed(whole.with_rows(whole.time_s, kept))])
    assert made.proof.proved and "sway_velocity_through_water_mps" not in made.fall.measure


def test_a_number_of_which_nothing_that_was_recorded_tells_is_not_told(sailed, make, kvlcc2):
    """Test: an antenna 40 m ahead; no roll was recorded, which alone would show its height. Expected: the file keeps
    the height it has and says no interval of it."""
    antenna = find("AntennaOffset")
    made = add(kvlcc2, [antenna], [sailed(make(antenna.absent(kvlcc2).but(ahead=40.0)))])
    told = made.result["parameters"]["AntennaOffset"]
    assert set(told) == {"ahead", "starboard"} and told["ahead"]["low95"] < 40.0 < told["ahead"]["high95"]
    assert "low95" not in to_table(made.ship)["effects"]["AntennaOffset"].get("above", {})


@thorough
def test_two_effects_are_fitted_together(sailed, make, kvlcc2):
    hidden = [find("Current").absent(kvlcc2).but(east=0.5), find("HullFouling").absent(kvlcc2).but(extra=0.4)]
    made = add(
        kvlcc2,
        [find("Current"), find("HullFouling")],
        [sailed(make(*hidden, seed=k, name=str(k))) for k in range(2)],
    )
    found = made.result["parameters"]
    assert found["Current"]["east"]["value"] == pytest.approx(0.5, abs=0.06)
    # of a ship that was never calibrated, whose own resistance is not known either
    extra = found["HullFouling"]["extra"]
    assert extra["low95"] <= 0.4 <= extra["high95"] and extra["value"] < extra["high95"]
    assert any("never calibrated" in note for note in made.result["notes"])


def test_a_current_is_added_when_asked_for_by_name_and_said_to_belong_to_its_voyage(added):
    assert any("belong to a voyage" in note and "another day" in note for note in added[2]["notes"])
    assert load(added[1]).notes["history"][-1]["of_this_voyage"] == ["Current"]


@pytest.mark.parametrize(
    "effect, code, said",
    [
        ("Curent", 5, "Did you mean 'Current'?"),
        ("Wind", 4, "true_wind_speed_mps, true_wind_direction_deg, which was not recorded"),
    ],
)
def test_what_cannot_be_added_is_one_clear_line_and_no_file(
    verb, on_disk, make, tmp_path, capsys, effect, code, said
):
    out = tmp_path / "never.toml"
    assert verb("add", effect, "--ship", "kvlcc2", "--voyage", on_disk(make()), "-o", out) == code
    error = capsys.readouterr().err
    assert said in error and "Traceback" not in error
    assert not out.exists() and not list(tmp_path.glob(".never*"))


def test_the_voyage_is_not_overwritten_by_the_ship(verb, on_disk, make):
    path = on_disk(make())
    before = Path(path).read_bytes()
    assert verb("add", "Current", "--ship", "kvlcc2", "--voyage", path, "-o", path) == 5
    assert Path(path).read_bytes() == before


def test_a_better_model_is_proved_better_and_chance_is_not(make, kvlcc2):
    current = find("Current").absent(kvlcc2).but(east=0.4)
    t = track(make(current), kvlcc2)
    right, none = Model.of(kvlcc2).but(current), Model.of(kvlcc2)
    a, b, errors = [predict(t, none)], [predict(t, right)], prior(none, [t], HORIZONS_S)

    def proof(before, after):
        return prove(before, after, errors, HORIZONS_S, TIME_S)

    assert proof(a, b).proved and not proof(b, a).proved
    assert proof(a, a).idle and not proof(a, a).proved and not proof(a, b).idle


def test_the_interval_of_the_ratio_is_as_wide_as_overlapping_windows_make_it(make, kvlcc2):
    """What wanders over two minutes tells less than what is new at every window."""
    windows = predict(track(make("calm"), kvlcc2), Model.of(kvlcc2), HORIZONS_S)
    rng, count = np.random.default_rng(0), windows.start.size
    wander = np.convolve(rng.standard_normal(count + 11), np.ones(12), "valid")
    spread = [np.ptp(block_interval([wander], [windows], seconds)) for seconds in (10.0, 120.0)]
    assert spread[1] > 1.5 * spread[0]


def test_five_minutes_are_too_short_to_prove_anything(verb, on_disk, make, tmp_path, capsys):
    words = ("--ship", "kvlcc2", "--voyage", on_disk(make(seconds=300.0)), "-o", tmp_path / "s.toml")
    assert verb("add", "Current", *words) == 4
    assert "--held-out" in capsys.readouterr().err and not (tmp_path / "s.toml").exists()


def test_what_was_not_proved_says_how_much_more_would_do():
    """A ratio of 1.5 needs twice the sailing to reach log 20; with an interval three times as wide as itself,
    nine times."""
    made = HeldOutProof(1.5, 0.5, 2.5, (), 600.0, False)
    assert made.more_s == pytest.approx(600.0 * (np.log(20.0) / 1.5 - 1.0))
    assert HeldOutProof(1.5, -3.0, 6.0, (), 600.0, False).more_s == pytest.approx(600.0 * 8.0)
    assert (
        HeldOutProof(-1.0, -3.0, 1.0, (), 600.0, False).more_s is None
        and HeldOutProof(9.0, 4.0, 14.0, (), 600.0, False).more_s is None
    )


@pytest.mark.parametrize("after", [19.0, 26.7])
def test_a_proof_beside_an_error_in_metres_that_grows_says_what_the_proof_is_made_of(after):
    """A compass bias is seen in the readings, while chance moves where a few windows end."""
    said = verdict(
        {"added": ["HeadingBias"], "horizons": []},
        HeldOutProof(18.7, 8.0, 29.4, (), 1200.0, False),
        Fall("position", "m", 21.3, after, -9.0, 12.0, 4, 120.0),
    )
    assert said.endswith(FARTHER) == (after > 21.3)


@thorough
def test_every_third_may_be_judged_by_the_others_and_the_history_says_so(sailed, make, kvlcc2):
    """Test: 1500 s with a compass that is off. Expected: proved on all of it, where the last third holds four
    windows of two minutes."""
    off = make(find("HeadingBias").absent(kvlcc2).but(bias=0.05))
    made = add(kvlcc2, [find("HeadingBias")], [sailed(off)], cross_validated=True)
    assert made.proof.proved and made.proof.held_out_s > 1000.0
    assert made.ship.notes["history"][-1]["proof"] == "cross-validated"
    bias = made.result["parameters"]["HeadingBias"]["bias"]
    assert 0.02 < bias["low95"] < 0.05 < bias["high95"]


def test_held_out_voyages_and_cross_validation_exclude_each_other(verb, on_disk, make, tmp_path):
    path = on_disk(make())
    words = (
        "--ship",
        "kvlcc2",
        "--voyage",
        path,
        "--held-out",
        path,
        "--cross-validated",
        "-o",
        tmp_path / "x.toml",
    )
    assert verb("add", "Current", *words) == 2


def test_a_number_far_beyond_the_usual_was_not_kept_near_its_prior(make, kvlcc2):
    """Test: a screw that walks six times as hard as is usual. Expected: the voyage is said to tell it."""
    walk = find("PropellerWalk").absent(kvlcc2).but(c_y=0.06)
    numbers = fitted(kvlcc2, [find("PropellerWalk")], [track(make(walk), kvlcc2)]).numbers
    (c_y,) = [n for n in numbers if n.name == "c_y"]
    assert c_y.value > 0.03 and c_y.gained >= UNTOUCHED


def test_an_effect_of_the_one_screw_is_refused_for_a_ship_with_actuators(tmp_path, capsys):
    """Expected: before any voyage is read, with the effects of its actuators; `twin effects` of a family ends
    with a command that has a place for the actuator's name."""
    path = tmp_path / "boat.toml"
    ship_of("thrusters").save(path)
    words = ["--ship", str(path), "--voyage", str(tmp_path / "none.mcap"), "-o", str(tmp_path / "b.toml")]
    assert main(["add", "PropellerWear", *words]) == 5
    said = capsys.readouterr().err
    assert "one propeller and rudder" in said and "ThrusterWear.port" in said
    assert main(["add", "ThrusterWear.port", *words]) == 4
    capsys.readouterr()
    assert main(["effects", "ThrusterWear"]) == 0
    assert "next: twin add ThrusterWear.NAME --ship" in capsys.readouterr().out


def test_how_much_more_sailing_is_told_in_seconds_where_runs_last_a_minute():
    assert [sailing_time(s) for s in (54.0, 150.0, 7300.0)] == ["54 s", "2 minutes", "2 hours"]


def test_weather_that_does_not_show_is_not_said_to_have_been_there(kvlcc2):
    """Test: beside an effect a stream that is clear, and a wind whose numbers may all be none. Expected: the
    voyages had the stream; the wind was left open."""
    sizes = (("Current", "north", 0.2, 0.4), ("Current", "east", -0.1, 0.1), ("Wind", "c_x", 0.0, 1.4))
    beside = [Number(e, n, "", (a + b) / 2, 0.1, a, b, 0.5, False) for e, n, a, b in sizes]
    made = SimpleNamespace(names=("HullFouling",), numbers=[], beside=beside)
    told = notes(kvlcc2, made, [], [], False)
    assert any("had Current of their own" in x and "Wind" not in x for x in told)
    assert any("not clear on these voyages: Wind" in x for x in told)


def test_of_an_effect_of_many_numbers_the_largest_is_told_with_its_unit():
    """Test: the streams of three voyages. Expected: the largest of the six in m/s, whatever the others are."""
    streams = {
        f"{axis} of v{i}": {"value": 0.1 * i * sign, "unit": "m/s", "low95": 0.0, "high95": 0.1}
        for i in (1, 2, 3)
        for axis, sign in (("north", 1.0), ("east", -1.1))
    }
    (line,) = effect_lines({"Current": streams})
    assert line == "  Current: 6 numbers, the largest east of v3 = -0.33 m/s"
    turned = {f"n{i}": {"value": 0.01 * i, "unit": "rad"} for i in range(5)}
    (both,) = effect_lines({"Current": streams | turned})
    assert both.endswith("the largest east of v3 = -0.33 m/s, n4 = 2.3 deg")
