"""What stands on the pages of `init`, `import`, `history`, `replay` and `train`: the numbers that the verb says."""

import json
import re
from dataclasses import replace
from html import unescape

import numpy as np
import pytest

import twin
from tests.report import pages
from tests.report.boat import straight_with_a_turn
from tests.report.test_report import commands_of, opened
from tests.thorough import thorough
from twin import cli
from twin.commands.story import MONDAY, SHIP
from twin.live.bridge.scene import MODES
from twin.live.guard import HYBRID, INVALID, PHYSICS, RECKONING, STARTING
from twin.live.replay_record import MOMENTS_KEPT, SPANS, Kept, Spans
from twin.recording.write import write_voyage
from twin.report.history_page import history_page, sentence, steps_of
from twin.report.page import PLOTS, html
from twin.report.training_page import training_page

BOAT = ["180", "30", "10.5"]


def words(page):
    """What a person reads on it."""
    return " ".join(unescape(re.sub(r"<style>.*?</style>|<[^>]+>", " ", page, flags=re.S)).split())


def data_of(path):
    return json.loads(re.search(r'<script id="data"[^>]*>(.*?)</script>', path.read_text(), re.S)[1])


def test_init_import_and_history_write_the_page_they_are_asked_for(tmp_path, capsys):
    """Expected: each page is there, whole, and its verb says so."""
    ship, log = str(tmp_path / "<script>.toml"), str(tmp_path / "m.mcap")
    page = {verb: tmp_path / f"{verb}.html" for verb in ("init", "import", "history")}
    sizes = [w for pair in zip(("--length-pp-m", "--beam-m", "--draught-m"), BOAT, strict=True) for w in pair]
    name = "<script>alert(1)</script>"
    assert cli.main(["init", name, *sizes, "-o", ship, "--report", str(page["init"])]) == 0
    asked = ["--ship", str(SHIP), "-o", log, "--report", str(page["import"])]
    assert cli.main(["import", str(MONDAY), *asked]) == 0
    assert cli.main(["history", ship, "--report", str(page["history"])]) == 0
    said = capsys.readouterr().out
    assert all(f"wrote {path}" in said for path in page.values())
    for path in page.values():
        text = path.read_text()
        assert text.endswith("</html>\n") and "<script" not in text
        assert not re.findall(r"""(?:src|href)=|url\(|@import|https?://(?!www\.w3\.org)""", text)
    assert "nothing was added or removed yet" in words(page["history"].read_text())


def test_a_page_that_cannot_be_written_is_said_before_any_work(tmp_path, capsys):
    nowhere = str(tmp_path / "no" / "page.html")
    assert cli.main(["replay", str(MONDAY), "--ship", str(SHIP), "--report", nowhere]) == 1
    assert "no such folder" in capsys.readouterr().err


def test_a_refused_import_still_writes_its_page(tmp_path, capsys):
    """Test: the rudder with its sign turned. Expected: exit code 4, no voyage, and a page that says which check."""
    monday = twin.read_voyage(MONDAY)
    turned = dict(monday.columns) | {"rudder_angle_deg": -monday.columns["rudder_angle_deg"]}
    log, page, out = tmp_path / "turned.mcap", tmp_path / "page.html", tmp_path / "out.mcap"
    write_voyage(monday.with_rows(monday.time_s, turned), log)
    assert cli.main(["import", str(log), "--ship", str(SHIP), "-o", str(out), "--report", str(page)]) == 4
    assert not out.exists() and "rudder_sign" in capsys.readouterr().err
    assert "rudder_sign: a sign, unit or frame is wrong." in words(page.read_text())
    assert "rudder_sign mistake" in words(page.read_text())


def test_a_voyages_page_draws_every_channel_that_was_recorded():
    monday = twin.read_voyage(MONDAY)
    page = twin.check_voyage(None, monday).page()
    drawings = re.findall(r'<svg class="bars".*?</svg>', page)
    assert len(drawings) == sum(monday.has(name) for name in monday.columns)


def test_the_history_begins_with_the_calibration_and_tells_every_step():
    """Expected: the order of the dates; before, after and expected of each; what was taken out, what was forced."""
    ship = pages.with_history(twin.Ship.load("kvlcc2"))
    assert [s["date"] for s in steps_of(ship)] == ["2026-04-01", "2026-05-01", "2026-05-02", "2026-05-03"]
    said = words(history_page(ship))
    assert (
        "3 steps; + Wind brought the error 60 s ahead from 20.0 m to 20.0 m, where 2.0 m is expected" in said
    )
    for part in (
        "2026-04-01 calibration 1.50 m after",
        "2026-05-01 + Current 21.0 m before 6.00 m after 2.00 m expected",
        "2026-05-01 + Current no Current",
        "2026-05-02 − Current no no",
        "2026-05-03 + Wind yes, without proof no",
        "held-out voyages 19.9 15.3 24.7 3.00",
        "judged on tuesday (last third)",
    ):
        assert part in said, part


