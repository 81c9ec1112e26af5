"""A ship of actuators on board: what its channels say drives the physics, what is lost is held and named, and a
voyage replays."""

import json
import subprocess
import sys
from math import cos, degrees, hypot, radians, sin

import numpy as np
import pytest

from tests.live.actuators import PODS, SIDES, WALL, Afloat, Service, craft, shown
from tests.thorough import thorough
from twin.live.keelson import messages
from twin.live.keelson.messages import encode_float
from twin.live.log.mcap_read import McapReader
from twin.live.log.record import LogFile, read_rows
from twin.live.log_replay import replay
from twin.live.signals.config import Settings
from twin.live.signals.readings import Quality
from twin.physics.model import Model
from twin.physics.ship import load, save
from twin.physics.state import Situation
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage


@pytest.fixture
def make(tmp_path):
    def made(*tables, true=None, settings=None, by_bus=False, log=None, effects=None) -> Service:
        save(craft(*tables, **(effects or {})), tmp_path / "ship.toml")
        afloat = Afloat(load(tmp_path / "ship.toml"), true)
        return Service(tmp_path / "ship.toml", afloat, settings, by_bus, log)

    return made


@pytest.mark.parametrize("tables", [PODS, SIDES], ids=["azimuths", "two sides"])
def test_the_loop_follows_a_ship_of_actuators_and_foretells_it_with_them_held(make, tables):
    """Test: a minute by bus. Expected: the estimate on the true place, and a prediction that is where the
    ship's own equations take it with the actuators as they were when the round began."""
    service = make(*tables, by_bus=True)
    service.run(45.0)
    while not service.run(0.1).predictions:
        pass
    service.run(0.1)  # the next round begins in this tick
    began, told = service.truth, dict(service.loop.last.situation.orders)
    started_s = service.ticks[-1].time_s
    while not (ahead := list(service.run(0.1).predictions)):
        pass
    state, model = began, Model.of(service.afloat.ship)
    span = ahead[0].horizon_s + service.ticks[-1].time_s - started_s
    for _ in range(round(span / 0.1)):
        state = model.step(state, Situation(orders=told), 0.1)
    off = hypot(ahead[0].state.surge_velocity_mps - state[3], ahead[0].state.sway_velocity_mps - state[4])
    assert off < 0.03 * service.loop.ship.U_0
    assert abs(degrees(state[5]) - ahead[0].state.yaw_rate_degps) < 1.0
    e, x = service.ticks[-1].estimate, service.truth
    assert abs(e.surge_velocity_mps - x[3]) < 0.03 and abs(e.yaw_rate_degps - degrees(x[5])) < 0.5
    assert service.ticks[-1].mode == "physics only"


def test_every_channel_stands_in_the_tick_by_its_name_with_value_and_age(make):
    service = make(*PODS, by_bus=True)
    tick = service.run(5.0)
    assert [a.name for a in tick.actuators] == [f"{p['name']}.{c}" for p in PODS for c in p["channels"]]
    said = service.afloat.says()
    for name, a in shown(tick).items():
        assert (
            a.quality == Quality.OK
            and 0.0 <= a.age_s < 0.05
            and a.value == pytest.approx(said[name], abs=2.0)
        )
    assert {f.name for f in tick.known} >= {"fore", "port", "starboard"}
    assert messages.Tick.FromString(tick.SerializeToString()) == tick


def test_keelsons_own_subjects_are_heard_of_an_actuator_that_begins_the_source(make):
    """Test: propeller_rate_rpm/port/shaft beside one that names no actuator. Expected: the first is that
    actuator's, the second is not."""
    service = make(*PODS, by_bus=True)
    ns = round((WALL + service.now_s) * 1e9)
    service.put("propeller_rate_rpm", "port/shaft", encode_float(321.0, ns), ns)
    service.put("actuator_rate_rpm", "stern/drive", encode_float(999.0, ns), ns)
    tick = service.run(0.1, lambda said: {c: x for c, x in said.items() if c != "port.rate_rpm"})
    assert shown(tick)["port.rate_rpm"].value == 321.0
    assert tick.rejected >= 1 and "stern" not in str(tick)


def test_names_that_nobody_has_fill_neither_log_nor_memory(make):
    logged = set()
    service = make(*PODS, by_bus=True, log=lambda topic, *_: logged.add(topic))
    for k in range(300):
        ns = round((WALL + service.now_s) * 1e9)
        service.put("actuator_rate_rpm", f"invented_{k}", encode_float(1.0, ns), ns)
        service.put("actuator_rate_rpm", f"port/invented_{k}", encode_float(1.0, ns), ns)
    service.run(0.1)
    ours = {t for t in logged if "actuator_rate_rpm" in t}
    assert not any("/invented" in t and "port/" not in t for t in ours) and len(ours) < 20


