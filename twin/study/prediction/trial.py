"""Sea trials of a model: self-propulsion, turning circle, zigzag, speed kept; the figures shipyards and IMO
speak of.

IMO MSC.137(76): advance <= 4.5 L, tactical diameter <= 5 L, first overshoots of the 10/10 zigzag <= 10-20 deg
and of the 20/20 <= 25 deg."""

from collections.abc import Callable
from dataclasses import dataclass
from math import degrees, hypot, pi, radians
from typing import Any

from twin.physics import core
from twin.physics.actuators.helm import actuator_orders
from twin.physics.model import Eta_nu, Model
from twin.physics.state import WEATHER, Situation

Steer = Callable[[Eta_nu], float]  # state -> ordered rudder [rad]


@dataclass(frozen=True)
class Circle:
    """A turning circle: advance, transfer and tactical diameter in lengths from the order, and what is left
    of the speed."""

    advance: float
    transfer: float
    tactical_diameter: float
    speed_left: float


def shaft_speed(model: Model, speed: float) -> float:
    """Propeller rate [1/s] at which thrust and resistance balance at this speed [m/s], going straight in
    still water."""
    c = model.c
    if model.ship.actuators:
        return _power(model, speed)
    drag = -core.damping(speed, 0.0, 0.0, c)[0]
    a, b = c.T_nn, c.T_nu * c.wake_share * speed  # (1-t) (a n^2 + b n) = drag
    need = drag / c.thrust_share
    return (-b + (b * b + 4.0 * a * need) ** 0.5) / (2.0 * a)


def controls(model: Model, delta: float, n: float) -> dict[str, Any]:
    """Rudder and shaft, or what actuators are told for as much, as fields of Situation."""
    ship = model.ship
    return {"orders": actuator_orders(ship, delta, n)} if ship.actuators else {"delta": delta, "n": n}


def _power(model: Model, speed: float) -> float:
    """The share of full power at which the ship neither gains nor loses way without wind and sea; all where
    that is too little."""
    calm, low, high = model.without_inputs(set(WEATHER))[0], 0.0, 1.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        gains = calm.nu_dot(Situation(u=speed, **controls(calm, 0.0, middle))).u > 0.0
        low, high = (low, middle) if gains else (middle, high)
    return 0.5 * (low + high)


def sail(
    model: Model, steer: Steer, n: float, seconds: float, u: float, rate: float | None = None
) -> list[tuple[float, Eta_nu]]:
    """The voyage [(t, state)] under a helmsman, in steps of 1/100 L/U, from straight ahead at u [m/s].

    `rate`: fastest rudder [rad/s]; by default 65 deg in 0.7 L/U_0 (28 s for a large tanker, SOLAS).
    """
    time = model.ship.L_pp / model.ship.U_0
    h = time / 100.0
    most = h * (radians(65.0) / (0.7 * time) if rate is None else rate)
    state: Eta_nu = (0.0, 0.0, 0.0, u, 0.0, 0.0)
    delta, log = 0.0, [(0.0, state)]
    for i in range(int(seconds / h)):
        order = steer(state)
        delta += max(-most, min(most, order - delta))
        state = model.step(state, Situation(**controls(model, delta, n)), h)
        log.append(((i + 1) * h, state))
    return log


def turning_circle(model: Model, delta: float, rate: float | None = None) -> Circle:
    """Hard over from straight ahead at U_0; delta [rad], positive to starboard."""
    U, L = model.ship.U_0, model.ship.L_pp
    side = 1.0 if delta > 0 else -1.0
    for lengths in (14.0, 60.0):  # a lazy ship needs more room
        log = sail(model, lambda _: delta, shaft_speed(model, U), lengths * L / U, U, rate)
        if side * log[-1][1][2] >= pi:
            break
    quarter = _at_heading(log, 0.5 * pi, side)
    half = _at_heading(log, pi, side)
    _, end = log[-1]
    return Circle(quarter[0] / L, side * quarter[1] / L, side * half[1] / L, hypot(end[3], end[4]) / U)


def zigzag(model: Model, delta: float, psi: float, rate: float | None = None) -> list[float]:
    """Overshoot angles [deg], first to last, of a zigzag of 30 lengths from U_0 that puts the rudder to
    delta [rad] whenever the heading passes psi [rad]."""
    U, L = model.ship.U_0, model.ship.L_pp
    helm = {"side": 1.0 if delta > 0 else -1.0}

    def steer(state: Eta_nu) -> float:
        if helm["side"] * state[2] > abs(psi):
            helm["side"] = -helm["side"]
        return helm["side"] * abs(delta)

    log = sail(model, steer, shaft_speed(model, U), 30.0 * L / U, U, rate)
    headings = [state[2] for _, state in log]
    turns = [
        b
        for a, b, c in zip(headings, headings[1:], headings[2:], strict=False)
        if (b - a) * (c - b) < 0 and abs(b) > abs(psi)
    ]
    return [degrees(abs(peak) - abs(psi)) for peak in turns]


def _at_heading(log: list[tuple[float, Eta_nu]], psi: float, side: float) -> Eta_nu:
    """State when the heading has changed by psi; the last one if it never does."""
    return next((state for _, state in log if side * state[2] >= psi), log[-1][1])


def straight_line_stability(model: Model) -> float:
    """Clarke's criterion C' = Y_v (N_r - m x_G u) - (Y_r - m u) N_v, in prime form: > 0 goes straight by
    itself."""
    c, d, ship = model.c, model.loaded.derivatives, model.loaded
    mass = 0.5 * ship.rho * ship.L_pp**2 * ship.T
    Y_v, N_v = d.Y_uv, d.N_uv + d.Y_vdot - d.X_udot
    Y_r = d.Y_ur - (c.m - c.X_udot) / mass
    N_r = d.N_ur - (c.mx_G - c.Y_rdot) / (mass * ship.L_pp)
    return float(Y_v * N_r - Y_r * N_v)
