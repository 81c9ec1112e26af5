"""A voyage of any length: on the loop that the service builds the chart goes along, and nobody notices.

Two loops sail the same ship with the same noise. One hears positions in degrees, of a ship that sails on WGS84, and
its chart goes along; the other hears the same places in metres north and east as they were sailed, and has none."""

from collections.abc import Callable, Iterator
from math import cos, degrees, hypot, pi, radians, sin, sqrt
from typing import Any

import numpy as np
import pytest

from tests.live.conftest import Sailing
from tests.thorough import one_of, thorough
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.demonstration import ticks_of
from twin.live.inbox import Inbox
from twin.live.keelson import messages
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.messages import encode_fix, encode_float, wrap
from twin.live.keelson.topics import BY_SUBJECT, address, key
from twin.live.log.log_rows import read_rows
from twin.live.log.record import LogFile
from twin.live.log_replay import replay
from twin.live.outbox import Outbox
from twin.live.prediction.due_predictions import Watch
from twin.live.publish import Publisher
from twin.live.signals.chart import TURN_RAD, Chart
from twin.live.signals.config import Settings
from twin.live.signals.geodesy import E2, A, datum
from twin.live.signals.readings import Reading
from twin.physics.model import Model

FIX = key("twin", "ship", "location_fix", "ship")
Alter = Callable[[list[Reading], Any], list[Reading]]


class OnEarth:
    """Where on WGS84 a ship is that has sailed so far north and east, each way by the true north of its place."""

    def __init__(self, latitude_deg: float, longitude_deg: float):
        self.latitude, self.longitude = radians(latitude_deg), radians(longitude_deg)
        self._sailed = 0.0, 0.0

    def sail(self, north_m: float, east_m: float) -> None:
        """To these metres north and east of the beginning; a few of them since the last call."""
        north, east = north_m - self._sailed[0], east_m - self._sailed[1]
        self._sailed = north_m, east_m
        self.latitude, self.longitude = self._beside(north, east)

    def fix(self, north_m: float = 0.0, east_m: float = 0.0) -> tuple[float, float]:
        """(latitude, longitude) [deg] of a receiver that is so far off."""
        latitude, longitude = self._beside(north_m, east_m)
        return degrees(latitude), (degrees(longitude) + 180.0) % 360.0 - 180.0

    def off_m(self, latitude_deg: float, longitude_deg: float) -> float:
        """How far a position is from the ship."""
        true = self.fix()
        turn = radians((longitude_deg - true[1] + 180.0) % 360.0 - 180.0)
        return hypot(A * radians(latitude_deg - true[0]), A * turn * cos(self.latitude))

    def _beside(self, north: float, east: float) -> tuple[float, float]:
        s = sin(self.latitude)
        w = sqrt(1.0 - E2 * s * s)
        latitude = self.latitude + north / (A * (1.0 - E2) / w**3)
        return latitude, self.longitude + east / (A / w * cos(0.5 * (self.latitude + latitude)))


class InDegrees:
    """Turns a bridge's positions into what a receiver says, and decodes them as the service does."""

    def __init__(self, earth: OnEarth, bridge: Any, north_m: float, east_m: float):
        self.earth, self.decoder = earth, bridge.ears.decoder
        self.decoder.chart = Chart(datum(*earth.fix()), north_m, east_m)
        self._chart, self.moves = self.decoder.chart, 0

    def __call__(self, readings: list[Reading], bridge: Any) -> list[Reading]:
        x, y = bridge.sailing.state[:2]
        self.earth.sail(x, y)
        said = {r.channel: r for r in readings}
        if "north_m" not in said:
            return readings
        r = said["north_m"]
        fix = self.earth.fix(r.value - x, said["east_m"].value - y)
        data = wrap(encode_fix(*fix, round(r.time_s * 1e9)), round(r.time_s * 1e9))
        placed = self.decoder.decode(FIX, data, r.received_s)
        self.moves += self.decoder.chart is not self._chart
        self._chart = self.decoder.chart
        said_s = {"time_s": r.time_s, "source": "ship"}
        return [*(p._replace(**said_s) if isinstance(p, Reading) else p for p in placed), *readings[2:]]


def counted_from(north_m: float, east_m: float) -> Alter:
    """The same places in metres, counted from as far away."""
    start = {"north_m": north_m, "east_m": east_m}
    return lambda readings, bridge: [r._replace(value=r.value + start.get(r.channel, 0.0)) for r in readings]


