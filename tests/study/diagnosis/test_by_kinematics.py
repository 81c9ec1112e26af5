"""Instruments first: a compass that is slow is proved without the ship, and only then a candidate."""

from types import SimpleNamespace

import pytest

from bench.fleet.asked import voyage
from bench.fleet.build import build
from bench.fleet.cases import generator, plan, sailed
from twin.physics.effects.heading_lag import HeadingLag
from twin.physics.model import Model
from twin.study.diagnosis.assemble import of_tracks
from twin.study.diagnosis.by_kinematics import asked_for, beyond_usual, instrument_suspected
from twin.study.first_model.init import OPTIONS, first_model
from twin.study.track.track import track

SHIP, SLOW, PROMPT = ("heeling", 5), "heeling-5-5", "heeling-5-1"


@pytest.fixture(scope="module")
def random_ship():
    """A random ship of a form that the twin does not have, and its first model."""
    ship = build(*SHIP)
    given = {name: None for name, *_ in OPTIONS} | ship.given(generator(ship, 4))
    return ship, first_model("heeling", given)[0]


def asked_of(random_ship, key):
    """What kinematics ask for on one of its voyages; and what is hidden there."""
    ship, model = random_ship
    hidden = next(c for c in plan(ship, 8) if c.key == key)
    tracks = (track(voyage(sailed(ship, hidden)), model),)
    case = SimpleNamespace(tracks=tracks, model=Model.of(model), candidates=("Current", "SensorDelay"))
    return asked_for(case), set(hidden.hidden)


def test_a_slow_compass_is_asked_for_whatever_the_ship_is(random_ship):
    assert asked_of(random_ship, SLOW) == ((HeadingLag,), {"SlowCompass"})


def test_a_receiver_that_wanders_makes_no_compass_slow(random_ship):
    assert asked_of(random_ship, PROMPT) == ((), {"ReceiverWander"})


def test_what_kinematics_ask_for_becomes_a_candidate_that_else_is_none(tanker, voyages):
    tracks = [track(voyages["nothing"], tanker)]
    assert "HeadingLag" not in of_tracks(tracks, tanker).candidates
    assert "HeadingLag" in of_tracks(tracks, tanker, asked=(HeadingLag,)).candidates


@pytest.fixture(scope="module")
def case(tanker, voyages):
    return of_tracks([track(voyages["nothing"], tanker)], tanker)


def test_only_where_an_instrument_is_suspected_are_the_instruments_asked(case):
    assert instrument_suspected(case, ("Current", "SensorDelay")) and instrument_suspected(
        case, ("HullFouling", "GyroBias")
    )
    assert not instrument_suspected(case, ()) and not instrument_suspected(case, ("Current", "HullFouling"))


@pytest.mark.parametrize(
    "age_s, sd_s, seen, asked",
    [(2.0, 0.1, True, True), (0.6, 0.01, True, False), (2.0, 0.5, True, False), (2.0, 0.1, False, False)],
)
def test_a_compass_is_called_slow_beyond_what_compasses_usually_are_and_what_the_readings_tell(
    age_s, sd_s, seen, asked
):
    """Test: usual is 0.15 s. Expected: five standard deviations, of both together."""
    e = SimpleNamespace(value=age_s, sd=sd_s, seen=seen, unknown=SimpleNamespace(fault="heading_delay"))
    found = SimpleNamespace(of=lambda name: e if name == "heading_delay" else None)
    assert beyond_usual(found) == (["heading_delay"] if asked else [])
