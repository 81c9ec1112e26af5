"""A rate gyro that shows too much or too little of every turn: named where it is more than such gyros usually
are off, and no news else."""

from dataclasses import replace

import pytest

from tests.thorough import thorough
from twin.physics.effects import find, of_ship
from twin.physics.model import Model
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.reference.nuisance import HEALTHY_WIDTHS, of_no_calibration

RATE = "yaw_rate_degps"


@pytest.mark.parametrize("scale, named", [(-0.2, ["GyroScale"]), pytest.param(-0.01, [], marks=thorough)])
def test_a_scale_is_named_where_it_is_more_than_gyros_usually_have(tanker, voyages, scale, named):
    healthy = voyages["nothing"]
    shown = replace(healthy, columns=healthy.columns | {RATE: (1.0 + scale) * healthy.columns[RATE]})
    found = diagnose([shown], tanker).result
    assert found["missing"] == named
    for cause in found["candidates"][: len(named)]:
        (number,) = cause["parameters"]
        assert number["low95"] <= scale <= number["high95"]


def test_what_no_core_is_fitted_beside_is_usually_a_little_off_unless_the_ship_file_has_it(tanker):
    (size,) = find("GyroScale").params()
    assert of_no_calibration(Model.of(tanker), of_ship(tanker)) == {
        "GyroScale.scale": HEALTHY_WIDTHS * size.sd
    }
    its = tanker.with_effects(find("GyroScale").absent(tanker))
    assert of_no_calibration(Model.of(its), of_ship(tanker)) == {}
