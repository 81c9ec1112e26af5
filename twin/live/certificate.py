"""The stabilizer's certificate: how far the observer's error can go, worked out from the ship's own numbers before she sails.

`certify` at start (or `kept`, which looks it up in a file beside the ship), `Tube.step` once a tick. Assumptions, proof and what is
not promised: docs/stability.md. Plain floats; only the sure bounds of the slopes need numpy, and only when they are not on file.
"""

import hashlib
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from twin.errors import SettingsError
from twin.physics.model import Model

from .comparison import Matrix
from .operating import Confined, OperatingSet, of_ship
from .plant import Disturbance, Plant, plant_of, usual_disturbance
from .theorem import VERSION, Certificate, assess, best_gain, flow_of, gains_that_do, lipschitz, self_regressor, usual_gain
from .tube import Tube

__all__ = [
    "Certificate", "Confined", "Disturbance", "OperatingSet", "Plant", "Tube", "best_gain", "certify", "flow_of", "gains_that_do", "kept", "lipschitz",
    "of_ship", "plant_of", "self_regressor", "usual_disturbance", "usual_gain",
]  # fmt: skip


def certify(
    model: Model,
    K: Sequence[float],
    h: float,
    delay_samples: int = 1,
    noise: Sequence[float] = (0.15, 0.15, 0.0005),
    disturbance: Sequence[float] | Disturbance | None = None,
    operating_set: OperatingSet | None = None,
    heading_noise: float = 0.0,
    aligned: bool = True,
    extra_growth: Matrix | None = None,
) -> Certificate:
    """Work out the certificate of an observer with gain K [1/s] and period h [s]; takes about half a second.

    noise: bounds of |y - nu| [m/s, m/s, rad/s]; heading_noise [rad]; disturbance: see Disturbance (default: `usual_disturbance`).
    delay_samples: the greatest age of a used measurement, in samples, a value held between sensor updates included.
    aligned: it is compared with the estimate of its own time; if with the present one, the ship's way in between counts as noise.
    extra_growth: `self_regressor(...)` when the network is fed with the estimate instead of measurements.
    """
    _check(K, h, delay_samples, noise)
    operating_set = operating_set or of_ship(model)
    d = disturbance if isinstance(disturbance, Disturbance) else Disturbance(tuple(disturbance)) if disturbance else usual_disturbance(model)  # type: ignore[arg-type]
    plant = plant_of(model, operating_set, h)
    made = assess(plant, tuple(K), delay_samples, tuple(noise), d, heading_noise, aligned, extra_growth)  # type: ignore[arg-type]
    return replace(made, ship=model.ship.name)


def kept(path: str | os.PathLike[str], model: Model, K: Sequence[float], h: float, **settings: Any) -> Certificate:
    """The certificate from its file if it is of this ship, K and settings; else worked out and, where possible, written there."""
    mark = _mark(model, K, h, settings)
    try:
        found = Certificate.from_json(Path(path).read_text(encoding="utf-8"))
        if found.fingerprint == mark:
            return found
    except (OSError, ValueError, KeyError, TypeError):
        pass
    made = replace(certify(model, K, h, **settings), fingerprint=mark)
    try:
        aside = Path(f"{path}.part")
        aside.write_text(made.to_json(), encoding="utf-8")
        aside.replace(path)
    except OSError:
        pass  # a folder one may not write to costs half a second at each start, nothing else
    return made


def _mark(model: Model, *settings: Any) -> str:
    """What the certificate depends on, as a hash: the ship's numbers, her effects, the settings and the theorem's version."""
    ship = replace(model.ship, notes={})
    return hashlib.sha256(repr((VERSION, ship, model.effects, *settings)).encode()).hexdigest()[:16]


def _check(K: Sequence[float], h: float, delay_samples: int, noise: Sequence[float]) -> None:
    """Refuse what is no gain, period, delay or noise."""
    numbers = (*K, h, delay_samples, *noise)
    if len(K) != 3 or len(noise) != 3 or not all(0.0 <= x < float("inf") for x in numbers) or not h > 0.0 or not all(k > 0.0 for k in K):
        raise SettingsError(
            f"stabilizer: K = {tuple(K)}, period {h} s, delay {delay_samples}, noise {tuple(noise)}: three positive gains, a positive "
            "period, and no negative number are needed. Correct the configuration."
        )