def pairs(seconds: float, one: Any, other: Any, alters: tuple[Alter, Alter], lost=()) -> Iterator[tuple]:
    """Tick by tick of both loops; `lost` channels are silent."""
    for _ in range(round(seconds / 0.1)):
        made = [
            bridge.run(
                0.1, lambda said, b, alter=alter: [r for r in alter(said, b) if r.channel not in lost]
            )[0]
            for bridge, alter in zip((one, other), alters, strict=True)
        ]
        yield tuple(made)


def weaves(t: float) -> float:
    """The helm [deg] of a ship that swings about its course and comes on."""
    return 4.0 * cos(2.0 * pi * t / 40.0)


VOYAGES = {  # ship, position, heading, what has been sailed before: beyond every older limit
    "east across the antimeridian": ("kvlcc2", (60.0, 179.997), 90.0, (0.0, 499e3)),
    "through north at high latitude": ("kvlcc2", (-82.0, 11.0), 357.0, (-3e6, 2e6)),
    "a small boat": ("usv", (88.5, -179.9999), 270.0, (0.0, 0.0)),
}


@thorough
@pytest.mark.parametrize("name", one_of(VOYAGES))
def test_I20_a_chart_that_goes_along_disturbs_nothing_that_is_said(name, make_service):
    """Test: five minutes with several moves, then half a minute without log and without compass, gyro and course
    carrying the heading. Expected: both loops say the same of motion, health and promise; place and prediction are off
    by no more than TURN_RAD of what was sailed meanwhile; the position on earth is the true one."""
    ship, where, heading, before = VOYAGES[name]
    one, other = (make_service(ship, heading_deg=heading, seed=5, helm_deg=weaves) for _ in range(2))
    earth = OnEarth(*where)
    alters = InDegrees(earth, one, *before), counted_from(*before)
    inside = foretold = 0
    watches, judged = [Watch(b.loop.ship, b.loop.predictor.horizons_s) for b in (one, other)], 0
    apart = {"speed": 0.0, "place": 0.0, "foretold": 0.0}
    silent = ("surge_velocity_mps", "sway_velocity_mps", "heading_true_north_deg")
    for seconds, lost in ((300.0, ()), (30.0, silent)):
        for a, b in pairs(seconds, one, other, alters, lost):
            e, f = a.estimate, b.estimate
            inside += a.certificate.inside
            assert a.certificate.inside == b.certificate.inside and a.mode == b.mode
            assert not [text for text in a.reasons if "against" in text or "stepped" in text]
            apart["speed"] = max(
                apart["speed"],
                abs(e.surge_velocity_mps - f.surge_velocity_mps),
                abs(e.sway_velocity_mps - f.sway_velocity_mps),
            )
            apart["place"] = max(apart["place"], hypot(e.north_m - f.north_m, e.east_m - f.east_m))
            assert abs((e.heading_true_north_deg - f.heading_true_north_deg + 180.0) % 360.0 - 180.0) < 0.02
            for p, q in zip(a.predictions, b.predictions, strict=True):
                foretold += 1
                gap = hypot(p.state.north_m - q.state.north_m, p.state.east_m - q.state.east_m)
                apart["foretold"] = max(apart["foretold"], gap)
            seen = one.loop.last, other.loop.last
            for (h, p), (_, q) in zip(
                *(
                    w.look(s.instant.time_s, s.measured, s.estimate, s.ahead, True)
                    for w, s in zip(watches, seen, strict=True)
                ),
                strict=True,
            ):
                judged += h > 50.0
                assert hypot(p.along - q.along, p.across - q.across) < TURN_RAD * 2e3
            if a.estimate.HasField("north_m") and not lost:
                chart = one.ears.decoder.chart
                assert earth.off_m(*chart.position(e.north_m, e.east_m)) < 2.0
    sailed = hypot(*one.sailing.state[:2])
    assert alters[0].moves >= 4 and foretold > 100 and inside > 2500 and judged > 10
    assert one.loop.sensors.rejected == other.loop.sensors.rejected == 0
    assert apart["place"] < TURN_RAD * sailed and apart["speed"] < 10.0 * TURN_RAD
    assert apart["foretold"] < TURN_RAD * (sailed + 120.0 * one.loop.ship.U_0)
    for horizon_s, sure in one.loop.predictor.sureness.items():
        assert sure.seen == other.loop.predictor.sureness[horizon_s].seen
        assert sure.sigma((0.0,) * 6) == pytest.approx(
            other.loop.predictor.sureness[horizon_s].sigma((0.0,) * 6), rel=0.25
        )


