"""The density of a ship's open-loop errors where no reference voyage told it: what sensors and structural
error make of these voyages, wider."""

from collections.abc import Sequence

import numpy as np

from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.study.estimation.innovations import NoiseModel
from twin.study.prediction.error_vectors import vectors
from twin.study.prediction.left_out import ALIKE
from twin.study.prediction.openloop import STRUCTURE, Windows, predict
from twin.study.reference.path_error import SCATTER, PathError, of_ship, tail
from twin.study.reference.sailed import fed
from twin.study.reference.structure import noise_model_of
from twin.study.track.track import Track

# than simulated: one standard deviation of what healthy voyages scatter among themselves
WIDER = float(np.exp(SCATTER))


def errors_of(ship: Ship, tracks: Sequence[Track], horizons_s: Sequence[float]) -> PathError:
    """What the ship's calibration measured, with what it could not measure from these voyages' simulated
    noise; all of it from there where the file knows no reference voyages (a bundled ship, an older file)."""
    own = of_ship(ship)
    if own is not None and all(
        np.isfinite(np.diag(own.covariance[0]))[np.isfinite(t.measured).any(0)].all() for t in tracks
    ):
        return own
    other = prior(Model.of(ship), tracks, horizons_s)
    return other if own is None else own.filled(other)


def prior(model: Model, tracks: Sequence[Track], horizons_s: Sequence[float]) -> PathError:
    """Simulated on these tracks with the ship's structural error, or the usual one of ships that were never
    calibrated."""
    noise_model = noise_model_of(model.ship) or NoiseModel()
    windows = [
        predict(t, fed(model, t)[0], horizons_s, noise_model=noise_model, seed=i)
        for i, t in enumerate(tracks)
    ]
    usable = [h for h in horizons_s if any(w.valid[w.at(h)].any() for w in windows)] or [min(horizons_s)]
    covariance = np.array([WIDER**2 * _covariance(windows, h) for h in usable])
    return PathError(
        np.array(usable),
        covariance,
        np.full(len(usable), ALIKE),
        tail([]),
        np.array([_means(windows, h) for h in usable]),
    )


def _covariance(windows: Sequence[Windows], horizon_s: float) -> np.ndarray:
    """(8, 8); NaN for instruments that none of the voyages has."""
    noise = np.concatenate([vectors(w, STRUCTURE)[w.at(horizon_s)] for w in windows])
    there = np.isfinite(noise)
    S = np.nan_to_num(noise).T @ np.nan_to_num(noise) / np.maximum(there.T.astype(float) @ there, 1.0)
    S = 0.5 * (S + S.T) + 1e-3 * np.diag(np.diag(S)) + 1e-18 * np.eye(8)
    S[~there.any(0)], S[:, ~there.any(0)] = np.nan, np.nan
    return np.asarray(S)


def _means(windows: Sequence[Windows], horizon_s: float) -> list[float]:
    errors = [w.errors(STRUCTURE) for w in windows]
    return [
        WIDER
        * float(
            np.nanmean(
                np.concatenate([e[name][w.at(horizon_s)] for e, w in zip(errors, windows, strict=True)])
            )
        )
        for name in ("position", "lateral", "heading")
    ]