def test_I23_a_lost_feedback_of_one_actuator_is_held_and_named_and_never_zero(make):
    """Test: one azimuth's turns fall silent for 30 s. Expected: its last value in every tick, never none; the
    mode steps down; its name in the reasons, in what the bus says; all well when it is heard again."""
    service = make(*PODS, by_bus=True)
    service.run(20.0)
    before = service.loop.last.situation.orders["port.rate"]
    said = set()
    for _ in range(300):
        tick = service.run(0.1, lambda said: {c: x for c, x in said.items() if c != "port.rate_rpm"})
        assert service.loop.last.situation.orders["port.rate"] == pytest.approx(before, rel=1e-6)
        said.add(tick.mode)
    assert said == {"physics only", "dead reckoning"} and tick.mode == "dead reckoning"
    told = next(text for text in tick.reasons if "is held" in text)
    assert told.startswith("port.rate_rpm is lost") and f"{60.0 * before:.4g}" in told
    assert shown(tick)["port.rate_rpm"].quality == Quality.STALE
    assert shown(tick)["starboard.rate_rpm"].quality == Quality.OK
    status = [
        messages.String.FromString(messages.unwrap(data)[1]).value
        for key, data in service.bus.sent
        if "twin_status" in key
    ][-1]
    assert "port.rate_rpm is lost" in status
    assert service.run(1.0).mode == "physics only"


def test_an_actuator_of_which_nothing_was_ever_heard_stands_still(make):
    service = make(*SIDES)
    tick = service.run(5.0, lambda said: {c: x for c, x in said.items() if c != "port.pwm_us"})
    assert service.loop.last.situation.orders["port.pwm"] == 1500.0
    assert not any("is held" in text for text in tick.reasons) and "no port.pwm_us" in tick.reasons[0]


@pytest.mark.parametrize("channel, wild", [("port.angle_deg", 170.0), ("port.rate_rpm", 15000.0)])
def test_a_spike_of_a_feedback_is_refused(make, channel, wild):
    service = make(*PODS)
    service.run(3.0)
    tick = service.run(0.1, lambda said: said | {channel: wild})
    assert abs(shown(tick)[channel].value - wild) > 100.0 and shown(tick)[channel].quality != Quality.OK
    assert shown(service.run(0.5))[channel].quality == Quality.OK


def test_an_order_may_jump(make):
    service = make(*SIDES)
    service.run(3.0)
    assert shown(service.run(0.1, lambda said: said | {"port.pwm_us": 1100.0}))["port.pwm_us"].value == 1100.0


def test_an_azimuth_that_goes_through_astern_does_not_jump(make):
    service = make(*PODS)
    service.run(3.0, lambda said: said | {"port.angle_deg": 179.0})
    tick = service.run(0.1, lambda said: said | {"port.angle_deg": -179.0})
    assert shown(tick)["port.angle_deg"].value == -179.0


def test_a_slow_azimuth_that_passes_ahead_is_not_thought_to_swing_round_astern(make):
    """Test: an azimuth that turns with a time constant of half a second is shown at 358 and then at 2 deg.
    Expected: the physics turns it by 4 deg through ahead."""
    service = make(*PODS, effects={"ActuatorLag.port": {"delay": 0.0, "ease": 0.5}})
    service.run(6.0, lambda said: said | {"port.angle_deg": 358.0})
    seen = []
    for _ in range(10):
        service.run(0.1, lambda said: said | {"port.angle_deg": 2.0})
        seen.append(service.loop.last.situation.orders["port.angle"])
    assert min(cos(angle) for angle in seen) > cos(radians(2.5))
    assert sin(seen[0]) < 0.0 < sin(seen[-1])


@pytest.mark.parametrize("late", ("port", "port+fore"))
def test_an_actuator_that_answers_late_is_where_its_order_was(make, late):
    """Test: turns of both pods are ordered up at once. Expected: with a dead time of 0.3 s in the ship file, of one
    of them or of the two alike, the physics sees those 0.3 s later."""
    service = make(*PODS, effects={f"ActuatorLag.{late}": {"delay": 0.3, "ease": 0.0}})
    service.run(3.0, lambda said: said | {"port.rate_rpm": 600.0, "fore.rate_rpm": 600.0})
    seen = {"port": [], "fore": []}
    for _ in range(6):
        service.run(0.1, lambda said: said | {"port.rate_rpm": 900.0, "fore.rate_rpm": 900.0})
        for name, turns in seen.items():
            turns.append(round(60.0 * service.loop.last.situation.orders[f"{name}.rate"]))
    behind = [600] * 3 + [900] * 3
    assert seen == {"port": behind, "fore": behind if "fore" in late else [900] * 6}


@thorough
def test_the_loss_of_one_thruster_is_learned_on_board(make):
    """Test: the file has ThrusterWear.port at none, the ship has lost 40 % there. Expected: the number that
    is published goes most of the way, and that of the other side stays near none."""
    effects = {f"ThrusterWear.{name}": {"loss": 0.0} for name in ("port", "starboard")}
    worn = craft(*SIDES, **{"ThrusterWear.port": {"loss": 0.4}})
    service = make(*SIDES, true=worn, effects=effects)
    service.run(150.0)
    numbers = {p.name: p.value for tick in service.ticks[-20:] for p in tick.parameters}
    assert numbers["ThrusterWear.port.loss"] == pytest.approx(0.3, abs=0.12)
    assert abs(numbers["ThrusterWear.starboard.loss"]) < 0.12


