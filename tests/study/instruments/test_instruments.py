"""Faults of known size in the instruments of a ship of kinematics alone are found, and nothing is found where
none is."""

import json
from pathlib import Path

import numpy as np
import pytest

import twin
from tests.recording.conftest import motion, nmea_lines, sentence
from tests.thorough import thorough
from twin.api.json_key import absent_keys, unknown_paths
from twin.api.json_keys import KEYS
from twin.cli import main
from twin.errors import DataError, UsageError
from twin.physics.ship import load
from twin.recording.raw import Raw
from twin.recording.voyage import Voyage
from twin.study.instruments.arrow import Block, reduce
from twin.study.instruments.instrument_estimate import estimate
from twin.study.instruments.instrument_lines import as_json, terminal_lines
from twin.study.instruments.instrument_samples import of_voyage
from twin.study.instruments.spline import Spline

HEADING, RATE, LOG = "heading_true_north_deg", "yaw_rate_degps", "surge_velocity_through_water_mps"
EVERY = 5  # of the samples of the healthy ship, so that a test is quick
KEPT = ("time_s", "north_m", "east_m", HEADING, "surge_velocity_mps", "sway_velocity_mps", RATE, LOG)


@pytest.fixture
def healthy(sail):
    """{column: (N,)} of twelve minutes of zigzags twice a second; neither rudder nor shaft."""
    full = sail(720.0, seed=3)
    return {name: full[name][::EVERY] for name in KEPT}


def voyage(columns, frame="body"):
    columns = dict(columns)
    time_s = columns.pop("time_s")
    return Voyage.of(
        Raw(Path("zigzag.csv"), np.arange(time_s.size), time_s, columns, {"velocity_frame": frame}),
        controls=False,
    )


def late(columns, name, seconds):
    x = np.unwrap(columns[name], period=360.0) if name == HEADING else columns[name]
    return columns | {name: np.interp(columns["time_s"] - seconds, columns["time_s"], x)}


def compass(columns, error):
    """A compass that is off by error(psi) [rad]."""
    psi = np.radians(columns[HEADING])
    return columns | {HEADING: np.mod(np.degrees(psi + error(psi)), 360.0)}


def straight(like):
    """Columns of a voyage on one course at 6 m/s, sampled as `like`."""
    t = like["time_s"]
    rng = np.random.default_rng(5)
    return {
        "time_s": t,
        "north_m": 6.0 * t + 0.3 * rng.normal(size=t.size),
        "east_m": 0.3 * rng.normal(size=t.size),
        HEADING: np.mod(0.1 * rng.normal(size=t.size), 360.0),
        RATE: 0.02 * rng.normal(size=t.size),
        "surge_velocity_mps": 6.0 + 0.05 * rng.normal(size=t.size),
        "sway_velocity_mps": 0.05 * rng.normal(size=t.size),
    }


def near(found, name, truth):
    """Within three of its own scatters, and no wider than that."""
    e = found.of(name)
    assert e.seen and abs(e.value - truth) < 3.0 * e.sd, (name, e.value, e.sd)


def test_a_healthy_ship_has_no_fault_and_its_stream_is_found(healthy):
    found = estimate([voyage(healthy)], 100.0)
    assert found.faults == ()
    for name, truth in (("current_north", 0.3), ("current_east", -0.4)):
        near(found, name, truth)
    assert "No instrument disagrees" in terminal_lines(found)[0]


