"""Which numbers of a late receiver or a compass are open, by what turns the velocity over ground."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from twin.physics.effects import catalogue
from twin.physics.effects.heading_bias import HeadingBias
from twin.physics.effects.heading_lag import HeadingLag
from twin.physics.effects.sensor_delay import SensorDelay
from twin.physics.model import Model
from twin.study.diagnosis.as_filed import model_with
from twin.study.estimation.columns import changed, columns
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.track.track import track

TURNED_BY_COMPASS = [(SensorDelay, "delay"), (HeadingLag, "lag"), (HeadingBias, "bias")]


@pytest.fixture
def sailing(tanker):
    """The tanker with what its references told of the velocity, and these effects alone."""

    def model(velocity_by=None, *effects):
        told = {} if velocity_by is None else {"instruments": {"velocity_by": velocity_by}}
        ship = replace(tanker, notes={k: v for k, v in tanker.notes.items() if k != "instruments"} | told)
        return Model(ship, effects)

    return model


def names(effect, model):
    return [u.name for u in effect_unknowns(effect, model)]


@pytest.mark.parametrize(("effect", "number"), TURNED_BY_COMPASS)
def test_without_a_word_of_the_references_the_turning_is_a_number_of_its_own(sailing, effect, number):
    for unknown in (None, "", "a gyro"):
        assert names(effect, sailing(unknown))[:2] == [number, "turned"]


@pytest.mark.parametrize(("by", "turned"), [("compass", 0.3), ("receiver", 0.0)])
@pytest.mark.parametrize(("effect", "number"), TURNED_BY_COMPASS)
def test_what_the_compass_turns_is_as_far_off_as_its_reading_and_what_the_receiver_turns_is_right(
    sailing, effect, number, by, turned
):
    model = sailing(by)
    only, *form = effect_unknowns(effect, model)
    assert "turned" not in {u.name for u in form}
    off = next(e for e in changed(model, only, 0.3, catalogue()).effects if type(e) is effect)
    assert only.name == number
    assert off.values() == {number: 0.3, "turned": turned} | {u.name: u.centre for u in form}


@pytest.mark.parametrize("by", ["compass", "receiver"])
def test_a_ship_file_that_has_it_otherwise_keeps_both_numbers(sailing, by):
    own = SensorDelay(delay=0.4, turned=0.1)
    assert names(SensorDelay, sailing(by, own)) == ["delay", "turned"]


def test_its_column_is_that_of_both_numbers_together(sailing, voyages):
    sailed, free = track(voyages["nothing"], sailing().ship), sailing()
    apart = columns(sailed, free, effect_unknowns(SensorDelay, free), catalogue())[1]
    tied = sailing("compass")
    together = columns(sailed, tied, effect_unknowns(SensorDelay, tied), catalogue())[1]
    assert np.abs(apart[:, :, 1]).max() > 1e-3
    assert np.allclose(together[:, :, 0], apart.sum(axis=2), atol=1e-3 * np.abs(together).max())


def test_the_ship_file_has_both_numbers(sailing):
    model = sailing("compass")
    effects = effect_unknowns(SensorDelay, model)
    case = SimpleNamespace(
        model=model, effects=effects, catalogue=catalogue(), tracks=[SimpleNamespace(name="monday")]
    )
    added = model_with(case, ["SensorDelay"], np.array([2.0])).effects[-1]
    assert added.values() == {"delay": 2.0 * effects[0].sd, "turned": 2.0 * effects[0].sd}
