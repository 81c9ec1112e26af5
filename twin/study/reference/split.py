"""A voyage's motion split into that at low frequency and that with the waves, and how much of each a metre of
wave height brings.

    nu_L = nu averaged twice over 1.2 peak periods, centred        nu_wave = nu - nu_L
    f_L = M nu_L' - (forces of the model at nu_L, psi and the inputs of the moment)
    a_wave = greatest |nu_wave| / H_s,   D_wave = (greatest |f_L| - D_calm)+ / H_s       one number a voyage

The certificate's promise is of nu_L (docs/stability.md, section 4). Source: Fossen (2021), ch. 13.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from twin.live.certificate.plant import DRIFT, MOTION, Row
from twin.physics import core
from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.reference.hierarchical import hierarchical_quantile

PERIODS = 1.2  # of the waves, over which the motion is averaged
UNITS = ("N/m", "N/m", "N m/m", "m/s/m", "m/s/m", "rad/s/m", "rad/m")
Array = NDArray[np.float64]


@dataclass(frozen=True)
class SplitVoyage:
    """What is known of a voyage, evenly sampled [SI]: nu over ground (3, N), psi (N,), inputs by attribute of
    Situation, current towards north and east (2, N)."""

    step_s: float
    nu: Array
    psi: Array
    inputs: Mapping[str, ArrayLike]
    current: Array
    H_s: float
    T_p: float


def window(T_p: float, step_s: float) -> int:
    """Samples in an average."""
    return max(round(PERIODS * T_p / step_s), 1)


def low_frequency(x: Array, samples: int) -> Array:
    """x (..., N) averaged twice over so many samples, centred; 2 x samples at either end are no use. In
    the unit of x."""
    kernel = np.convolve(np.ones(samples), np.ones(samples)) / samples**2
    return np.apply_along_axis(lambda row: np.convolve(row, kernel, mode="same"), -1, x)


def scores(model: Model, voyage: SplitVoyage, calm: Row) -> tuple[float, ...]:
    """(drift X, Y, N, motion u, v, r, psi) of this voyage, each by metre of wave height."""
    n = window(voyage.T_p, voyage.step_s)
    used = slice(2 * n, -2 * n)
    psi = np.unwrap(voyage.psi)
    nu, psi_L = low_frequency(voyage.nu, n), low_frequency(psi, n)
    motion = [np.abs(a - b)[used].max() for a, b in zip((*voyage.nu, psi), (*nu, psi_L), strict=True)]
    f = np.abs(force(model, nu, psi, voyage))[:, used].max(axis=1)
    drift = [max(x - c, 0.0) for x, c in zip(f, calm, strict=True)]
    return tuple(float(x / voyage.H_s) for x in (*drift, *motion))


def force(model: Model, nu: Array, psi: Array, voyage: SplitVoyage) -> Array:
    """(3, N) what the model's forces lack for this motion [N, N, N m]."""
    s = Situation(psi=psi, u=nu[0], v=nu[1], r=nu[2])  # type: ignore[arg-type]
    for name, x in voyage.inputs.items():
        setattr(s, name, x)
    north, east = voyage.current
    there = model.but(of_role("stream").absent(model.ship).but(north=north, east=east))  # type: ignore[arg-type]
    known = np.array([np.broadcast_to(x, psi.shape) for x in there.nu_dot(s)])
    lacking = np.gradient(nu, voyage.step_s, axis=1) - known
    return np.array(core.force_for(lacking[0], lacking[1], lacking[2], model.c), dtype=np.float64)


def section(found: Sequence[tuple[float, ...]], level: float, source: str) -> dict[str, Any]:
    """The ship file's [seaway] from one row of `scores` a voyage."""
    table: dict[str, Any] = {"voyages": len(found), "level": level, "source": source}
    for k, (name, unit) in enumerate(zip((*DRIFT, *MOTION), UNITS, strict=True)):
        q = hierarchical_quantile([[row[k]] for row in found], level)
        table[name] = {"value": float(f"{q:.4g}"), "unit": unit}
    return table
