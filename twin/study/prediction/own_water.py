"""The water of the voyage under judgement: a stream that the model does not know is no fault of the model.

It is estimated at the start of every window from the windows that had ended by then, never from what comes
after, so that the prediction stays one. To first order a stream c (toward north and east) changes the error e
of a window by J c. With windows j that ended before,

    c = -(P^-1 + sum_j k_j J_j' S^-1 J_j)^-1  sum_j k_j J_j' S^-1 e_j,
        k_j = (share that does not overlap) exp(-age_j / MEMORY_S)

S the covariance of a healthy ship's error, P what a stream may be before anything was seen of it.

Source: Ljung (1999) System identification, sec. 11.2 (recursive least squares with forgetting).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.study.prediction.error_vectors import in_axes, vectors
from twin.study.prediction.openloop import MODEL, Windows, again

STREAM = 0.05  # of U_0, how fast the water usually moves when nobody has told
MEMORY_S = 600.0  # after which it may be another
SLOPE_STEP = 0.02  # of U_0, for the slopes
LENGTHS = 3.0  # ahead, over which a stream shows


@dataclass(frozen=True)
class OwnWater:
    """Predictions in the stream that the voyage had shown when each began."""

    windows: Windows
    stream_mps: np.ndarray  # (W, 2) that stream, toward north and east, beside the model's own


def shown_best(horizons_s: Sequence[float], model: Model) -> float:
    """Of some times ahead [s] the one over which a stream shows best."""
    best_s = LENGTHS * float(model.ship.scale("time"))
    return min(horizons_s, key=lambda h: abs(np.log(h / best_s)))


def settled(windows: Windows, model: Model, covariance: np.ndarray, horizon_s: float) -> OwnWater:
    """The same predictions with the stream that the voyage had shown when each began. `covariance` (8, 8): of
    the error at `horizon_s`."""
    slopes = _slopes(windows, model)
    k = windows.at(horizon_s)
    error, push = vectors(windows)[k], np.stack([in_axes(windows, j[k]) for j in slopes], axis=-1)
    read = np.isfinite(error) & np.isfinite(np.diag(covariance))
    told, pull = _informed(error, push, read, covariance)
    begins, ends = windows.track.t[windows.start], windows.track.t[windows.start] + horizon_s
    age = begins[:, None] - ends
    stride = float(np.median(np.diff(begins))) if begins.size > 1 else horizon_s
    weight = np.where(age >= 0.0, np.exp(-np.maximum(age, 0.0) / MEMORY_S), 0.0) * min(
        1.0, stride / horizon_s
    )
    prior = np.eye(2) / (STREAM * float(model.ship.scale("speed"))) ** 2
    stream = -np.linalg.solve(prior + np.einsum("wj,jab->wab", weight, told), (weight @ pull)[..., None])[
        ..., 0
    ]
    there = replace(windows, promised=windows.promised + np.einsum("wa,akwc->kwc", stream, slopes))
    return OwnWater(there, stream)


def _informed(
    error: np.ndarray, push: np.ndarray, read: np.ndarray, covariance: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(W, 2, 2) and (W, 2): what each window tells of the stream."""
    told, pull = np.zeros((len(error), 2, 2)), np.zeros((len(error), 2))
    for pattern in np.unique(read[read.any(1)], axis=0):
        rows, columns = np.flatnonzero((read == pattern).all(1)), np.flatnonzero(pattern)
        weight = np.linalg.inv(covariance[np.ix_(columns, columns)])
        J, e = push[np.ix_(rows, columns)], error[np.ix_(rows, columns)]
        told[rows] = np.einsum("wca,cd,wdb->wab", J, weight, J)
        pull[rows] = np.einsum("wca,cd,wd->wa", J, weight, e)
    return told, pull


def _slopes(windows: Windows, model: Model) -> np.ndarray:
    """(2, K, W, 8) what a stream of 1 m/s toward north, and toward east, changes of every promise, to first
    order."""
    step = SLOPE_STEP * float(model.ship.scale("speed"))
    stream = of_role("stream")
    current = next((e for e in model.effects if isinstance(e, stream)), stream.absent(model.ship))
    out = []
    for axis in ("north", "east"):
        moved = model.but(current.but(**{axis: float(getattr(current, axis)) + step}))
        out.append((again(windows, moved) - windows.promised[MODEL]) / step)
    return np.stack(out)
