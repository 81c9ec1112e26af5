"""Zenoh as the twin uses it: locked down, never waiting, honest about outages (Q5, N1, N2, N6, I27, I28)."""

import json
import os
import socket
import subprocess
from collections.abc import Iterator
from time import monotonic, sleep, time_ns
from types import SimpleNamespace
from typing import Any

import pytest
import zenoh

from twin.errors import SettingsError
from twin.live.keelson import messages, topics
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.zenoh_bus import ZenohBus
from twin.live.keelson.zenoh_config import BusSettings

HEADING = topics.key("twin", "ship", "heading_true_north_deg", "gyro")
RUDDER = topics.key("twin", "ship", "rudder_angle_deg", "steering")


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def sample(value: float) -> bytes:
    now = time_ns()
    return messages.wrap(messages.encode_float(value, now), now)


def until(true, seconds: float = 5.0) -> float:
    began = monotonic()
    while not true():
        assert monotonic() - began < seconds, "it did not happen in time"
        sleep(0.005)
    return monotonic() - began


Pair = tuple[ZenohBus, ZenohBus]


@pytest.fixture
def pair() -> Iterator[Pair]:
    """The twin's bus, and a sensor's connected to it."""
    port = free_port()
    with (
        ZenohBus(BusSettings(listen=f"tcp/127.0.0.1:{port}")) as twin,
        ZenohBus(BusSettings(listen="", connect=(f"tcp/127.0.0.1:{port}",))) as sensor,
    ):
        until(lambda: twin.state.connected and sensor.state.connected)
        sleep(0.2)  # declarations travel
        yield twin, sensor


def router(port: int) -> Any:
    config = zenoh.Config()
    for key, value in (
        ("mode", "router"),
        ("listen/endpoints", [f"tcp/127.0.0.1:{port}"]),
        ("scouting/multicast/enabled", False),
    ):
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


def received(bus: ZenohBus) -> list[float]:
    return [messages.Float.FromString(messages.unwrap(data)[1]).value for _, data, _ in bus.drain(1.0)]


def test_what_a_sensor_publishes_arrives_with_its_key_and_the_ticks_time(pair: Pair) -> None:
    twin, sensor = pair
    data = sample(12.5)
    sensor.publish(HEADING, data)
    got: list[Any] = []
    until(lambda: got.extend(twin.drain(7.0)) or got)
    assert got == [(HEADING, data, 7.0)]


def test_what_the_twin_publishes_reaches_others_and_not_itself(pair: Pair) -> None:
    twin, sensor = pair
    twin.publish(HEADING, sample(3.0))
    until(lambda: 3.0 in received(sensor))
    assert twin.drain(1.0) == []


def test_a_source_with_parts_in_its_name_is_heard(pair: Pair) -> None:
    twin, sensor = pair
    sensor.publish(HEADING + "/0", sample(3.0))
    until(lambda: 3.0 in received(twin))


def test_I28_a_flood_on_one_subject_hands_out_the_newest_and_leaves_the_others(pair: Pair) -> None:
    """Test: 20 000 headings at once. Expected: at most a ring of them, and the rudder too."""
    twin, sensor = pair
    sensor.publish(RUDDER, sample(-5.0))
    for i in range(20_000):
        sensor.publish(HEADING, sample(i * 0.01))
    sleep(0.3)
    began = monotonic()
    got = twin.drain(1.0)
    assert monotonic() - began < 0.05
    assert 1 <= sum(key == HEADING for key, _, _ in got) <= 16
    assert sum(key == RUDDER for key, _, _ in got) == 1


def test_two_instruments_that_speak_at_the_same_moment_are_both_heard(pair: Pair) -> None:
    twin, sensor = pair
    keys = {topics.key("twin", "ship", "propeller_rate_rpm", name) for name in ("port", "starboard")}
    for key in sorted(keys):
        sensor.publish(key, sample(60.0))
    heard: set[str] = set()
    until(lambda: heard.update(key for key, _, _ in twin.drain(1.0)) or heard == keys)


def test_I27_a_sample_of_ten_megabytes_never_reaches_the_loop(pair: Pair) -> None:
    twin, sensor = pair
    sensor.publish(HEADING, bytes(10_000_000))
    sensor.publish(RUDDER, bytes(10_000))
    sleep(0.5)
    assert twin.drain(1.0) == []
    until(lambda: sensor.publish(RUDDER, sample(1.0)) or 1.0 in received(twin), 10.0)


def test_neither_drain_nor_publish_waits(pair: Pair) -> None:
    twin, _ = pair
    slowest = 0.0
    for _ in range(500):
        began = monotonic()
        twin.drain(1.0)
        twin.publish(HEADING, bytes(900))
        slowest = max(slowest, monotonic() - began)
    assert slowest < 0.1


def test_N1_a_twin_whose_router_is_dead_starts_says_so_and_connects_later() -> None:
    port = free_port()
    began = monotonic()
    with ZenohBus(BusSettings(router=f"tcp/127.0.0.1:{port}")) as twin:
        assert monotonic() - began < 2.0
        assert not twin.state.connected
        assert str(port) in twin.state.alarm and "is the router running?" in twin.state.alarm
        twin.publish(HEADING, sample(1.0))
        assert twin.drain(1.0) == [] and twin.state.refused == 1
        session = router(port)
        try:
            until(lambda: twin.state.connected, 3.0)
            assert twin.state.alarm == ""
        finally:
            session.close()


