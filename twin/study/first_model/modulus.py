"""Published manoeuvring polynomials (MMG: v, r, vvv, vvr ...) and inflows turned into the core's forms (|v|
v, |r| v ...).

Least squares over the range in which tank tests are made and ships turn: drift to 25 deg, |r'| to 0.9,
weighted to where a turning ship is (bow in, v' near -0.4 r') and to small angles, and pulled toward the
published linear derivatives, on which straight-line stability rests. Forces at U = 1, in prime form."""

from collections.abc import Callable, Mapping

import numpy as np

DRIFT, TURN = np.radians(25.0), 0.9  # range of the fit
WORKING_J = np.linspace(0.05, 0.8, 40)  # advance ratios at which propellers work
PULL = 0.3  # weight of a published linear derivative against all the force it stands for
Terms = dict[str, Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]]

X_TERMS: Terms = {"X_vv": lambda u, v, r: v * v, "X_vr": lambda u, v, r: v * r, "X_rr": lambda u, v, r: r * r}
Y_TERMS: Terms = {
    "Y_uv": lambda u, v, r: u * v,
    "Y_ur": lambda u, v, r: u * r,
    "Y_vv": lambda u, v, r: abs(v) * v,
    "Y_vr": lambda u, v, r: abs(v) * r,
    "Y_rv": lambda u, v, r: abs(r) * v,
    "Y_rr": lambda u, v, r: abs(r) * r,
}
N_TERMS: Terms = {name.replace("Y", "N"): term for name, term in Y_TERMS.items()}


def modulus_form(published: Mapping[str, float], m_x: float, m_y: float) -> dict[str, float]:
    """The core's hull derivatives from R0 and X_vv ... N_rrr, whose N_v holds the Munk moment -(m_y - m_x)
    that C(nu) has already."""
    u, v, r, weight = _range()
    get = published.get
    X = (
        get("X_vv", 0.0) * v**2
        + get("X_vr", 0.0) * v * r
        + get("X_rr", 0.0) * r**2
        + get("X_vvvv", 0.0) * v**4
    )
    X = X - published["R0"] * (1.0 - u * u)  # MMG's resistance goes with U^2, the core's with u^2
    Y, N = (_cubic(published, axis, v, r) for axis in "YN")
    N = N + (m_y - m_x) * u * v
    linear = {
        "Y_uv": get("Y_v", 0.0),
        "Y_ur": get("Y_r", 0.0),
        "N_uv": get("N_v", 0.0) + m_y - m_x,
        "N_ur": get("N_r", 0.0),
    }
    out = {"X_uu": -published["R0"]}
    for terms, force in ((X_TERMS, X), (Y_TERMS, Y), (N_TERMS, N)):
        columns = np.stack([term(u, v, r) for term in terms.values()], 1)
        out |= _least_squares(
            list(terms), columns * np.sqrt(weight)[:, None], force * np.sqrt(weight), linear
        )
    return out


def error_share(
    published: Mapping[str, float], derivatives: Mapping[str, float], m_x: float, m_y: float
) -> tuple[float, float]:
    """Weighted rms error of the modulus form over the polynomial's rms, in sway and in yaw."""
    u, v, r, weight = _range()
    shares = []
    for axis, terms, munk in (("Y", Y_TERMS, 0.0), ("N", N_TERMS, m_y - m_x)):
        want = _cubic(published, axis, v, r)
        got = sum(derivatives[name] * term(u, v, r) for name, term in terms.items()) - munk * u * v
        shares.append(float(np.sqrt((weight * (got - want) ** 2).sum() / (weight * want**2).sum())))
    return shares[0], shares[1]


def slipstream(K_T0: float, K_T1: float, epsilon: float, kappa: float, eta: float) -> tuple[float, float]:
    """epsilon and kappa for which eps^2 (J^2 + kappa 8 K_T/pi) is nearest to the MMG inflow at the rudder
    [YY15 eq. (26)], at the advance ratios J of WORKING_J.

    `eta`: propeller diameter over rudder height, the part of the rudder that the slipstream covers."""
    J = WORKING_J[0.95 * K_T0 + K_T1 * WORKING_J > 0.0]
    loading = 8.0 / np.pi * (K_T0 + K_T1 * J)
    jet = np.sqrt(J**2 + loading)
    q = epsilon**2 * (eta * (J + kappa * (jet - J)) ** 2 + (1.0 - eta) * J**2)
    a, b = np.linalg.lstsq(np.stack([J**2, loading], 1), q, rcond=None)[0]
    return float(a**0.5), float(b / a)


def _cubic(p: Mapping[str, float], axis: str, v: np.ndarray, r: np.ndarray) -> np.ndarray:
    powers = {
        "v": v,
        "r": r,
        "vvv": v**3,
        "vvr": v * v * r,
        "vrr": v * r * r,
        "rrr": r**3,
        "vv": abs(v) * v,
        "rr": abs(r) * r,
    }
    return sum(p.get(f"{axis}_{name}", 0.0) * term for name, term in powers.items())  # type: ignore[return-value]


def _range() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    beta, r = (a.ravel() for a in np.meshgrid(np.linspace(-DRIFT, DRIFT, 41), np.linspace(-TURN, TURN, 41)))
    u, v = np.cos(beta), -np.sin(beta)
    turning = np.exp(-0.5 * ((v + 0.4 * r) / 0.15) ** 2) * np.exp(-0.5 * (r / 0.6) ** 2)
    small = np.exp(-0.5 * (v / 0.06) ** 2 - 0.5 * (r / 0.15) ** 2)
    return u, v, r, turning + 3.0 * small + 0.02


def _least_squares(
    names: list[str], columns: np.ndarray, force: np.ndarray, linear: Mapping[str, float]
) -> dict[str, float]:
    """Least squares with a pull of the linear terms toward their published values."""
    pull = np.diag(
        [
            PULL * np.linalg.norm(column) if name in linear else 0.0
            for name, column in zip(names, columns.T, strict=True)
        ]
    )
    toward = pull @ np.array([linear.get(name, 0.0) for name in names])
    found, *_ = np.linalg.lstsq(np.vstack([columns, pull]), np.concatenate([force, toward]), rcond=None)
    return {name: float(f"{value:.4g}") for name, value in zip(names, found, strict=True)}
