"""A peer for scale: pysindy's sparse regression of the same residual accelerations on terms that an engineer
would offer it.

It is asked less than the twin is: whether its largest term belongs to the cause. It gives no probability, no
newtons, cannot say that nothing is missing, and sees no fault of an instrument."""

import time
import warnings
from typing import Any

import numpy as np

from twin.physics.model import Model
from twin.study.estimation.respond import respond
from twin.study.track.track import Track

TERMS = (
    "v",
    "v|v|",
    "r",
    "r|r|",
    "u",
    "u u",
    "rudder u u",
    "n n",
    "n u",
    "cos_psi",
    "sin_psi",
    "wind_ahead",
    "wind_aside",
)
THRESHOLD = 0.1  # of a standard deviation of the residual, for a term of standard size

# Terms that point at the cause.
POINTS_AT: dict[str, set[str]] = {
    "Wind": {"wind_ahead", "wind_aside"},
    "CrossFlowDrag": {"v", "v|v|", "r", "r|r|"},
    "HullFouling": {"u", "u u"},
    "PropellerWear": {"n n", "n u"},
    "RudderWear": {"rudder u u"},
    "RudderOffset": {"1", "u u"},
    "TowForce": {"1"},
    "ExternalForce": {"cos_psi", "sin_psi"},
    "Current": {"cos_psi", "sin_psi"},
    "SteeringLag": {"rudder u u"},
}


def peer(t: Track, model: Model, effect: str) -> dict[str, Any] | None:
    """Seconds, the largest term, and whether it points at the cause; None without pysindy, or where no term
    could."""
    try:
        import pysindy
    except ImportError:
        return None
    if effect not in POINTS_AT:
        return None
    terms, residual = _terms(t, model), _residual(t, model)
    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = pysindy.SINDy(
            optimizer=pysindy.STLSQ(threshold=THRESHOLD), feature_library=pysindy.PolynomialLibrary(degree=1)
        )
        found.fit(terms[:, :3], t=t.h, x_dot=residual, u=terms[:, 3:], feature_names=list(TERMS))
    term = _largest(found)
    seconds = time.perf_counter() - begin
    return {"seconds": seconds, "term": term, "right": term in POINTS_AT[effect]}


def _residual(t: Track, model: Model) -> np.ndarray:
    """(N, 3) measured accelerations less the model's, each in standard deviations of itself."""
    off = np.gradient(t.state[:, 3:6], t.h, axis=0) - respond(t, model)[0]
    return off / off.std(0)


def _terms(t: Track, model: Model) -> np.ndarray:
    """(N, 13) the columns of TERMS, each with a root mean square of one."""
    u, v, r = (t.state[:, i] for i in (3, 4, 5))
    psi, n = t.state[:, 2], t.n
    speed, to = t.weather.get("wind_speed", 0.0 * psi), t.weather.get("wind_to", 0.0 * psi)
    ahead, aside = speed * np.cos(to - psi) - u, speed * np.sin(to - psi) - v
    wind = np.hypot(ahead, aside)
    columns = [
        v,
        v * abs(v),
        r,
        r * abs(r),
        u,
        u * u,
        t.delta * u * u,
        n * n,
        n * u,
        np.cos(psi),
        np.sin(psi),
        wind * ahead,
        wind * aside,
    ]
    terms = np.column_stack(columns)
    return np.asarray(terms / np.maximum(np.sqrt((terms**2).mean(0)), 1e-12))


def _largest(found: Any) -> str:
    """The term with the greatest coefficient in any of the three equations."""
    size = np.abs(found.coefficients())
    names: list[str] = found.get_feature_names()
    return names[int(np.argmax(size.max(0)))]
