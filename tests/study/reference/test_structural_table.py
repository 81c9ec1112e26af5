"""What a calibration left in the ship file: damaged, it is one line and no traceback."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import twin
from twin.errors import SettingsError
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.diagnosis.assemble import assemble
from twin.study.reference.path_error import of_ship
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
        of_ship(damaged(bundled, path_error=table))


def test_what_is_whole_is_read(bundled):
    assert noise_model_of(bundled) and of_ship(bundled) and Model.of(bundled).ship is bundled