def with_sternway(seconds=720.0, astern=(480.0, 600.0), slides=0.5):
    """A boat of 2 m that zigzags at 1.5 m/s, and for a while goes astern at 1 m/s and slides to starboard, as
    no formula of a turn has it; healthy instruments, twice a second."""
    t = np.arange(0.0, seconds, 0.05)
    rng, back = np.random.default_rng(4), np.clip(np.minimum(t - astern[0], astern[1] - t) / 5.0, 0.0, 1.0)
    psi = np.radians(25.0) * np.sin(t / 4.0) * (1.0 - back) + 0.3 * np.sin(t / 90.0)
    r = np.gradient(psi, t)
    u = 1.5 - 2.5 * back
    v = -0.4 * 2.0 * r + slides * np.maximum(-u, 0.0)
    over = (u + 1j * v) * np.exp(1j * psi)
    place = np.r_[0.0, np.cumsum((over[1:] + over[:-1]) / 40.0)]
    t, psi, r, u, v, place = (x[::10] for x in (t, psi, r, u, v, place))
    noisy = lambda x, sd: x + sd * rng.normal(size=t.size)
    return {
        "time_s": t, "north_m": noisy(place.real, 0.05), "east_m": noisy(place.imag, 0.05),
        HEADING: np.mod(noisy(np.degrees(psi), 0.1), 360.0), RATE: noisy(np.degrees(r), 0.1),
        "surge_velocity_mps": noisy(u, 0.03), "sway_velocity_mps": noisy(v, 0.03),
    }  # fmt: skip


@thorough
def test_a_boat_that_slides_as_it_goes_astern_has_no_fault_of_its_compass():
    """Test: a minute or two of sternway in which the boat slides to starboard, with a healthy compass and
    with one that is 3 deg off. Expected: nothing, and that: how a ship drifts in a turn is told of one that
    has way ahead."""
    columns = with_sternway()
    found = estimate([voyage(columns, "course")], 2.0)
    assert "heading_bias" not in found.faults and abs(found.of("A").value) < 3.0 * found.of("A").sd
    found = estimate([voyage(compass(columns, lambda psi: 0.05), "course")], 2.0)
    assert "heading_bias" in found.faults
    near(found, "A", 0.05)


@thorough
def test_the_scale_of_a_gyro_is_told_only_where_the_receiver_turned_its_velocity_itself():
    """Test: a boat that zigzags within 25 deg, its gyro a fifth too much. Expected: that, with a velocity in the
    receiver's own axes; nothing of a scale where the compass turned it, whose deviation would do as well."""
    columns = with_sternway()
    scaled = columns | {RATE: 1.2 * columns[RATE]}
    found = estimate([voyage(scaled, "body")], 2.0)
    assert found.faults == ("gyro_scale",)
    near(found, "gyro_scale", 0.2)
    assert "gyro_scale" not in estimate([voyage(scaled, "course")], 2.0).log_bayes_factors


@pytest.mark.parametrize(
    "fault, effect, name, truth, plant",
    [
        ("heading_delay", "HeadingLag", "heading_delay", 2.0, lambda c: late(c, HEADING, 2.0)),
        ("heading_bias", "HeadingBias", "A", -0.3, lambda c: compass(c, lambda psi: -0.3)),
        ("deviation", "CompassDeviation", "B", 0.1, lambda c: compass(c, lambda psi: 0.1 * np.sin(psi))),
        ("gyro_bias", "GyroBias", "gyro_bias", 0.001, lambda c: c | {RATE: c[RATE] + np.degrees(0.001)}),
        ("gyro_scale", "GyroScale", "gyro_scale", 0.1, lambda c: c | {RATE: 1.1 * c[RATE]}),
        ("log_scale", "SpeedLogScale", "log_scale", -0.25, lambda c: c | {LOG: 0.75 * c[LOG]}),
    ],
)
def test_a_fault_is_found_with_its_size_and_by_its_name(healthy, fault, effect, name, truth, plant):
    found = estimate([voyage(plant(healthy))], 100.0)
    assert fault in found.faults
    near(found, name, truth)
    said = next(f for f in as_json(found)["faults"] if f["fault"] == fault)
    assert said["effect"] == effect and said["residuals"]


@thorough
def test_no_age_is_told_by_the_drift_in_a_turn_alone(healthy):
    """Test: heading and rate of turn two seconds late together, velocity turned by the compass, a log of one
    axis. Expected: of the two neither, since only how the ship drifts would tell; of a heading that is late
    beside a prompt rate of turn its age, and of a late log its own, from the position."""
    both = late(late(healthy, HEADING, 2.0), RATE, 2.0)
    found = estimate([voyage(both, "course")], 100.0)
    assert not {"heading_delay", "rate_delay"} & set(found.faults)
    assert "log" not in found.relative[1]
    near(estimate([voyage(late(healthy, HEADING, 2.0), "course")], 100.0), "heading_delay", 2.0)


