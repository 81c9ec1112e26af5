"""A ship of actuators on the bridge: what each says, how old that is, and which is lost."""

import json

import pytest

from tests.live.actuators import PODS, Afloat, Service, craft
from twin.live.bridge.text import page
from twin.physics.ship import load, save


@pytest.fixture
def service(tmp_path):
    save(craft(*PODS), tmp_path / "ship.toml")
    return Service(tmp_path / "ship.toml", Afloat(load(tmp_path / "ship.toml")))


def test_each_actuator_is_shown_with_value_unit_and_age(watch, feed, service):
    tick = service.run(3.0)
    feed.give(tick)
    frame = watch.step(5.0)
    shown = {c["name"]: c for c in frame["actuators"]}
    assert list(shown) == [f"{p['name']} {a}" for p in PODS for a in ("rate", "angle")]
    assert shown["port rate"]["value"] == pytest.approx(tick.actuators[2].value, abs=0.01)
    assert (shown["port rate"]["unit"], shown["port angle"]["unit"]) == ("1/min", "deg")
    assert all(c["level"] == "good" and c["age"] < 0.1 for c in shown.values())
    json.dumps(frame, allow_nan=False)


def test_a_lost_actuator_is_marked_in_words_and_its_age_grows_with_the_silence(watch, feed, service):
    service.run(3.0)
    tick = service.run(4.0, lambda said: {c: x for c, x in said.items() if c != "port.rate_rpm"})
    feed.give(tick)
    frame = watch.step(5.0)
    port = next(c for c in frame["actuators"] if c["name"] == "port rate")
    assert (port["value"], port["level"]) == (None, "bad")
    text = " ".join(page(frame).split())
    assert "port rate the last good sample is too old" in text and "starboard rate" in text
    assert all(len(row) <= 120 for row in page(frame).splitlines())
    later = watch.step(9.0)
    angle = next(c for c in later["actuators"] if c["name"] == "port angle")
    assert angle["age"] == pytest.approx(4.0, abs=0.11)


def test_a_ship_with_one_rudder_shows_no_table_of_actuators(watch, feed, ticks):
    feed.give(ticks[-1])
    frame = watch.step(1.0)
    assert frame["actuators"] == []
    assert "rudder angle" in page(frame)
