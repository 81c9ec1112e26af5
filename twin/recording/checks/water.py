"""The speed log against the speed over ground: they differ by the current, not by a factor.

u_w = k (u - c_north cos psi - c_east sin psi)
"""

import numpy as np

from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.voyage_view import VoyageView, fit

FASTEST_CURRENT_MPS = 4.0
ALIKE_S = 30.0  # neighbours within this time carry the same wave and the same gust
SCALES = ((1.0 / (1852.0 / 3600.0), "kn"), (3.6, "km/h"), (1.0 / 0.3048, "ft/s"))


def speed_log(view: VoyageView) -> Check:
    """The factor k, where turning or changing speed lets it be told from the current."""
    name = "speed_log"
    water = view.si("surge_velocity_through_water_mps")
    if not np.isfinite(water).any():
        return cannot_tell(
            name, "no speed through water was recorded, so a current cannot be told from a slow ship."
        )
    if view.derived("surge_velocity_mps") and not view.voyage.has("north_m"):
        return cannot_tell(name, "no speed over ground was recorded.")
    ground = view.velocity.real
    k, current, sure = factor(ground, water, view.psi, view.step_s, view.derived("surge_velocity_mps"))
    saw = f"the log shows {k:.3f} times the speed over ground, beside a current of {current:.2f} m/s"
    if not sure:
        k = float(np.nanmedian(water) / np.nanmedian(ground)) if np.nanmedian(ground) else 1.0
        saw = f"the log shows {k:.3f} times the speed over ground"
    unit = next((u for s, u in SCALES if abs(k / s - 1.0) < 0.12), None)
    apart = float(np.nanmedian(np.abs(water - ground)))
    if sure and k < -0.5:
        return wrong(name, f"{saw}: it is positive astern. In the map: sign = -1 for it.")
    if unit and (sure or apart > FASTEST_CURRENT_MPS):
        return wrong(name, f'{saw}: it is believed to be in {unit}. In the map: unit = "{unit}" for it.')
    if apart > FASTEST_CURRENT_MPS or (sure and abs(k - 1.0) > 0.3):
        return doubtful(
            name, f"{saw}, {apart:.2f} m/s apart: look at the log's unit, calibration and fouling."
        )
    doubt = f" In {unit}, or a current? A turn, or another speed, would tell." if unit else ""
    return good(name, f"{saw}.{doubt}")


def factor(
    ground: np.ndarray, water: np.ndarray, psi: np.ndarray, step_s: float, rough: bool = False
) -> tuple[float, float, bool]:
    """(k, size of the current [m/s], whether k stands by itself). A speed over ground that is the slope of
    positions scatters more than a log (`rough`), and what scatters must not be the cause in a fit: it
    would come out too small, and a current would stand in for the rest. `ground` and `water` (N,) ahead
    [m/s], psi (N,) [rad]."""
    if rough:
        inverse, north, east, sure = _fitted(water, ground, psi, step_s)
        return 1.0 / (inverse or np.nan), float(np.hypot(north, east)), sure
    k, north, east, sure = _fitted(ground, water, psi, step_s)
    return k, float(np.hypot(north, east) / max(abs(k), 1e-9)), sure


def _fitted(
    cause: np.ndarray, shown: np.ndarray, psi: np.ndarray, step_s: float
) -> tuple[float, float, float, bool]:
    """shown = x cause - a cos psi - b sin psi: (x, a, b, whether x stands by itself)."""
    x, error, _ = fit([cause, -np.cos(psi), -np.sin(psi)], shown)
    shape = np.stack([cause, np.cos(psi), np.sin(psi)], axis=1)
    shape = shape[np.isfinite(shape).all(axis=1)]
    shape = shape / np.maximum(np.sqrt(np.mean(shape**2, axis=0)), 1e-9)
    alone = shape.shape[0] > 10 and np.linalg.svd(shape, compute_uv=False)[-1] > 0.1 * np.sqrt(shape.shape[0])
    spread = error[0] * np.sqrt(max(ALIKE_S / step_s, 1.0))
    sure = bool(alone and spread < 0.1 * max(abs(x[0]), 0.1))
    return float(x[0]), float(x[1]), float(x[2]), sure