def test_two_faults_are_told_apart(healthy):
    found = estimate([voyage(late(healthy | {RATE: healthy[RATE] + np.degrees(0.001)}, HEADING, 2.0))], 100.0)
    assert set(found.faults) == {"heading_delay", "gyro_bias"}
    near(found, "heading_delay", 2.0)
    near(found, "gyro_bias", 0.001)


@thorough
def test_whose_attitude_turned_the_velocity_is_the_same_on_all_voyages_of_a_ship(healthy):
    """A compass is two seconds late and the receiver's own attitude turned a noisy velocity: a zigzag tells,
    thirty seconds of it do not."""
    columns, rng = late(healthy, HEADING, 2.0), np.random.default_rng(6)
    for name in ("surge_velocity_mps", "sway_velocity_mps"):
        columns[name] = columns[name] + 0.2 * rng.normal(size=columns[name].size)
    short, zigzag = voyage({name: x[:60] for name, x in columns.items()}, ""), voyage(columns, "")
    assert estimate([short], 100.0).own == (False,)
    assert estimate([short, zigzag], 100.0).own == (True, True)
    assert estimate([short], 100.0, own=True).own == (True,)


def test_the_same_readings_are_asked_once_whose_attitude_turned_the_velocity(healthy):
    readings, first, again = of_voyage(voyage({n: x[:200] for n, x in healthy.items()}, "")), [], []
    assert estimate([readings], 100.0, first.append).own == estimate([readings], 100.0, again.append).own
    assert [sum("whose attitude" in line for line in lines) for lines in (first, again)] == [1, 0]


def test_a_straight_course_says_that_ages_cannot_be_known(healthy):
    """Test: no turn. Expected: nothing named, and what it would take is said."""
    found = estimate([voyage(straight(healthy), "course")], 100.0)
    assert found.faults == ()
    assert all(
        (e := found.of(name)) is None or not e.known for name in ("heading_delay", "rate_delay", "A", "B")
    )
    assert any("not known beside all others" in line for line in terminal_lines(found))


def test_without_heading_it_is_refused_in_one_line(healthy):
    with pytest.raises(DataError, match="needs heading_true_north_deg"):
        voyage({k: v for k, v in healthy.items() if k != HEADING})


def test_the_verb_writes_json_and_a_ship_file_that_loads(healthy, write_csv, tmp_path, capsys):
    path = write_csv(late(healthy, HEADING, 2.0))
    out, answer = tmp_path / "mended.toml", tmp_path / "answer.json"
    assert main(["instruments", str(path), "--ship", "kvlcc2", "-o", str(out), "--json", str(answer)]) == 0
    said = json.loads(answer.read_text())
    assert said["schema_version"] == 1 and [f["effect"] for f in said["faults"]] == ["HeadingLag"]
    assert {n["name"]: n for n in said["numbers"]}["heading_delay"]["value"] == pytest.approx(2.0, abs=0.2)
    lag = next(e for e in load(out).effects if type(e).__name__ == "HeadingLag")
    assert lag.lag == pytest.approx(2.0, abs=0.2) and lag.turned == 0.0
    assert "shown by the residuals of" in capsys.readouterr().out


def test_of_two_compasses_on_one_bus_each_can_be_asked(tmp_path, capsys):
    """Test: HE is right but for its noise, GP comes 3 s late. Expected: the late one is named, the other one
    not."""
    m, path = motion(600), tmp_path / "bridge.log"
    noisy_psi = m["psi"] + np.random.default_rng(5).normal(0.0, 0.1, m["psi"].size)
    late_psi = np.interp(m["t"] - 3.0, m["t"], m["psi"])
    headings = [[f"HEHDT,{a:.2f},T", f"GPHDT,{b:.2f},T"] for a, b in zip(noisy_psi, late_psi, strict=True)]
    path.write_text(
        "".join(
            f"{s}\n"
            for i in range(600)
            for s in [s for s in nmea_lines(m, i) if "HDT" not in s] + [sentence(h) for h in headings[i]]
        )
    )
    seen = {}
    for name in ("HE", "GP"):
        source, answer = f"heading_true_north_deg={name}", tmp_path / f"{name}.json"
        assert main(["instruments", str(path), "--source", source, "--json", str(answer)]) == 0
        seen[name] = {f["effect"] for f in json.loads(answer.read_text())["faults"]}
    assert "HeadingLag" in seen["GP"] and "HeadingLag" not in seen["HE"]
    assert main(["instruments", str(path), "--source", "heading_true_north_deg=XX"]) == 5
    assert "its sources are GP, HE" in capsys.readouterr().err


