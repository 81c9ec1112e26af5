"""The rudder's order in place of the rudder: the gear between them is found on the references and becomes a
part of the ship's model."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tests.thorough import thorough
from twin import cli
from twin.physics.effects import catalogue
from twin.physics.effects.steering_lag import TRAVEL, SteeringLag
from twin.physics.model import Model
from twin.physics.ship import load, save
from twin.recording.write import write_voyage
from twin.study.diagnosis.assemble import judgeable
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.nuisance import HEALTHY_WIDTHS, from_ship, nuisance_unknowns, of_known_weather
from twin.study.track.track import track

GYRO = 1e-6  # rad/s that the ship file already says of the gyro


@pytest.fixture(scope="module")
def ordered(tmp_path_factory, at_sea):
    """Two voyages of the tanker that hold the rudder's order behind a gear slower than usual, and one behind
    a gear that is slower still; what was hidden in each; and the ship calibrated on the first two."""
    folder, paths, hidden = tmp_path_factory.mktemp("gear"), {}, {}
    for name, sailed in (("zigzag", "slow gear zigzag"), ("mixed", "slow gear"), ("slower", "slower gear")):
        voyage, truth = at_sea[sailed]
        paths[name], hidden[name] = folder / f"{name}.mcap", truth["SteeringLag"]
        write_voyage(voyage, paths[name])
    start, out, said = folder / "start.toml", folder / "tanker.toml", folder / "said.json"
    ship = load("kvlcc2")
    save(replace(ship, effects=(catalogue()["GyroBias"].absent(ship).but(bias=GYRO),)), start)
    words = [
        "calibrate",
        str(paths["zigzag"]),
        str(paths["mixed"]),
        "--ship",
        str(start),
        "-o",
        str(out),
        "--json",
        str(said),
    ]
    assert cli.main(words) == 0
    return paths, hidden, out, json.loads(said.read_text())


@thorough
def test_the_gear_between_order_and_rudder_is_found_on_the_references(ordered):
    _, hidden, out, said = ordered
    (gear,) = [e for e in load(out).effects if type(e) is SteeringLag]
    assert gear.travel_time == pytest.approx(np.degrees(TRAVEL) / hidden["mixed"]["rate_degps"], rel=0.2)
    assert gear.delay == pytest.approx(hidden["mixed"]["delay_s"], rel=0.5)
    assert said["gear"]["delay"]["value"] == gear.delay and said["gear"]["delay"]["sd"] > 0.0


@thorough
def test_what_else_the_ship_file_held_stays_as_it_was(ordered):
    ship = load(ordered[2])
    assert (
        [type(e).__name__ for e in ship.effects]
        == ["GyroBias", "SteeringLag"]
        == ship.notes["structural"]["beside_effects"]
    )
    assert ship.effects[0].bias == GYRO


@thorough
def test_a_gear_that_became_slower_than_the_ship_file_has_it_is_named_as_a_change(ordered, tmp_path, capsys):
    paths, hidden, out, _ = ordered
    answer = tmp_path / "answer.json"
    assert cli.main(["diagnose", str(paths["slower"]), "--ship", str(out), "--json", str(answer)]) == 0
    said = json.loads(answer.read_text())
    assert said["missing"] == ["SteeringLag"]
    assert "a change of SteeringLag" in capsys.readouterr().out
    travel = next(p for p in said["candidates"][0]["parameters"] if p["name"] == "travel_time")
    assert travel["low95"] < np.degrees(TRAVEL) / hidden["slower"]["rate_degps"] < travel["high95"]
    assert travel["in_ship_file"] == pytest.approx(
        next(e for e in load(out).effects if type(e) is SteeringLag).travel_time
    )


@thorough
def test_an_effect_that_the_ship_has_is_asked_about_from_where_it_stands(ordered):
    model = Model.of(load(ordered[2]))
    (gear,) = model.lags
    assert [u.centre for u in effect_unknowns(SteeringLag, model)] == [
        gear.delay,
        gear.travel_time,
        gear.ease,
    ]


@thorough
def test_of_an_effect_added_after_calibration_the_ship_file_knows_nothing_but_its_prior(ordered):
    ship = load(ordered[2])
    wear = catalogue()["RudderWear"].absent(ship).but(loss=0.2)
    later = Model.of(replace(ship, effects=(*ship.effects, wear)))
    labels = [u.label for u in nuisance_unknowns(later, catalogue())]
    known = from_ship(later, nuisance_unknowns(later, catalogue()))
    at = labels.index("RudderWear.loss")
    assert known.pull[at] == 0.0 and known.information[at, at] == 1.0
    assert known.information[labels.index("SteeringLag.delay")].max() > 1.0


def test_a_change_is_asked_of_what_she_has_and_of_the_weather_that_she_knows(tanker, voyages):
    tracks, known = [track(voyages["nothing"], tanker)], catalogue()
    assert {"Wind", "RudderWear"} <= set(judgeable(tracks, Model.of(tanker), known))
    has = Model.of(tanker).but(known["Wind"].plausible(tanker), known["RudderWear"].plausible(tanker))
    assert {"Wind", "RudderWear"} <= set(judgeable(tracks, has, known))
    assert of_known_weather(Model.of(tanker), known) == []
    usual = {u.label: u.sd for u in of_known_weather(has, known)}
    assert (
        usual
        and {label.split(".")[0] for label in usual} == {"Wind"}
        and usual["Wind.c_y"] == pytest.approx(HEALTHY_WIDTHS * 0.8)
    )