def test_I20_a_ship_that_sailed_far_while_its_computer_slept_is_found_again(make_service):
    """Test: two hours and 300 km without a tick. Expected: the second position is believed, and a minute later the ship
    is said to be where it is; nothing is promised or said about places that is not finite."""
    bridge = make_service(heading_deg=90.0, helm_deg=weaves, seed=5)
    earth = OnEarth(60.0, 179.0)
    alter = InDegrees(earth, bridge, 0.0, 0.0)
    bridge.run(60.0, alter)
    bridge.now_s += 7200.0
    bridge.sailing.state = (0.0, bridge.sailing.state[1] + 300e3, *bridge.sailing.state[2:])
    ticks = bridge.run(60.0, lambda said, b: alter(said, b))
    chart, e = bridge.ears.decoder.chart, ticks[-1].estimate
    assert earth.off_m(*chart.position(e.north_m, e.east_m)) < 2.0
    assert bridge.loop.sensors.rejected == 2 and ticks[-1].mode == bridge.ticks[550].mode


@pytest.fixture(scope="module")
def live_log(kvlcc2, certificate_file, tmp_path_factory):
    """Three minutes at 85 deg north across the antimeridian, recorded live by the service's loop as the bus brought
    them; with its settings, and how far from the ship each place was that it said."""
    path, bus, earth = tmp_path_factory.mktemp("live") / "live.mcap", MemoryBus(), OnEarth(85.0, 179.98)
    charts, now_s, off_m = [], 500.0, list[float]()
    sailing = Sailing(kvlcc2, Model.of(kvlcc2), weaves, heading_deg=90.0)
    chosen = Settings({"observer.certificate": str(certificate_file)})
    with LogFile(path) as log:
        inbox = Inbox(bus, log.add)
        loop = loop_of(chosen, inbox, Outbox(Publisher(), "twin", "ship", bus, log.add), None)
        for k in range(1800):
            said = {r.channel: r for r in sailing.readings(now_s)}
            x, y = sailing.state[:2]
            earth.sail(x, y)
            ns = round((1.7e9 + now_s) * 1e9)
            fix = earth.fix(said["north_m"].value - x, said["east_m"].value - y)
            bus.put(FIX, wrap(encode_fix(*fix, ns), ns))
            for name, r in said.items():
                if name in BY_SUBJECT:
                    bus.put(key("twin", "ship", name, "ship"), wrap(encode_float(r.value, ns), ns))
            loop.tick(Instant(k, now_s, 1.7e9 + now_s))
            if inbox.decoder.chart not in charts:
                charts.append(inbox.decoder.chart)
            off_m += [
                earth.off_m(fix.latitude, fix.longitude)
                for at, data in bus.sent
                if address(at).subject == "location_fix"
                for fix in [messages.LocationFix.FromString(messages.unwrap(data)[1])]
            ]
            bus.sent.clear()
            sailing.advance()
            now_s += 0.1
    assert len(charts) > 10
    return path, chosen, kvlcc2.U_0, off_m


@thorough
def test_I20_a_voyage_on_which_the_chart_went_along_replays_to_the_same_states_and_bytes(live_log, tmp_path):
    path, chosen, _, _ = live_log
    again = [tmp_path / f"{k}.mcap" for k in range(3)]
    for log, made in ((path, again[0]), (path, again[1]), (again[0], again[2])):
        replay(log, chosen, made)
    assert again[0].read_bytes() == again[1].read_bytes() == again[2].read_bytes()
    for one, other in zip(ticks_of(path), ticks_of(again[0]), strict=True):
        assert one.measured == other.measured and one.estimate == other.estimate
        assert one.certificate == other.certificate and list(one.predictions) == list(other.predictions)


def test_I20_a_log_of_a_voyage_on_which_the_chart_went_along_is_read_ashore_without_a_jump(live_log):
    """Expected: from sample to sample no more than the ship sails in 0.1 s and the noise of two fixes."""
    path, _, U_0, _ = live_log
    _, columns = read_rows(path)
    steps = np.hypot(np.diff(columns["north_m"]), np.diff(columns["east_m"]))
    steps = steps[np.isfinite(steps)]
    assert steps.size > 1700
    assert steps.max() < 0.1 * U_0 + 6.0 * 0.3 * sqrt(2.0)


def test_I20_what_is_said_of_the_place_on_earth_is_where_the_ship_is(live_log):
    """Expected: once a second, within what the receiver's noise leaves."""
    _, _, _, off_m = live_log
    assert len(off_m) > 170
    assert max(off_m[10:]) < 1.0
