"""`twin compare`: the contract's JSON, the verdict first, thresholds, and a clear line for what cannot be
used."""

import json
from pathlib import Path

import numpy as np
import pytest

from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load, save
from twin.study.prediction.open_loop_comparison import compare, verdict

KEYS = {
    "schema_version",
    "ship",
    "model",
    "horizons",
    "channels",
    "unexplained_force",
    "learned_share",
    "where",
    "worst_windows",
    "data_checks",
}


@pytest.fixture
def stream(make, kvlcc2):
    return make(find("Current").absent(kvlcc2).but(east=0.8), name="stream")


def test_the_result_has_the_keys_of_the_contract(sailed, stream, kvlcc2):
    result = compare([sailed(stream)], Model.of(kvlcc2)).result
    assert set(result) >= KEYS
    assert set(result["model"]) >= {"effects", "hash"}
    assert [h["horizon_s"] for h in result["horizons"]] == [10.0, 60.0, 120.0]
    for row in result["horizons"]:
        assert set(row) >= {"windows", "position_mae_m", "lateral_mae_m", "heading_mae_deg", "noise_floor"}
    assert all(set(c) >= {"mae", "noise", "r2"} for c in result["channels"].values())
    assert set(result["unexplained_force"]) == {"surge", "sway", "yaw"}
    assert all(set(w) >= {"condition", "error_ratio", "time_share"} for w in result["where"])
    assert all(set(w) >= {"start_s", "end_s", "error_ratio"} for w in result["worst_windows"])
    assert all(set(c) >= {"check", "ok", "text"} for c in result["data_checks"])
    json.dumps(result, allow_nan=False)


def test_a_perfect_model_is_said_to_be_no_worse_than_one_would_look(sailed, make, kvlcc2):
    result = compare([sailed(make())], Model.of(kvlcc2)).result
    assert "no more than expected (a healthy voyage usually stays below 1.50)" in result["verdict"]
    assert result["water_sentence"] == ""
    assert max(result["unexplained_force"].values()) < 0.002 and result["learned_share"] == 0.0
    assert result["where"] == []


@pytest.mark.parametrize(
    "off, said",
    [
        ((1.2, 3.0, 1.1), "60 s open-loop"),
        ((1.2, 3.0, 1.6), "120 s open-loop"),
        ((1.2, 1.4, 1.1), "120 s open-loop"),
    ],
)
def test_the_verdict_is_of_the_longest_horizon_or_of_the_one_that_stands_out(off, said):
    floor = {"position_mae_m": 2.0, "heading_mae_deg": 1.0, "of": "sensors and structure"}
    rows = [
        {"horizon_s": h, "position_mae_m": 2.0 * x, "heading_mae_deg": 1.0, "noise_floor": floor}
        for h, x in zip((10.0, 60.0, 120.0), off, strict=True)
    ]
    words = verdict({"horizons": rows, "where": []})
    assert words.startswith(said) and ("no more than" in words) == (max(off) < 1.5)
    assert ("): more than expected (a healthy voyage usually stays below 1.50)." in words) == (
        max(off) >= 1.5
    )


def test_in_the_stream_that_the_voyage_shows_a_healthy_ship_is_no_farther_off_than_expected(
    sailed, stream, kvlcc2
):
    """Test: 0.8 m/s to the east that the model does not know. Expected: it is found from what had been seen,
    the error is less than half in it, and the verdict stays that of the model as it is."""
    result = compare([sailed(stream)], Model.of(kvlcc2)).result
    found, last = result["voyages"][0]["stream"], result["horizons"][-1]
    assert found["speed_mps"] == pytest.approx(0.8, abs=0.05)
    assert found["toward_deg"] == pytest.approx(90.0, abs=3.0)
    assert last["own_water"]["position_mae_m"] < 0.5 * last["position_mae_m"]
    assert ": more than expected" in result["verdict"]
    assert "toward 9" in result["water_sentence"] or "toward 8" in result["water_sentence"]


