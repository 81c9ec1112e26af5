"""What a calibration left in a ship file and somebody changed by hand: one line that says which part, and what
to do."""

from dataclasses import replace

import numpy as np
import pytest

from twin.errors import SettingsError
from twin.physics.effects import find, of_ship
from twin.physics.model import Model
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.instruments.on_references import KinematicRecord
from twin.study.reference.nuisance import from_ship, nuisance_unknowns
from twin.study.reference.structure import noise_model_of


def changed(ship, section, **entries):
    return replace(ship, notes={**ship.notes, section: {**ship.notes.get(section, {}), **entries}})


def floor(ship, **numbers):
    return changed(ship, "structural", floor={**ship.notes["structural"]["floor"], **numbers})


def indefinite(ship):
    covariance = np.array(ship.notes["structural"]["covariance"])
    covariance[0, 1] = covariance[1, 0] = 2.0 * np.sqrt(covariance[0, 0] * covariance[1, 1])
    return changed(ship, "structural", covariance=covariance.tolist())


def known(ship):
    return from_ship(Model.of(ship), nuisance_unknowns(Model.of(ship), of_ship(ship)))


DAMAGE = {
    "no fast part": (lambda s: noise_model_of(floor(s, white=[0.0, 0.0, 0.0])), r"\[structural\] floor"),
    "scatter below zero": (lambda s: noise_model_of(floor(s, sensor=-1.3)), r"\[structural\] floor"),
    "a prior in words": (
        lambda s: core_unknowns(Model.of(changed(s, "derivatives", N_r={"prior_sd": "wide"}))),
        r"\[derivatives\] prior_sd of N_r",
    ),
    "a prior below zero": (
        lambda s: core_unknowns(Model.of(changed(s, "derivatives", N_r={"prior_sd": -0.01}))),
        r"\[derivatives\] prior_sd of N_r",
    ),
    "no numbers of instruments": (
        lambda s: KinematicRecord.of_ship(replace(s, notes={**s.notes, "instruments": {"clock": "x"}})),
        r"\[instruments\]",
    ),
    "a list of instruments": (
        lambda s: effect_unknowns(
            find("SensorDelay"), Model.of(replace(s, notes={**s.notes, "instruments": [1.0]}))
        ),
        r"\[instruments\]",
    ),
    "no covariance": (lambda s: known(indefinite(s)), r"\[structural\] offset and covariance"),
}


@pytest.mark.parametrize("what", DAMAGE)
def test_it_is_refused_in_one_line_that_says_which_part(tanker, what):
    read, part = DAMAGE[what]
    with pytest.raises(SettingsError, match=part + r" in the ship file is damaged .*Calibrate it again\.$"):
        read(tanker)
    assert known(tanker) is not None