def test_in_python_it_is_the_verbs_json_a_line_a_page_and_a_corrected_ship(healthy, write_csv):
    """Test: a late compass, rudder and shaft not recorded. Expected: every key of the table, and no other."""
    path, ship = write_csv(late(healthy, HEADING, 2.0)), load("kvlcc2")
    with pytest.raises(DataError, match="needs rudder_angle_deg"):
        twin.read_voyage(path)
    found = twin.instruments(ship, twin.read_voyage(path, controls=False))
    assert unknown_paths(KEYS["instruments"], found.to_dict()) == []
    assert absent_keys(KEYS["instruments"], found.to_dict()) == []
    assert found.faults == ["heading_delay"] and found.effects == ["HeadingLag"]
    assert repr(found) == "<InstrumentCheck of voyage: heading_delay>"
    assert "Heading late" in found.page() and "HeadingLag" in found.page()
    lag = next(e for e in found.corrected(ship).effects if type(e).__name__ == "HeadingLag")
    assert lag.lag == pytest.approx(2.0, abs=0.2)


def test_another_word_for_what_turned_the_velocity_is_refused_in_one_line(healthy):
    with pytest.raises(UsageError, match="velocity_by='gyro': give 'compass' or 'receiver'"):
        twin.instruments(None, voyage(healthy), velocity_by="gyro")


def test_a_map_takes_off_what_a_map_can(healthy, write_csv, tmp_path, capsys):
    path, out = write_csv(compass(healthy, lambda psi: 0.1)), tmp_path / "map.toml"
    assert main(["instruments", str(path), "-o", str(out)]) == 0
    line = next(x for x in out.read_text().splitlines() if x.startswith(HEADING))
    assert float(line.split("offset = ")[1].split()[0]) == pytest.approx(-np.degrees(0.1), abs=0.3)


@pytest.mark.parametrize("ship", [[], ["--ship", "kvlcc2"]])
def test_where_no_fault_is_seen_no_file_is_written_and_the_answer_is(
    ship, healthy, write_csv, tmp_path, capsys
):
    """Expected: exit code 3, a line that says why there is no file, and the JSON that was asked for."""
    out, answer = tmp_path / "corrected.toml", tmp_path / "answer.json"
    asked = ["instruments", str(write_csv(healthy)), *ship, "-o", str(out), "--json", str(answer)]
    assert main(asked) == 3
    assert not out.exists() and json.loads(answer.read_text())["faults"] == []
    assert f"{out} was not written: no fault of an instrument was seen." in capsys.readouterr().out


def test_a_splines_slopes_are_those_of_its_values():
    path, t = Spline.over(0.0, 10.0, 0.7), np.linspace(1.0, 9.0, 40)
    c = np.random.default_rng(0).normal(size=(path.size, 2))
    for k in (0, 1):
        up, down = (path.value(c, path.weights(t + s * 1e-5, k)) for s in (1, -1))
        np.testing.assert_allclose(path.value(c, path.weights(t, k + 1)), (up - down) / 2e-5, atol=1e-5)


def test_states_eliminated_is_what_the_whole_matrix_says():
    from scipy.sparse import csr_array

    rng = np.random.default_rng(1)
    J, G, r = rng.normal(size=(30, 8)), rng.normal(size=(30, 3)), rng.normal(size=30)
    found = reduce([Block("a", r, csr_array(J), G, np.ones(30))], {"a": 0.5}, 6)
    whole = np.linalg.lstsq(np.hstack([J, G]), r, rcond=None)[0]
    shared = np.linalg.solve(found.A, found.g)
    np.testing.assert_allclose(shared, whole[8:], rtol=1e-6)
    np.testing.assert_allclose(found.states(shared), whole[:8], rtol=1e-6)
