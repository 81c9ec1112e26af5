"""A prediction that knows nothing of the ship keeps its speeds and its rate of turn."""

from types import SimpleNamespace

import numpy as np
import pytest

from twin.study.calibration import held_out


def told(monkeypatch, drift):
    """`keeping` on a steady circle that is recorded with a push of `drift` [m/s] to the north beside it."""
    t, speed, rate = np.arange(200.0), 2.0, 0.03
    place = speed / (1j * rate) * (np.exp(1j * rate * t) - 1.0) + drift * t
    flat = np.zeros_like(t)
    state = np.c_[place.real, place.imag, rate * t, flat + speed, flat, flat + rate]
    track = SimpleNamespace(h=1.0, state=state)

    def ends(_track, _model, horizons_s):
        lead = np.array([round(horizons_s[0])])
        start = np.arange(0, len(t) - int(lead[0]), 10) if lead[0] < len(t) else np.zeros(0, dtype=int)
        step, valid = start + lead[:, None], np.ones((1, start.size), dtype=bool)
        windows = SimpleNamespace(lead=lead, start=start, valid=valid, step=step, seen=state, at=lambda _: 0)
        return [windows]

    monkeypatch.setattr(held_out, "ends", ends)
    monkeypatch.setattr(held_out, "fed", lambda model, _: (model, None))
    return held_out.keeping([(track, 0)], None)


def test_a_steady_circle_is_kept_to_the_end(monkeypatch):
    assert np.allclose(told(monkeypatch, 0.0), 0.0, atol=1e-9)


def test_what_pushes_beside_it_is_its_error(monkeypatch):
    horizons = np.array(held_out.HORIZONS_S)
    assert told(monkeypatch, 0.1) == pytest.approx(0.1 * np.round(horizons))