def test_the_history_says_that_what_brought_the_fall_was_removed_since():
    """Test: an effect that was added, judged and removed. Expected: no word that the model without it is as near."""
    ship = pages.with_history(twin.Ship.load("kvlcc2"))
    steps = ship.notes["history"][:2]
    assert sentence(replace(ship, notes=dict(ship.notes) | {"history": steps})) == (
        "KVLCC2: 2 steps; Current was removed since the last step that was judged: + Current brought the error "
        "60 s ahead from 21.0 m to 6.00 m, where 2.0 m is expected."
    )


def test_the_page_of_a_training_shows_its_curves_its_proof_and_its_bound():
    page = training_page(pages.training())
    said = words(page)
    for part in (
        "The residual is worth having.",
        "7 % of all force is learned",
        "after 10 s 4.00 m physics alone 1.00 m with residual",
        "Loss: single moments: acceleration",
        "force ahead 1000000 N",
        "surge -0.100 1.20 -",
        "judges monday 2",
        "the best of 2 seeds on validation is 123",
    ):
        assert part in said, part
    assert page.count("<polyline") == 4  # training and validation, of two stages


@pytest.fixture(scope="module")
def replayed(tmp_path_factory):
    """(what the verb said as JSON, what its page holds) of a boat's voyage."""
    folder = tmp_path_factory.mktemp("replayed")
    log, told, page = folder / "log.mcap", folder / "told.json", folder / "page.html"
    write_voyage(twin.read_voyage(straight_with_a_turn(folder / "v.csv", 3)), log)
    asked = ["replay", str(log), "--ship", "usv", "--json", str(told)]
    assert cli.main([*asked, "--report", str(page)]) == 0
    return json.loads(told.read_text()), data_of(page), asked


def values(text):
    import base64

    return np.frombuffer(base64.b64decode(text), "<f4")


def test_the_page_of_a_replay_holds_what_the_verb_says(replayed):
    told, page, _ = replayed
    assert told.items() <= page["result"].items()
    far = told["foresight"][-1]
    assert page["verdict"].startswith(f"{far['horizon_s']:g} s ahead the twin is off by ")
    modes = {row["mode"]: sum(b - a for a, b in row["spans"]) for row in page["modes"]}
    assert modes.keys() == told["modes"].keys()
    assert sum(modes.values()) == pytest.approx(told["duration_s"], abs=2.0)
    assert [row["reason"] for row in page["reasons"]] == list(told["reasons"])


def test_the_page_of_a_replay_shows_every_mode_in_the_colour_of_the_viewer(replayed):
    _, page, _ = replayed
    assert {row["mode"]: row["level"] for row in page["modes"]} == {
        row["mode"]: MODES[row["mode"]][0] for row in page["modes"]
    }
    assert MODES.keys() == {STARTING, HYBRID, PHYSICS, RECKONING, INVALID}


def test_the_commands_of_a_replays_page_take_a_file_name_as_one_word(replayed, tmp_path):
    _, page, _ = replayed
    names = {"MV Alma.toml", "monday $(reboot).mcap"}
    told = page["result"] | {"files": {"ship": "MV Alma.toml"}, "log": "monday $(reboot).mcap"}
    (tmp_path / "page.html").write_text(html(page | {"result": told}, (*PLOTS, "replay.js")))
    commands = commands_of(opened(tmp_path / "page.html")[0])
    words = {words[1]: set(words) for words in commands}
    assert "MV Alma.toml" in words["tube"] and names < words["compare"]


