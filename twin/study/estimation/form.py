"""What the core leaves out of calm water: terms of higher order, and of the heel, each a column of its own
and no part of any model.

A hull in Norrbin's modulus form is a good one to predict with, and not the truth. What it leaves out has the
same sign all through a voyage, so that a diagnosis would sooner or later take it for an effect. Reference
voyages tell how much of each term this ship has; what they leave open is allowed for when another voyage is
judged.

Forms: cubic hull and its scale, Yasukawa & Yoshimura (2015); wake that thins with drift, ibid.; heel, Son &
    Nomoto (1981).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from twin.physics import core
from twin.physics.actuators.kinds import push
from twin.physics.model import Model
from twin.study.estimation.respond import steered
from twin.study.track.track import Track

SLOWEST = 0.01  # of U_0: a speed to divide by, however slow the ship
SPEED_SPACING = 0.2  # of U_0: of the speeds about which resistance may be otherwise
ABOUT = (0.2, 0.4, 0.6, 0.8, 1.0, 1.2)
ROLLED = 0.15  # of L/U_0: window over which the measured heel is smoothed before its rates are taken


@dataclass(frozen=True)
class Along:
    """One track in prime units: what the terms are made of, each (N,)."""

    v: np.ndarray  # v/U
    r: np.ndarray  # r L/U
    phi: np.ndarray  # rad; zero where heel was not measured
    p: np.ndarray  # its rate, by L/U_0
    p_dot: np.ndarray
    ahead: np.ndarray  # u/U_0


Term = Callable[[Along], np.ndarray]


def _about(speed: float) -> Term:
    """Resistance about one speed, falling to none at the next: waves, wake and friction give a curve with
    humps that no square of the speed has."""
    return lambda a: np.sign(a.ahead) * np.maximum(0.0, 1.0 - np.abs(np.abs(a.ahead) - speed) / SPEED_SPACING)


HULL: dict[str, tuple[str, float, Term]] = {  # name: axis, prior width, times 1/2 rho L T U^2 (and L)
    **{f"X_at_{speed:g}_U": ("X", 0.005, _about(speed)) for speed in ABOUT},
    "X_vvvv": ("X", 0.5, lambda a: a.v**4),
    "Y_vvv": ("Y", 0.8, lambda a: a.v**3),
    "Y_vvr": ("Y", 0.4, lambda a: a.v**2 * a.r),
    "Y_vrr": ("Y", 0.4, lambda a: a.v * a.r**2),
    "Y_rrr": ("Y", 0.05, lambda a: a.r**3),
    "N_vvv": ("N", 0.15, lambda a: a.v**3),
    "N_vvr": ("N", 0.3, lambda a: a.v**2 * a.r),
    "N_vrr": ("N", 0.15, lambda a: a.v * a.r**2),
    "N_rrr": ("N", 0.03, lambda a: a.r**3),
    "Y_phi": ("Y", 0.05, lambda a: a.phi),
    "Y_p": ("Y", 0.05, lambda a: a.p),
    "Y_pdot": ("Y", 0.05, lambda a: a.p_dot),
    "N_phi": ("N", 0.02, lambda a: a.phi),
    "N_p": ("N", 0.02, lambda a: a.p),
    "N_pdot": ("N", 0.02, lambda a: a.p_dot),
}
RUDDER: dict[str, tuple[float, Term]] = {  # name: prior width, times the rudder's force by its angle alone
    "q_vv": (1.0, lambda a: a.v**2),
    "q_rr": (1.0, lambda a: a.r**2),
}
TERMS = {name: width for name, (_, width, _) in HULL.items()} | {
    name: width for name, (width, _) in RUDDER.items()
}


def accelerations(track: Track, model: Model) -> dict[str, np.ndarray]:
    """(N, 3) [m/s2, m/s2, rad/s2] of one unit of each term."""
    ship, a, zero = model.ship, _along(track, model), np.zeros(len(track))
    usual = 0.5 * ship.rho * ship.L_pp * ship.T * _speed(track, model) ** 2
    tau: dict[str, core.Tau] = {}
    for name, (axis, _, term) in HULL.items():
        force = usual * term(a)
        tau[name] = {
            "X": (force, zero, zero),
            "Y": (zero, force, zero),
            "N": (zero, zero, force * ship.L_pp),
        }[axis]
    X, Y, N = _rudders(track, model)
    for name, (_, term) in RUDDER.items():
        tau[name] = X * term(a), Y * term(a), N * term(a)
    return {
        name: np.column_stack([np.broadcast_to(x, zero.shape) for x in core.accelerations(*t, model.c)])
        for name, t in tau.items()
    }


def _rudders(track: Track, model: Model) -> core.Tau:
    """What the ship's rudder gives by its angle alone, or the rudders of all its actuators together."""
    u, zero, now = _through_water(track, model)[0], np.zeros(len(track)), steered(track, model)
    if not model.ship.actuators:
        return core.rudder(u, zero, zero, now["delta"], core.thrust(u, track.n, model.c), model.c)
    X, Y, N = zero, zero, zero
    for a in model.loaded.actuators:
        if a.A_R is not None and "angle" in a.keys:
            c = a.coefficients(model.loaded)
            T = push(a, now["orders"], c.wake_share * u, model.loaded)
            x, y, n = core.rudder(u, zero, zero, now["orders"][a.keys["angle"]] + a.trim, T, c)
            X, Y, N = X + x, Y + y, N + n - a.y * x
    return X, Y, N


def _through_water(track: Track, model: Model) -> tuple[np.ndarray, np.ndarray]:
    """(u_r, v_r) along the track, in the streams that the model has [m/s]."""
    u, v = track.state[:, 3], track.state[:, 4]
    if not model.flows:
        return u, v
    water = model.water(track.situation())
    return u - water.u, v - water.v


def _speed(track: Track, model: Model) -> np.ndarray:
    u, v = _through_water(track, model)
    return np.sqrt(u**2 + v**2 + (SLOWEST * model.ship.U_0) ** 2)


def _along(track: Track, model: Model) -> Along:
    U, time = _speed(track, model), float(model.ship.scale("time"))
    u, v = _through_water(track, model)
    phi = (
        _smooth(track.weather["phi"], ROLLED * time / track.h)
        if "phi" in track.weather
        else np.zeros(len(track))
    )
    p = np.gradient(phi, track.h) * time
    r = track.state[:, 5] * model.ship.L_pp / U
    return Along(v / U, r, phi, p, np.gradient(p, track.h) * time, u / model.ship.U_0)


def _smooth(values: np.ndarray, steps: float) -> np.ndarray:
    """Under a Hann window about so many steps wide at half its height."""
    window = np.hanning(2 * max(1, round(steps)) + 1)
    return np.convolve(values, window, "same") / np.convolve(np.ones(values.size), window, "same")
