"""A ship whose receiver always smoothed course and speed: calibration writes it into the ship file, and a
voyage with that receiver, on which nothing but the stream is new, is told to have no false instrument."""

from dataclasses import replace

import numpy as np
import pytest

from tests.study.conftest import seldom
from tests.thorough import thorough
from twin.recording.voyage import Voyage
from twin.study.calibration.calibration_lines import terminal_lines
from twin.study.calibration.core_fit import fitted_core
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.reference.sailed import sailed

TIME_S = 8.0  # of the smoothing
U, V, HEADING = "surge_velocity_mps", "sway_velocity_mps", "heading_true_north_deg"


def smoothed(voyage: Voyage) -> Voyage:
    """The voyage as a receiver shows it that smooths course and speed over ground."""
    psi = np.radians(voyage.columns[HEADING])
    earth = (voyage.columns[U] + 1j * voyage.columns[V]) * np.exp(1j * psi)
    share, out = 1.0 - np.exp(-float(np.median(np.diff(voyage.time_s))) / TIME_S), earth.copy()
    for k in range(1, out.size):
        out[k] = out[k - 1] + share * (earth[k] - out[k - 1])
    out *= np.exp(-1j * psi)
    meta = {**voyage.meta, "velocity_frame": "course"}
    return replace(voyage, columns={**voyage.columns, U: out.real, V: out.imag}, meta=meta)


@pytest.fixture(scope="module")
def calibrated(voyages, tanker):
    """The published tanker calibrated on three voyages with such a receiver."""
    fitted = [
        sailed(smoothed(seldom(voyages[name].between(0.0, 450.0))), tanker)
        for name in ("calm", "nothing", "calm again")
    ]
    return fitted_core(fitted, [(fitted[1].track, 0)], tanker, by="steps").calibrated()


@thorough
def test_the_smoothing_becomes_the_ships_own_and_is_said(calibrated):
    (own,) = (e for e in calibrated.ship.effects if type(e).__name__ == "ReceiverSmoothing")
    assert own.time == pytest.approx(TIME_S, rel=0.2)
    assert set(calibrated.result["instruments"]) == {"ReceiverSmoothing"}
    said = terminal_lines(calibrated.result | {"held_out_is": "", "doubts": [], "data_checks": []})
    assert sum("ReceiverSmoothing: time" in line for line in said) == 1
    kept = calibrated.ship.notes["instruments"]["numbers"]["smoothing"]["voyages"]
    assert [set(v) for v in kept] == 3 * [{"voyage", "value", "sd", "log_bayes_factor"}]


@thorough
def test_a_voyage_in_a_stream_with_that_receiver_has_no_false_instrument(calibrated, voyages):
    result = diagnose([smoothed(voyages["Current"])], calibrated.ship).result
    suspected = {"SensorDelay", "AntennaOffset", "ReceiverSmoothing", "HeadingLag"}
    assert not suspected & set(result["missing"])
    assert not suspected & {c["effect"] for c in result["candidates"] if c["probability"] >= 0.5}
