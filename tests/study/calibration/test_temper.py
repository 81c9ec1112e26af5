"""By how much a likelihood is tempered: by what the voyages leave over under the noise model that it is of."""

import pytest

from bench.small_boats import sailed, ship_of
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.study.calibration import core_fit
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.fit import fit
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.reference.nuisance import TEMPER, temper_of
from twin.study.track.track import track

BOAT, SECONDS = "screws and bow thruster", 60.0


def test_the_core_is_fitted_with_the_temper_of_the_noise_model_that_was_found(monkeypatch):
    """Test: a noise model that leaves far less unexplained than the one before it. Expected: the temper of what
    the first fit leaves over under it, which is another than under the one before."""
    ship = ship_of(BOAT)
    model, quiet = Model.of(ship), NoiseModel(share=(0.01,) * 3, white=(0.005,) * 3, sensor=1.0)
    tracks = [track(sailed(BOAT, seed, SECONDS, 3), ship) for seed in (1, 2)]
    first = fit(tracks, model, core_unknowns(model), of_ship(ship), NoiseModel(), temper=TEMPER, smooth=True)
    monkeypatch.setattr(core_fit, "structural_noise", lambda *_: quiet)
    found = core_fit._core(core_fit.RoughCore(ship, tracks, first, (), ()), lambda text: None, None)
    left = innovate(first.lines, [quiet])[0]
    assert found.temper == temper_of(left, first.unknowns)
    assert found.temper != pytest.approx(temper_of(first.normal, first.unknowns), rel=0.05)
