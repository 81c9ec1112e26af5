"""What hangs or talks nonsense on the network: a router that is stopped (N3), a subscriber that is (N4), a
line that swallows everything (N7), garbage and idle connections on the port (Q4)."""

import os
import signal
import socket
import subprocess
import sys
import threading
from contextlib import contextmanager
from time import monotonic, sleep, time_ns

import pytest

from twin.live.keelson import messages, topics
from twin.live.keelson.zenoh_bus import ZenohBus
from twin.live.keelson.zenoh_config import BusSettings

HEADING = topics.key("twin", "ship", "heading_true_north_deg", "gyro")
ROUTER = """
import json, sys, zenoh
config = zenoh.Config()
lease = "transport/link/tx/lease"  # [ms] that it asks others to wait for it
for key, value in (
    ("mode", "router"), ("listen/endpoints", [sys.argv[1]]), ("scouting/multicast/enabled", False), (lease, 2000)
):
    config.insert_json5(key, json.dumps(value))
session = zenoh.open(config)
print("open", flush=True)
sys.stdin.read()
"""
SUBSCRIBER = """
import json, sys, zenoh
config = zenoh.Config()
for key, value in (("connect/endpoints", [sys.argv[1]]), ("listen/endpoints", []), ("scouting/multicast/enabled", False)):
    config.insert_json5(key, json.dumps(value))
session = zenoh.open(config)
ears = session.declare_subscriber("**", zenoh.handlers.RingChannel(4))
print("open", flush=True)
sys.stdin.read()
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def sample(value):
    now = time_ns()
    return messages.wrap(messages.encode_float(value, now), now)


def until(true, seconds=5.0):
    began = monotonic()
    while not true():
        assert monotonic() - began < seconds, "it did not happen in time"
        sleep(0.01)
    return monotonic() - began


def received(bus):
    return [messages.Float.FromString(messages.unwrap(data)[1]).value for _, data, _ in bus.drain(1.0)]


@contextmanager
def process(script, place):
    made = subprocess.Popen(
        [sys.executable, "-c", script, place], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    try:
        assert made.stdout.readline() == b"open\n"
        yield made
    finally:
        made.kill()
        made.wait()


def slowest_of(bus, seconds):
    """The longest that a drain and a publish took together."""
    end, slowest = monotonic() + seconds, 0.0
    while monotonic() < end:
        began = monotonic()
        bus.drain(1.0)
        bus.publish(HEADING, sample(1.0))
        slowest = max(slowest, monotonic() - began)
        sleep(0.02)
    return slowest


def test_N3_a_router_that_hangs_is_noticed_within_its_lease_and_the_loop_never_waits():
    """Test: SIGSTOP to a router whose lease is 2 s. Expected: said within 3 s and a bit, no call waits, connected again after
    SIGCONT."""
    place = f"tcp/127.0.0.1:{free_port()}"
    with process(ROUTER, place) as router, ZenohBus(BusSettings(router=place)) as twin:
        until(lambda: twin.state.connected)
        router.send_signal(signal.SIGSTOP)
        try:
            began = monotonic()
            slowest = 0.0
            while twin.state.connected:
                assert monotonic() - began < 5.0
                slowest = max(slowest, slowest_of(twin, 0.1))
            assert "the router out of reach" in twin.state.alarm and slowest < 0.2
        finally:
            router.send_signal(signal.SIGCONT)
        until(lambda: twin.state.connected, 10.0)


def test_N4_a_subscriber_that_hangs_takes_nothing_from_the_others():
    """Test: one subscriber stopped, 4 MB published. Expected: another hears to the end, no call waits."""
    place = f"tcp/127.0.0.1:{free_port()}"
    with (
        ZenohBus(BusSettings(listen=place)) as twin,
        process(SUBSCRIBER, place) as hung,
        ZenohBus(BusSettings(listen="", connect=(place,))) as other,
    ):
        until(lambda: twin.state.peers == 2 and other.state.connected)
        sleep(0.3)
        hung.send_signal(signal.SIGSTOP)
        slowest = 0.0
        for _ in range(1000):
            began = monotonic()
            twin.publish(HEADING, bytes(4000))
            slowest = max(slowest, monotonic() - began)
        assert slowest < 0.2
        until(lambda: twin.publish(HEADING, b"last") or b"last" in [data for _, data, _ in other.drain(1.0)])


class Line:
    """A TCP line between two places that can swallow everything while it stays open."""

    def __init__(self, to_port):
        self.to_port, self.dead = to_port, False
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                near, _ = self.server.accept()
                far = socket.create_connection(("127.0.0.1", self.to_port))
            except OSError:
                return
            for a, b in ((near, far), (far, near)):
                threading.Thread(target=self._carry, args=(a, b), daemon=True).start()

    def _carry(self, a, b):
        try:
            while data := a.recv(65536):
                if not self.dead:
                    b.sendall(data)
        except OSError:
            pass
        for end in (a, b):
            end.close()


def test_N7_a_line_that_stays_open_and_carries_nothing_is_noticed_and_left():
    """Test: the line to the router swallows everything. Expected: said within 10 s; heard again when it
    carries."""
    port = free_port()
    place = f"tcp/127.0.0.1:{port}"
    with process(ROUTER, place), ZenohBus(BusSettings(router=place)) as sensor:
        line = Line(port)
        with ZenohBus(BusSettings(router=f"tcp/127.0.0.1:{line.port}")) as twin:
            until(lambda: sensor.publish(HEADING, sample(5.0)) or 5.0 in received(twin))
            line.dead = True
            assert until(lambda: not twin.state.connected, 10.0) < 10.0
            assert "out of reach" in twin.state.alarm
            line.dead = False
            until(lambda: sensor.publish(HEADING, sample(6.0)) or 6.0 in received(twin), 15.0)
        line.server.close()


@pytest.mark.parametrize("greeting", [b"", b"GET / HTTP/1.1\r\n\r\n", os.urandom(4096), bytes(70_000)])
def test_Q4_garbage_and_idle_connections_keep_no_sensor_out(greeting):
    """Test: 20 connections that say nonsense or nothing. Expected: a sensor is heard within the accept
    timeout and a bit."""
    port = free_port()
    with ZenohBus(BusSettings(listen=f"tcp/127.0.0.1:{port}")) as twin:
        strangers = [socket.create_connection(("127.0.0.1", port)) for _ in range(20)]
        try:
            for stranger in strangers:
                try:
                    stranger.sendall(greeting)
                except OSError:
                    continue  # it was shown the door
            with ZenohBus(BusSettings(listen="", connect=(f"tcp/127.0.0.1:{port}",))) as sensor:
                until(lambda: sensor.publish(HEADING, sample(5.0)) or 5.0 in received(twin), 8.0)
            assert twin.state.peers <= 1
        finally:
            for stranger in strangers:
                stranger.close()
