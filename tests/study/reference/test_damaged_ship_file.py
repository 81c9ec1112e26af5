"""What a calibration left in a ship file and somebody changed by hand: one line that says which part, and what
to do."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import twin
from twin.errors import SettingsError
from twin.physics.effects import find, of_ship
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.diagnosis.assemble import assemble
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.instruments.on_references import KinematicRecord
from twin.study.reference import path_error
from twin.study.reference.nuisance import from_ship, nuisance_unknowns
from twin.study.reference.structure import noise_model_of


def damaged(ship, **parts):
    """The ship whose file holds these parts of the table otherwise; None: not at all."""
    table = {k: v for k, v in {**ship.notes["structural"], **parts}.items() if v is not None}
    return replace(ship, notes={**ship.notes, "structural": table})


@pytest.fixture(scope="module")
def bundled():
    return load(Path(twin.__file__).parent / "voyages" / "tanker.toml")


@pytest.mark.parametrize(
    "parts",
    [
        {"covariance": None},
        {"covariance": [[1.0]]},
        {"offset": None},
        {"offset": ["much"]},
        {"labels": 3},
        {"temper_beside": "warm"},
        {"temper_beside": 0.0},
        {"temper_beside": float("nan")},
        {"weather": 3},
        {"floor": 3},
        {"floor": {"share": float("nan")}},
    ],
)
def test_a_diagnosis_says_in_one_line_which_part_is_damaged(bundled, voyages, parts):
    with pytest.raises(SettingsError, match=r"\[structural\] .* damaged .*Calibrate it again\.$"):
        assemble([voyages["nothing"]], damaged(bundled, **parts))


def test_a_variance_below_zero_or_that_is_no_number_is_damage(bundled, voyages):
    size = len(bundled.notes["structural"]["labels"])
    for variance, why in ((-1.0, "a variance below zero"), (float("nan"), "not finite")):
        ship = damaged(bundled, covariance=(variance * np.eye(size)).tolist())
        with pytest.raises(SettingsError, match=why):
            assemble([voyages["nothing"]], ship)


@pytest.mark.parametrize("part", [{"sailed": [1.0]}, {"level": [1.0]}, {"tail": "thick"}])
def test_the_errors_of_the_path_are_checked_alike(bundled, part):
    table = {**bundled.notes["structural"]["path_error"], **part}
    with pytest.raises(SettingsError, match="path_error"):
        path_error.of_ship(damaged(bundled, path_error=table))


def test_what_is_whole_is_read(bundled):
    assert noise_model_of(bundled) and path_error.of_ship(bundled) and Model.of(bundled).ship is bundled


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