def test_what_is_no_stream_is_not_explained_by_one(sailed, make, kvlcc2):
    """Test: a rudder that has lost 40 %. Expected: in the stream that the voyage shows it is as far off, and
    the sentence says so."""
    worn = compare([sailed(make(find("RudderWear").absent(kvlcc2).but(loss=0.4)))], Model.of(kvlcc2)).result
    assert "still more than expected." in worn["water_sentence"]
    last = worn["horizons"][-1]
    assert last["own_water"]["heading_mae_deg"] > 0.7 * last["heading_mae_deg"]


def test_a_hidden_current_shows_in_the_errors_and_in_the_sway_force(sailed, stream, make, kvlcc2):
    calm, hidden = (compare([sailed(v)], Model.of(kvlcc2)).result for v in (make(), stream))
    assert hidden["horizons"][-1]["position_mae_m"] > 20.0 * calm["horizons"][-1]["position_mae_m"]
    assert hidden["unexplained_force"]["sway"] > 0.05
    assert hidden["channels"]["sway_velocity_mps"]["r2"] < 0.95 < calm["channels"]["sway_velocity_mps"]["r2"]


def test_two_voyages_are_judged_together_and_their_windows_add_up(sailed, make, kvlcc2):
    a, b = sailed(make(name="a")), sailed(make(seed=1, name="b"))
    alone = [compare([s], Model.of(kvlcc2)).result["horizons"][-1]["windows"] for s in (a, b)]
    both = compare([a, b], Model.of(kvlcc2)).result
    assert both["horizons"][-1]["windows"] == sum(alone)
    assert {c["voyage"] for c in both["data_checks"]} == {"a", "b"}


def test_a_calibrated_ship_is_held_against_her_structural_floor(sailed, make, kvlcc2):
    from dataclasses import replace

    notes = dict(kvlcc2.notes) | {"structural": {"floor": {"share": [0.05, 0.05, 0.05], "calm": 0.5}}}
    rows = [
        compare([sailed(make())], Model.of(s)).result["horizons"][-1]
        for s in (kvlcc2, replace(kvlcc2, notes=notes))
    ]
    assert [r["noise_floor"]["of"] for r in rows] == ["sensors", "sensors and structure"]
    assert rows[1]["noise_floor"]["position_mae_m"] > 3.0 * rows[0]["noise_floor"]["position_mae_m"]


def test_the_command_line_prints_the_verdict_first_and_the_next_command_last(verb, on_disk, make, capsys):
    assert verb("compare", on_disk(make()), "--ship", "kvlcc2") == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0].startswith("120 s open-loop error: ") and out[-1].startswith("next: twin ")


def test_json_on_standard_output_is_alone_there(verb, on_disk, make, capsys):
    assert verb("compare", on_disk(make()), "--ship", "kvlcc2", "--json", "-", "--horizon", "30") == 0
    assert [h["horizon_s"] for h in json.loads(capsys.readouterr().out)["horizons"]] == [30.0]


UNKNOWN = (
    "x",
    "position_mae=1",
    "nonsense=1",
    "channels.yaw_rate_dps.mae=1",
    "learned_share@60=1",
    "position_mae_m@soon=1",
    "position_mae_m=nan",
    "position_mae_m=inf",
)


@pytest.mark.parametrize(
    "limit, code",
    [
        ("position_mae_m=1000", 0),
        ("position_mae_m=0.001", 3),
        ("position_mae_m@10=1000", 0),
        ("noise_units=0.01", 3),
        ("unexplained_force.yaw=0.5", 0),
        ("channels.yaw_rate_degps.mae=1e-9", 3),
        ("position_mae_m@11=1000", 3),
    ],
)
def test_a_threshold_that_is_passed_is_exit_code_3(verb, on_disk, make, limit, code):
    assert verb("compare", on_disk(make()), "--ship", "kvlcc2", "--fail-above", limit) == code


