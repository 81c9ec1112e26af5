"""What goes out: wide record and subjects, in border units, finite or not at all."""

from math import inf, nan

import pytest

from twin.live.keelson import messages
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.topics import OUTPUTS, address
from twin.live.outbox import Outbox
from twin.live.publish import Publisher, border_sigma, border_state
from twin.live.signals.chart import Chart
from twin.live.signals.geodesy import datum


def test_numbers_that_are_none_are_withheld_and_counted():
    publisher = Publisher()
    assert publisher._finite({"a": 1.0, "b": nan, "c": -inf, "d": 3}) == {"a": 1.0, "d": 3}
    assert publisher._finite({"a": 1e308, "b": 1e308}) == {"a": 1e308, "b": 1e308}
    assert publisher.withheld == 2


def test_the_state_goes_out_in_border_units():
    out = border_state(1.0, 2.0, -0.1, 3.0, 4.0, 0.01)
    assert out["heading_true_north_deg"] == pytest.approx(354.27, abs=0.01)
    assert out["yaw_rate_degps"] == pytest.approx(0.573, abs=1e-3)
    assert border_sigma((0, 0, 8.0, 0, 0, 0))["heading_true_north_deg"] == pytest.approx(458.4, abs=0.1)


def spoken(make_bridge, seconds, at=None):
    bridge = make_bridge()
    bus = MemoryBus()
    bridge.loop.voice = Outbox(bridge.loop.publisher, "base", "alma", bus)
    bridge.ears.decoder.chart = at
    bridge.run(seconds)
    return bridge, [(address(key), messages.unwrap(data)[1]) for key, data in bus.sent]


def test_every_subject_is_said_as_often_as_the_table_says(make_bridge):
    _, sent = spoken(make_bridge, 5.0, Chart(datum(57.6, 11.6)))
    count = {
        (o.subject, o.source): sum(a.subject == o.subject and a.source == o.source for a, _ in sent)
        for o in OUTPUTS
    }
    for output in OUTPUTS:
        wanted = 5.0 / output.every_s if output.every_s else 50
        assert count[(output.subject, output.source)] == pytest.approx(wanted, abs=1), output


def test_known_and_learned_force_are_said_apart(make_bridge):
    bridge, sent = spoken(make_bridge, 1.0)
    tick = bridge.ticks[0]
    known = next(p for a, p in sent if a.subject == "force_newton" and a.source == "twin/known")
    assert messages.Vector.FromString(known).vector.x == pytest.approx(
        sum(f.X_N for f in tick.known), rel=1e-6
    )
    learned = next(p for a, p in sent if a.subject == "force_newton" and a.source == "twin/learned")
    assert messages.Vector.FromString(learned).vector.x == 0.0


def test_without_a_datum_no_position_on_earth_is_said(make_bridge):
    _, sent = spoken(make_bridge, 3.0)
    assert not [a for a, _ in sent if a.subject == "location_fix"]


def test_before_the_first_estimate_only_record_and_status_are_said(make_bridge):
    bridge = make_bridge()
    bus = MemoryBus()
    bridge.loop.voice = Outbox(bridge.loop.publisher, "base", "alma", bus)
    bridge.run(0.1, lambda readings, b: [])
    subjects = {address(key).subject for key, _ in bus.sent}
    assert {"twin_tick", "twin_status"} <= subjects and "heading_true_north_deg" not in subjects