def test_the_certificate_is_refused_in_one_sentence(make):
    service = make(*SIDES)
    tick = service.run(1.0)
    assert "certificate: none, as its proof covers one propeller with one rudder only" in service.loop.notes
    assert not tick.certificate.inside and any("certificate: none" in text for text in tick.reasons)


@pytest.fixture
def voyage(tmp_path):
    """A minute of the craft with two sides, as an imported voyage."""
    save(craft(*SIDES), tmp_path / "ship.toml")
    afloat, rows = Afloat(load(tmp_path / "ship.toml")), []
    for _ in range(600):
        rows.append(afloat.says())
        afloat.advance()
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    write_voyage(Voyage("a minute", 0.1 * np.arange(600), columns), tmp_path / "voyage.mcap")
    return tmp_path


def ticks(path):
    return [
        messages.Tick.FromString(m.data)
        for m in McapReader(path).messages()
        if m.type_name == "shiptwin.Tick"
    ]


def test_an_imported_voyage_replays_twice_to_the_same_bytes_with_every_channel(voyage):
    settings = Settings({"ship.file": str(voyage / "ship.toml")})
    for name in ("one", "two"):
        summary = replay(voyage / "voyage.mcap", settings, voyage / f"{name}.mcap")
    assert (voyage / "one.mcap").read_bytes() == (voyage / "two.mcap").read_bytes()
    assert summary.modes == {"physics only": 600} and summary.foresight[0].position_m < 0.3
    _, columns = read_rows(voyage / "one.mcap")
    _, before = read_rows(voyage / "voyage.mcap")
    for name in ("port.pwm_us", "starboard.pwm_us"):
        assert np.allclose(columns[name], before[name])
    assert shown(ticks(voyage / "one.mcap")[-1])["port.pwm_us"].value == before["port.pwm_us"][-1]


def test_a_voyage_recorded_live_replays_to_the_same_states_and_reads_as_columns(make, tmp_path):
    with LogFile(tmp_path / "live.mcap") as log:
        service = make(*PODS, by_bus=True, log=log.add)
        service.run(20.0)
    replay(
        tmp_path / "live.mcap", Settings({"ship.file": str(tmp_path / "ship.toml")}), tmp_path / "again.mcap"
    )
    live, again = ticks(tmp_path / "live.mcap"), ticks(tmp_path / "again.mcap")
    assert len(live) == len(again) == 200
    for one, other in zip(live, again, strict=True):
        assert one.estimate == other.estimate and list(one.actuators) == list(other.actuators)
    _, columns = read_rows(tmp_path / "live.mcap")
    assert columns["port.rate_rpm"][-1] == pytest.approx(live[-1].actuators[2].value)


def twin(place, *words):
    return subprocess.run(
        [sys.executable, "-m", "twin", *words, "--ship", "ship.toml"],
        cwd=place,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )


def test_twin_replay_and_twin_run_take_the_ship_file(voyage):
    done = twin(voyage, "replay", "voyage.mcap", "-o", "said.mcap")
    assert done.returncode == 0, done.stderr
    assert "physics only 100 %" in done.stdout and (voyage / "said.mcap").exists()
    (voyage / "twin.toml").write_text('[bus]\nlisten = "tcp/127.0.0.1:0"\n[log]\nfolder = "logs"\n')
    done = twin(voyage, "run", "--config", "twin.toml", "--duration", "1")
    assert done.returncode == 0, done.stderr
    assert "certificate: none, as its proof covers" in done.stderr


def test_a_network_that_is_asked_for_is_refused_in_one_line(voyage):
    (voyage / "twin.toml").write_text('[residual]\nfile = "net.onnx"\n')
    done = twin(voyage, "replay", "voyage.mcap", "-o", "said.mcap", "--config", "twin.toml")
    assert done.returncode == 5 and len(done.stderr.strip().splitlines()) == 1
    assert "[[actuators]]" in done.stderr and not (voyage / "said.mcap").exists()


def test_nothing_heavy_is_loaded_for_a_ship_of_actuators(voyage):
    program = (
        "import json, sys\nfrom twin.live.build import loop_of\nfrom twin.live.inbox import Inbox\n"
        "from twin.live.keelson.bus import MemoryBus\nfrom twin.live.outbox import Outbox\n"
        "from twin.live.publish import Publisher\nfrom twin.live.clock import Instant\n"
        "from twin.live.signals.config import Settings\nbus = MemoryBus()\n"
        "loop = loop_of(Settings({'ship.file': 'ship.toml'}), Inbox(bus), Outbox(Publisher(), 'a', 'b', bus))\n"
        "loop.tick(Instant(0, 1.0, 1.7e9))\n"
        "print(json.dumps([m for m in ('numpy', 'scipy', 'torch', 'pandas') if m in sys.modules]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=voyage, capture_output=True, text=True, timeout=60.0, check=False
    )
    assert json.loads(done.stdout) == [], done.stderr