def test_the_page_of_a_replay_shows_the_estimate_beside_what_was_measured(replayed):
    """Expected: the residual that is drawn is measured minus estimated, and smaller than the noise that was put in."""
    _, page, _ = replayed
    voyage = page["voyages"][0]
    channels = {c["name"]: c for c in voyage["channels"]}
    assert set(channels) == {
        "north_m",
        "east_m",
        "heading_true_north_deg",
        "surge_velocity_mps",
        "sway_velocity_mps",
        "yaw_rate_degps",
    }
    c = channels["surge_velocity_mps"]
    t, at = values(voyage["times"][c["measured"]["t"]]), values(voyage["times"][c["lines"]["estimate"]["t"]])
    off = values(c["measured"]["y"]) - np.interp(t, at, values(c["lines"]["estimate"]["y"]))
    shown = values(c["residuals"]["estimate"]["y"])
    assert shown == pytest.approx(off[-shown.size :], abs=1e-4)
    assert 0.0 < np.std(shown[shown.size // 2 :]) < 0.01  # of the noise that was put in
    assert abs(np.diff(values(channels["heading_true_north_deg"]["measured"]["y"]))).max() < 180.0


def test_the_page_of_a_replay_without_positions_opens(tmp_path):
    """Test: a log of heading, speeds and controls alone. Expected: its plots, no track, and no complaint."""
    voyage = twin.read_voyage(straight_with_a_turn(tmp_path / "v.csv", 3))
    columns = {n: x for n, x in voyage.columns.items() if n not in ("north_m", "east_m")}
    log, page = tmp_path / "log.mcap", tmp_path / "page.html"
    write_voyage(voyage.with_rows(voyage.time_s, columns), log)
    assert cli.main(["replay", str(log), "--ship", "usv", "--report", str(page)]) == 0
    assert data_of(page)["voyages"][0]["track"] is None
    dom, complaints = opened(page)
    assert complaints == [] and "heading" in dom and "Provenance" in dom and "<h2>Track" not in dom


def test_predictions_are_judged_where_the_helm_was_held_and_apart_from_that(replayed):
    """Test: a boat that turns once. Expected: errors of both kinds, and none is of both."""
    _, page, _ = replayed
    voyage = page["voyages"][0]
    place = next(c for c in voyage["foretold"] if c["word"] == "place, 10 s ahead")
    held, moved = (set(values(voyage["times"][place[key]["t"]]).tolist()) for key in ("error", "moved"))
    assert len(held) > 5 and len(moved) > 1 and not held & moved
    assert values(place["error"]["y"]).min() >= 0.0 and np.median(values(place["error"]["y"])) < 1.0
    assert values(voyage["times"][place["tube"]["t"]]).size == 0  # this ship file promises none


def test_as_many_errors_are_drawn_inside_the_tube_as_the_verb_says(tmp_path):
    """Expected: the share of the drawn errors within the drawn tube is the summary's, of places and of headings."""
    (tmp_path / "page.html").write_text(pages.replay(tmp_path / "boat"))
    page = data_of(tmp_path / "page.html")
    (row,) = page["result"]["tube"]
    drawn = page["voyages"][0]["foretold"]
    for which, share in (("place", row["place_inside"]), ("heading", row["heading_inside"])):
        c = next(c for c in drawn if c["word"] == f"{which}, {row['horizon_s']:g} s ahead")
        times = page["voyages"][0]["times"]
        high = dict(zip(values(times[c["tube"]["t"]]).tolist(), values(c["tube"]["high"]), strict=True))
        pairs = zip(values(times[c["error"]["t"]]).tolist(), values(c["error"]["y"]), strict=True)
        inside = [abs(y) <= high[t] for t, y in pairs if t in high]
        assert len(inside) == row["judged"] and np.mean(inside) == pytest.approx(share)


def test_the_same_replay_gives_the_same_sum_and_another_log_another_one(replayed, tmp_path):
    _, page, asked = replayed
    again = tmp_path / "again.html"
    assert cli.main([*asked, "--report", str(again)]) == 0
    assert data_of(again)["sha256"] == page["sha256"] and len(page["sha256"]) == 64
    other = tmp_path / "other.mcap"
    write_voyage(twin.read_voyage(straight_with_a_turn(tmp_path / "w.csv", 4)), other)
    assert cli.main(["replay", str(other), "--ship", "usv", "--report", str(again)]) == 0
    assert data_of(again)["sha256"] != page["sha256"]


def test_what_a_replay_keeps_is_bounded_and_still_covers_the_voyage():
    """Test: ten times as many moments as are kept, and a word that comes and goes each other one."""
    kept, spans = Kept(["time_s", "x"]), Spans()
    for k in range(10 * MOMENTS_KEPT):
        kept.take({"time_s": float(k), "x": 2.0 * k})
        if k % 40 < 20:
            spans.take(float(k), ["flickers"], 1.5)
    t, x = (np.array(kept.columns[name]) for name in ("time_s", "x"))
    assert MOMENTS_KEPT // 2 <= t.size < MOMENTS_KEPT and t[0] == 0.0 and t[-1] > 9.9 * MOMENTS_KEPT
    assert set(np.diff(t)) == {float(kept.every)} and (x == 2.0 * t).all()
    found = spans.of["flickers"]
    assert 1 <= len(found) <= SPANS and found[0][0] == 0.0 and found[-1][1] > 9.9 * MOMENTS_KEPT


@thorough
def test_the_page_of_a_diagnosis_expects_of_the_ship_what_compare_expects(tmp_path):
    """Test: Monday's diagnosis as a page, and compare of the same voyage. Expected: the same expected errors."""
    ship, monday = twin.Ship.load(SHIP), twin.read_voyage(MONDAY)
    path = tmp_path / "diagnosis.html"
    twin.diagnose(ship, monday).write_page(path)
    drawn, said = data_of(path)["result"]["horizons"], twin.compare(ship, monday).to_dict()["horizons"]
    assert [h["horizon_s"] for h in drawn] == [h["horizon_s"] for h in said]
    for a, b in zip((h["noise_floor"] for h in drawn), (h["noise_floor"] for h in said), strict=True):
        assert a["of"] == b["of"] == "reference voyages"
        for error in ("position_mae_m", "lateral_mae_m", "heading_mae_deg"):
            assert a[error] == pytest.approx(b[error], rel=0.05)
