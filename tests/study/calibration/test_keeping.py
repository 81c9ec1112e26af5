"""Predictions that know nothing of the ship: one keeps its speeds and its rate of turn, one stands still."""

from types import SimpleNamespace

import numpy as np
import pytest

from twin.study.calibration import held_out


def told(monkeypatch, drift, speed=2.0):
    """(`kept_m`, `stood_m`) by horizon on a steady circle that is recorded with a push of `drift` [m/s] to the
    north beside it."""
    t, rate = np.arange(200.0), 0.03
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
    found = held_out.knowing_nothing([(track, 0)], None)
    return [e["kept_m"] for e in found], [e["stood_m"] for e in found]


def test_a_steady_circle_is_kept_to_the_end(monkeypatch):
    assert np.allclose(told(monkeypatch, 0.0)[0], 0.0, atol=1e-9)


def test_what_pushes_beside_it_is_its_error(monkeypatch):
    horizons = np.array(held_out.HORIZONS_S)
    assert told(monkeypatch, 0.1)[0] == pytest.approx(0.1 * np.round(horizons))


def test_standing_still_is_off_by_the_way_that_was_made(monkeypatch):
    """Expected: the chord of the circle, 2 R |sin(r t/2)|."""
    t = np.round(held_out.HORIZONS_S)
    assert told(monkeypatch, 0.0)[1] == pytest.approx(2.0 * 2.0 / 0.03 * np.abs(np.sin(0.015 * t)))


def test_of_a_ship_that_only_drifts_neither_knows_more(monkeypatch):
    kept, stood = told(monkeypatch, 0.1, speed=0.0)
    assert kept == pytest.approx(stood)