@pytest.mark.parametrize(
    "words", [["--fail-above", x] for x in UNKNOWN] + [["--horizon", "-3"], ["--horizon", "soon"]]
)
def test_words_that_mean_nothing_are_a_usage_error(verb, words):
    with pytest.raises(SystemExit) as stop:
        verb("compare", "v.mcap", "--ship", "kvlcc2", *words)
    assert stop.value.code == 2


def bad_files(tmp_path, on_disk, make):
    """(path, exit code) of files that cannot be used."""
    whole = on_disk(make())
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "empty.mcap").write_bytes(b"")
    (tmp_path / "cut.mcap").write_bytes(Path(whole).read_bytes()[:300])
    (tmp_path / "noise.mcap").write_bytes(bytes(range(256)) * 20)
    (tmp_path / "words.csv").write_text("time_s,north_m\nyes,no\n")
    short = on_disk(make(seconds=60.0, name="short"))
    names = ("empty.csv", "empty.mcap", "cut.mcap", "noise.mcap", "words.csv", "absent.csv")
    return [*(str(tmp_path / n) for n in names), short, str(tmp_path)]


def test_voyages_that_cannot_be_used_are_one_clear_line_and_exit_code_4(
    verb, tmp_path, on_disk, make, capsys
):
    for path in bad_files(tmp_path, on_disk, make):
        page = tmp_path / "page.html"
        assert verb("compare", path, "--ship", "kvlcc2", "--report", page) == 4, path
        error = capsys.readouterr().err.strip().splitlines()
        assert (
            error[-1].startswith("DataError: ") and "Traceback" not in "\n".join(error) and not page.exists()
        )


def test_a_voyage_given_twice_is_refused(verb, on_disk, make, capsys):
    path = on_disk(make())
    assert verb("compare", path, path, "--ship", "kvlcc2") == 4
    assert "same voyage" in capsys.readouterr().err


def test_a_ship_file_with_an_unknown_effect_is_exit_code_5_and_names_the_nearest(
    verb, on_disk, make, tmp_path, kvlcc2, capsys
):
    save(kvlcc2, tmp_path / "s.toml")
    (tmp_path / "s.toml").write_text((tmp_path / "s.toml").read_text() + "\n[effects.Wnid]\n")
    assert verb("compare", on_disk(make()), "--ship", tmp_path / "s.toml") == 5
    assert "Did you mean 'Wind'?" in capsys.readouterr().err


@pytest.mark.parametrize("spoil", ["gaps", "nan_tail", "repeated", "constant"])
def test_spoilt_but_usable_voyages_are_compared_all_the_same(verb, on_disk, make, spoil):
    v = make()
    t, columns = v.time_s.copy(), {k: x.copy() for k, x in v.columns.items()}
    if spoil == "gaps":
        for x in columns.values():
            x[300:340] = np.nan
    if spoil == "nan_tail":
        for x in columns.values():
            x[-100:] = np.nan
    if spoil == "repeated":
        t[500] = t[499]
    if spoil == "constant":
        columns["sway_velocity_mps"][:] = 0.0
    assert verb("compare", on_disk(v.with_rows(t, columns)), "--ship", "kvlcc2") == 0


def test_a_residual_is_added_as_the_loop_adds_it_and_its_share_is_told(verb, on_disk, make, tmp_path):
    from twin.live.learning.residual import bundled

    path = bundled(load("kvlcc2"))
    if path is None:
        pytest.skip("no residual comes with this ship")
    words = ("--ship", "kvlcc2", "--residual", path, "--json", tmp_path / "r.json")
    assert verb("compare", on_disk(make()), *words) == 0
    result = json.loads((tmp_path / "r.json").read_text())
    assert 0.0 < result["learned_share"] < 0.2 and result["model"]["residual"]


def test_a_residual_made_for_another_ship_is_exit_code_5(verb, on_disk, make, capsys):
    from twin.live.learning.residual import bundled

    path = bundled(load("kvlcc2"))
    if path is None:
        pytest.skip("no residual comes with this ship")
    assert verb("compare", on_disk(make()), "--ship", "container", "--residual", path) == 5
    assert "KVLCC2" in capsys.readouterr().err
