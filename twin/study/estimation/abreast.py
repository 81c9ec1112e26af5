"""Segments of tracks side by side, begun together: as the filter reads them."""

from collections.abc import Sequence

import numpy as np

from twin.study.estimation.filters import LIGHT

Where = Sequence[tuple[int, int, int]]  # segments: track, first step, last step


def abreast(arrays: Sequence[np.ndarray], where: Where, fill: float = 0.0) -> np.ndarray:
    """(T, S, ...) the segments of the tracks' arrays (N, ...), begun together; shorter ones are filled up.
    In the unit of the arrays."""
    out = np.full((max(b - a for _, a, b in where), len(where), *arrays[0].shape[1:]), fill, arrays[0].dtype)
    for k, (i, a, b) in enumerate(where):
        out[: b - a, k] = arrays[i][a:b]
    return out


def beside_each(first: np.ndarray, arrays: Sequence[np.ndarray], where: Where) -> np.ndarray:
    """(T, S, M, 1 + P) LIGHT: a first column, and the tracks' arrays (N, M, P) beside it. In the unit of
    the arrays."""
    out = np.zeros((*first.shape, 1 + arrays[0].shape[-1]), LIGHT)
    out[..., 0] = first
    for k, (i, a, b) in enumerate(where):
        out[: b - a, k, :, 1:] = arrays[i][a:b]
    return out
