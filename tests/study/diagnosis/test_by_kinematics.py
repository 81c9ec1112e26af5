"""Instruments first: a compass that is slow is proved without the ship, and only then a candidate; and what
kinematics know to be as on the reference voyages is no change."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from bench.fleet.fact_rows import voyage
from bench.fleet.plausibility import build
from bench.fleet.voyage_plan import generator, plan, sailed
from twin.physics.effects.heading_lag import HeadingLag
from twin.physics.model import Model
from twin.study.diagnosis import by_kinematics
from twin.study.diagnosis.assemble import of_tracks
from twin.study.diagnosis.by_kinematics import (
    beyond_usual,
    instrument_suspected,
    kinematics,
    other_than_before,
    reached,
    suspected_instruments,
)
from twin.study.first_model.first_estimate import OPTIONS, first_model
from twin.study.instruments.on_references import KinematicOfVoyage, KinematicRecord, KinematicUsual
from twin.study.instruments.unknowns import INDEX
from twin.study.reference.evidence import Nuisance
from twin.study.track.track import track

SHIP, SLOW, PROMPT = ("heeling", 5), "heeling-5-5", "heeling-5-1"


@pytest.fixture(scope="module")
def random_ship():
    """A random ship of a form that the twin does not have, and its first model."""
    ship = build(*SHIP)
    given = {name: None for name, *_ in OPTIONS} | ship.given(generator(ship, 4))
    return ship, first_model("heeling", given)[0]


@pytest.fixture(scope="module")
def slow(random_ship):
    """What kinematics say of a voyage on which the compass is slow."""
    return asked_of(random_ship, SLOW)[0]


def asked_of(random_ship, key):
    """What kinematics say of one of its voyages; what they ask for; and what is hidden there."""
    ship, model = random_ship
    hidden = next(c for c in plan(ship, 8) if c.key == key)
    asked = kinematics([voyage(sailed(ship, hidden))], model)
    case = SimpleNamespace(model=Model.of(model), candidates=("Current", "SensorDelay"))
    return asked, suspected_instruments(case, asked), set(hidden.hidden)


def record(values, sd=0.05, name="heading_delay", clock="rate_delay"):
    """References on which kinematics had these numbers."""
    told = tuple(KinematicOfVoyage(f"calm {i}", v, sd, 9.0) for i, v in enumerate(values))
    between = float(np.std(values, ddof=1))
    usual = KinematicUsual(float(np.mean(values)), sd / np.sqrt(len(values)), between, told)
    return KinematicRecord(clock, (), True, {name: usual})


def test_a_slow_compass_is_asked_for_whatever_the_ship_is(random_ship):
    assert asked_of(random_ship, SLOW)[1:] == ((HeadingLag,), {"SlowCompass"})


def test_a_receiver_that_wanders_makes_no_compass_slow(random_ship):
    assert asked_of(random_ship, PROMPT)[1:] == ((), {"ReceiverWander"})


def test_a_compass_that_was_as_slow_on_the_references_is_no_other_one(slow):
    age, sd = slow.number("heading_delay")
    assert age > 20.0 * sd
    before = SimpleNamespace(record=record([age - 0.02, age + 0.02], clock=slow.found.clock))
    as_before = SimpleNamespace(found=slow.found, number=slow.number, comparable=("heading_delay",))
    as_before.record = before.record
    assert other_than_before(as_before) == []
    as_before.record = record([0.0, 0.04], clock=slow.found.clock)
    assert other_than_before(as_before) == ["heading_delay"]


@pytest.mark.parametrize("instead, beside", [((), {"log_scale", "log_bias"}), (("log_bias",), {"log_bias"})])
def test_a_number_is_told_in_the_place_of_a_fault_that_the_voyages_do_not_tell_from_it(
    monkeypatch, instead, beside
):
    """Test: a log whose scale is seen, or its scale or bias. Expected: its bias beside the scale, or alone."""
    asked_of_equations = []

    def equations(_, __, open_ones):
        asked_of_equations.append(set(open_ones))
        return SimpleNamespace(at=[INDEX["log_bias"]], number=lambda i: (0.4, 0.1))

    monkeypatch.setattr(by_kinematics, "equations", equations)
    found = SimpleNamespace(
        faults=("log_scale",),
        instead={"log_scale": instead},
        log_bayes_factors={"log_scale": 30.0, "log_bias": 29.0},
        readings=(None,),
        fit=None,
    )
    assert by_kinematics.AskedKinematics(found, None).number("log_bias") == (0.4, 0.1)
    assert asked_of_equations == [beside]


def test_ages_from_another_instrument_are_not_compared(slow):
    other = type(slow)(slow.found, record([0.0, 0.1], clock="log_delay"))
    same = type(slow)(slow.found, record([0.0, 0.1], clock=slow.found.clock))
    assert other.comparable == () and same.comparable == ("heading_delay",)


def hypothesis(bias, sd=0.002):
    """A likeliest hypothesis with a compass that is off by so much [rad], on a ship of which nothing is
    usual."""
    u = SimpleNamespace(owner="HeadingBias", label="HeadingBias.bias", sd=0.02)
    nuisance = Nuisance((u,), np.eye(1), np.zeros(1), {})
    posterior = SimpleNamespace(z=np.array([bias / u.sd]), covariance=np.array([[(sd / u.sd) ** 2]]))
    return SimpleNamespace(effects=(u,), nuisance=nuisance), SimpleNamespace(posterior=posterior)


def says(seen, sd=0.002, references=(0.010, 0.012, 0.008)):
    """Kinematics that have the compass off by so much."""
    return SimpleNamespace(
        record=record(references, sd=0.001, name="A"), comparable=("A",), number=lambda name: (seen, sd)
    )


@pytest.mark.parametrize(
    "bias, seen, expected", [(0.03, 0.0105, True), (0.03, 0.040, None), (0.002, 0.0105, None), (0.03, 0.0, False)]
)  # fmt: skip
def test_what_kinematics_know_to_be_as_on_the_references_is_no_change(bias, seen, expected):
    """Test: 0.010 rad on the references; a change of so much is suspected, and so much seen. Expected: as there
    (True), as suspected or too small to say (None), as neither (False)."""
    share = reached(*hypothesis(bias), "HeadingBias", says(seen))
    assert share is None if expected is None else (share >= 0.25) == expected


def test_reference_files_of_one_name_in_several_folders_stay_several():
    """Test: seen 0.0125 rad, between what two references say and the third; then all three are called `log`.
    Expected: the same share."""
    apart, alike = says(0.0125), says(0.0125)
    number = alike.record.numbers["A"]
    same = tuple(replace(v, voyage="log") for v in number.voyages)
    alike.record = replace(alike.record, numbers={"A": replace(number, voyages=same)})
    asked = hypothesis(0.03)
    shares = [reached(*asked, "HeadingBias", kinematics) for kinematics in (apart, alike)]
    assert shares[0] == shares[1] and 0.0 < shares[0] < 1.0


def test_what_kinematics_hardly_tell_contradicts_nothing():
    assert reached(*hypothesis(0.03), "HeadingBias", says(0.0105, sd=0.03)) is None
    assert reached(*hypothesis(0.03), "HeadingBias", SimpleNamespace(record=None)) is None


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