def test_N2_a_router_that_dies_is_noticed_and_its_return_as_well() -> None:
    port = free_port()
    session = router(port)
    with ZenohBus(BusSettings(router=f"tcp/127.0.0.1:{port}")) as twin:
        until(lambda: twin.state.connected)
        session.close()
        assert until(lambda: not twin.state.connected) < 1.0
        assert "the router out of reach for " in twin.state.alarm and twin.state.outages == 1
        twin.publish(HEADING, sample(1.0))
        session = router(port)
        try:
            assert until(lambda: twin.state.connected) < 1.5
            assert twin.state.alarm == ""
        finally:
            session.close()


def test_two_twins_behind_a_router_hear_each_other() -> None:
    """N8's cure: with a router both are clients."""
    port = free_port()
    session = router(port)
    settings = BusSettings(router=f"tcp/127.0.0.1:{port}")
    try:
        with ZenohBus(settings) as a, ZenohBus(settings) as b:
            until(lambda: a.publish(HEADING, sample(4.0)) or 4.0 in received(b))
    finally:
        session.close()


def test_N6_a_port_in_use_is_named_and_taken_once_it_is_free() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with ZenohBus(BusSettings(listen=f"tcp/127.0.0.1:{port}")) as twin:
            alarm = twin.state.alarm
            assert (
                str(port) in alarm and "in use" in alarm and "choose another" in alarm and "\n" not in alarm
            )
            twin.publish(HEADING, sample(1.0))
            assert twin.drain(1.0) == [] and twin.state.refused == 1
            taken.close()
            until(lambda: twin.state.alarm == "")
            with ZenohBus(BusSettings(listen="", connect=(f"tcp/127.0.0.1:{port}",))) as sensor:
                until(lambda: sensor.publish(HEADING, sample(2.0)) or 2.0 in received(twin))


@pytest.mark.skipif(os.geteuid() != 0, reason="to give the computer an address needs root")
def test_N6_an_address_that_is_not_up_yet_is_waited_for() -> None:
    """Test: listen on an address that no network card has, and give it to the loopback later. Expected: it
    opens."""
    address = (
        "127.200.0.1" if subprocess.run(["ip", "addr"], capture_output=True).returncode else "10.213.47.1"
    )
    add, remove = (["ip", "addr", word, f"{address}/32", "dev", "lo"] for word in ("add", "del"))
    port = free_port()
    with ZenohBus(BusSettings(listen=f"tcp/{address}:{port}")) as twin:
        if twin.state.alarm == "":
            pytest.skip(f"{address} is up already")
        assert "No network card has that address" in twin.state.alarm
        if subprocess.run(add, capture_output=True).returncode:
            pytest.skip("this machine lets nobody change its addresses")
        try:
            until(lambda: twin.state.alarm == "")
        finally:
            subprocess.run(remove, check=True)


def test_what_zenoh_can_never_open_is_an_error_at_once() -> None:
    with pytest.raises(SettingsError, match="Missing TLS private key"):
        ZenohBus(BusSettings(listen=f"tls/127.0.0.1:{free_port()}")).__enter__()


def test_a_session_that_dies_while_it_is_set_up_is_closed_and_opened_again(monkeypatch) -> None:
    """Test: what is declared in a session fails twice. Expected: no exception, each session closed, the third
    one kept."""
    closed, sessions = [], [SimpleNamespace(close=lambda: closed.append(1)) for _ in range(3)]

    def dies(session, *_):
        if session is not sessions[-1]:
            raise zenoh.ZError("session closed")
        return SimpleNamespace(close=lambda: None)

    monkeypatch.setattr(zenoh, "open", lambda config: sessions[len(closed)])
    monkeypatch.setattr("twin.live.keelson.zenoh_bus.Link", dies)
    monkeypatch.setattr("twin.live.keelson.zenoh_bus.RETRY_S", 0.05)
    with ZenohBus(BusSettings(listen=f"tcp/127.0.0.1:{free_port()}")) as twin:
        until(lambda: twin._link is not None)
    assert closed == [1, 1]


def test_N5_another_twin_of_the_same_name_is_said(pair: Pair) -> None:
    """Test: a second session speaks under the twin's own key. Expected: an alarm within 2 s, which ends after
    it falls silent."""
    twin, other = pair
    own = topics.key("twin", "ship", "twin_tick", "twin")
    assert twin.state.alarm == ""
    twin.publish(own, b"mine")
    sleep(0.2)
    assert twin.state.alarm == ""
    other.publish(own, b"not mine")
    until(lambda: "another twin speaks as twin/@v0/ship" in twin.state.alarm, 2.0)
    until(lambda: twin.state.alarm == "")


def test_an_outage_of_the_only_sensor_process_is_said(pair: Pair) -> None:
    twin, sensor = pair
    sensor.__exit__()
    until(lambda: not twin.state.connected)
    assert "everybody out of reach" in twin.state.alarm


def alive(session: Any) -> bool:
    return any(reply.ok for reply in session.liveliness().get("twin/@v0/**", timeout=1.0))


def test_the_sign_of_life_is_there_while_the_bus_is_open() -> None:
    port = free_port()
    session = router(port)
    try:
        with ZenohBus(BusSettings(router=f"tcp/127.0.0.1:{port}")) as twin:
            until(lambda: twin.state.connected)
            until(lambda: alive(session))
        until(lambda: not alive(session))
    finally:
        session.close()


def test_the_bus_of_a_replay_has_the_same_face() -> None:
    with MemoryBus() as bus:
        bus.put(HEADING, b"a")
        assert bus.drain(3.0) == [(HEADING, b"a", 3.0)] and bus.drain(4.0) == []
        bus.publish(RUDDER, b"b")
        assert bus.sent == [(RUDDER, b"b")] and bus.state.connected
