"""A voyage sailed: equations of motion through water that moves, with all that acts on the ship.

    (m + m_x) u' - (m + m_y) v r - x_G m r^2 = X
    (m + m_y) v' + (m + m_x) u r + x_G m r'  = Y
    (I_z + x_G^2 m + J_z) r' + x_G m (v' + u r) = N

(Yasukawa & Yoshimura 2015, eq. 4) for the motion through water; second-order Adams-Bashforth."""

from collections import deque
from collections.abc import Sequence
from math import cos, exp, hypot, pi, sin
from typing import NamedTuple

import numpy as np

from bench.fleet.fleet_legs import FleetHelmsman, FleetLeg
from bench.fleet.fleet_weather import FleetWeather, Surroundings
from bench.fleet.hidden_causes import Flaws
from bench.fleet.random_particulars import RHO, Particulars
from bench.fleet.random_ship import RandomShip

HARD = np.radians(35)
KEPT = (
    "t",
    "x",
    "y",
    "psi",
    "u",
    "v",
    "r",
    "u_r",
    "v_r",
    "heel",
    "rudder",
    "order",
    "n",
    "wind",
    "wind_from",
)
FINEST = 0.5  # [s] longest step
ALL_VOYAGE = (0.0, 1.0)


def step_of(ship: RandomShip) -> float:
    """A step that the quickest motion needs, a whole part of a second [s]."""
    return 1.0 / np.ceil(1.0 / min(FINEST, ship.p.unit_s / 40))


def cross_flow_strips(f: Flaws, length_m: float) -> list[tuple[float, float]]:
    """Where ten strips of a hull with cross-flow drag stand [m before midship], and the share of the lateral
    area times the drag coefficient of each; none where nothing is wrong."""
    places = np.arange(-0.45, 0.5, 0.1) if f.cross_flow else ()
    return [(float(x) * length_m, 0.1 * f.cross_flow * (0.3 + 0.7 * (2 * float(x)) ** 2)) for x in places]


def sail(
    ship: RandomShip,
    legs: list[FleetLeg],
    weather: FleetWeather,
    duration_s: float,
    seed: int,
    flaws: Flaws | None = None,
    heading: float | None = None,
    acting: tuple[float, float] = ALL_VOYAGE,
) -> dict[str, np.ndarray]:
    """The truth of a voyage, a row a step. `acting`: from which to which share of it forces that are wrong
    act."""
    wrong, healthy, p, d, hull = flaws or Flaws(), Flaws(), ship.p, ship.drive, ship.hull
    f = wrong
    rng = np.random.default_rng([seed, 11])
    dt = step_of(ship)
    steps = int(duration_s / dt)
    around = Surroundings(weather, p, ship.windage, rng, dt, steps)
    psi = float(rng.uniform(0, 2 * pi)) if heading is None else heading
    man = FleetHelmsman(legs, p.unit_s, psi, rng)
    mass, x_G = p.mass * (1 + f.mass), p.x_G + f.x_G
    m_x, m_y, J = hull.inertia()
    deep = shallow(f.shallow)
    m_y, J = m_y * deep, J * deep
    deeper = 1 + 0.9 * f.mass
    I = p.mass * (p.k_zz * p.L) ** 2 * (1 + 1.02 * f.mass) + J
    x = y = v = r = heel = heel_rate = blade = gear = 0.0
    u, n, old, pool, pool_rate, stuck = p.U0, d.n0, None, 0.0, 0.0, -1.0
    late: deque[float] = deque([0.0] * (int(f.lag_s / dt) + 1))
    w_roll = (9.81 * ship.GM * (1 - f.soft)) ** 0.5 / (0.4 * p.B)
    strips = cross_flow_strips(f, p.L)
    hull.start()
    out = np.empty((steps, len(KEPT)))
    for i in range(steps):
        t = i * dt
        f = wrong if acting[0] <= i / steps < acting[1] else healthy
        if f.flood:
            x_G = p.x_G + f.x_G + f.flood * t
        c, s = cos(psi), sin(psi)
        order, share = man.order(t, psi, r, HARD)
        late.append(order)
        want = late.popleft()
        if f.stuck_s and stuck < t and rng.random() < dt / (12 * p.unit_s):
            stuck = t + f.stuck_s
        if abs(want - gear) > d.dead and stuck < t:
            move = max(-d.rate, min(d.rate, (want - gear) / d.gear_s)) * (1 - f.slow)
            gear += dt * move
        blade = max(gear - f.backlash, min(gear + f.backlash, blade)) if f.backlash else gear
        delta = blade + f.rudder_offset * (1 - 0.2 * abs(blade))
        n += dt * (d.turned(share * d.n0, u) - n) / d.engine_s
        n_true = n * (1 + f.hunting * sin(2 * pi * t / (0.7 * p.unit_s))) if f.hunting else n
        c_n, c_e = around.stream_n[i], around.stream_e[i]
        u_c, v_c = c_n * c + c_e * s, c_e * c - c_n * s
        speed, drift = max(hypot(u, v), 1e-3), -v / max(abs(u), 0.05 * p.U0)
        X, Y, N = hull.force(u, v, r, heel, dt)
        X, Y, N = X * deeper**0.5, Y * deeper, N * deeper
        if f.shallow:
            X, Y, N = X * (1 + 0.8 * f.shallow**2), Y * deep, N * (1 + 0.7 * (deep - 1))
        T, u_in = d.thrust(n_true, u, drift)
        T *= 1 - f.prop_wear * (1.15 - 0.3 * max(u_in, 0) / max(abs(n) * p.D_P, 0.1))
        if f.ventilation and sin(2 * pi * t / (1.3 * p.unit_s)) > 0.6:
            T *= 1 - f.ventilation
        F = d.rudder(delta, u_in, v, r, T, u)
        F *= 1 - f.rudder_wear * (1 - 0.3 * abs(delta))
        side = F * cos(delta)
        X += (1 - d.t) * T - 0.75 * F * sin(delta)
        Y -= (1 + d.a_H) * side
        N -= (d.x_R - 0.45 * d.a_H) * p.L * side
        if f.walk:
            q = f.walk * T * (1.3 - 0.4 * u / p.U0)
            Y, N = Y + q, N - 0.48 * p.L * q
        if ship.windage is not None and (weather.wind or weather.squall):
            a = around.air(i, u + u_c, v + v_c, psi)
            X, Y, N = X + a[0], Y + a[1], N + a[2]
        if around.waves:
            a = around.sea(t, x, y, psi, mass)
            X, Y, N = X + a[0], Y + a[1], N + a[2]
        X, Y, N = flawed(f, p, (X, Y, N), Moving(t, u, v, r, speed, c, s), weather.bank, strips)
        side_pull = (m_y + mass) * u * r
        heel_rate += dt * (
            -(w_roll**2) * heel
            - 0.12 * w_roll * heel_rate
            + 0.25 * (side_pull / mass) * p.T / (0.4 * p.B) ** 2
        )
        heel += dt * heel_rate
        if f.heel_N:
            q = 0.5 * RHO * p.L * p.T * speed * speed * heel
            Y, N = Y + f.heel_Y * q * (1 + abs(heel)), N + f.heel_N * q * p.L
        if f.slosh:
            pool_rate += dt * (-(f.slosh_w**2) * pool - 0.06 * f.slosh_w * pool_rate - u * r)
            pool += dt * pool_rate
            q = f.slosh * mass * f.slosh_w**2 * pool
            Y, N = Y + q, N + 0.3 * p.L * q
        X += (mass + m_y) * v * r + x_G * mass * r * r
        Y -= (mass + m_x) * u * r
        N -= x_G * mass * u * r
        sway, both, yaw = mass + m_y, x_G * mass, I + x_G * x_G * mass
        det = sway * yaw - both * both
        slope = (X / (mass + m_x), (yaw * Y - both * N) / det, (sway * N - both * Y) / det)
        out[i] = (
            t,
            x,
            y,
            psi,
            u + u_c,
            v + v_c,
            r,
            u,
            v,
            heel,
            gear,
            order,
            n,
            around.wind[i],
            around.wind_from[i],
        )
        g = slope if old is None else tuple(1.5 * k - 0.5 * o for k, o in zip(slope, old, strict=True))
        old = slope
        # by the motion in the middle of the step: by that at its beginning place and heading would be late
        ahead, aside, turn = u + 0.5 * dt * g[0], v + 0.5 * dt * g[1], r + 0.5 * dt * g[2]
        c, s = cos(psi + 0.5 * dt * r), sin(psi + 0.5 * dt * r)
        x, y = x + dt * (ahead * c - aside * s + c_n), y + dt * (ahead * s + aside * c + c_e)
        psi += dt * turn
        u, v, r = u + dt * g[0], v + dt * g[1], r + dt * g[2]
        if not abs(r) < 10 or not abs(u) < 5 * p.U0:
            out[i:] = np.nan
            break
    return dict(zip(KEPT, out.T, strict=True))


def shallow(share: float) -> float:
    """By how much added mass and side force grow where the draught is this share of the depth."""
    return 1.0 + 0.9 * share**2 / (1.05 - share) ** 0.7 if share else 1.0


class Moving(NamedTuple):
    """How the ship moves at one moment."""

    t: float  # [s]
    u: float  # through water [m/s]
    v: float
    r: float  # [rad/s]
    speed: float  # through water [m/s]
    c: float  # cosine and sine of the heading
    s: float


def flawed(
    f: Flaws,
    p: Particulars,
    force: tuple[float, float, float],
    m: Moving,
    bank_m: float,
    strips: Sequence[tuple[float, float]],
) -> tuple[float, float, float]:
    """X [N], Y [N], N [N m] with the forces of what is hidden; `bank_m`: to starboard, 0 for none; `strips`:
    where along the ship, and the drag there."""
    X, Y, N = force
    if f.fouling:
        X -= f.fouling * (abs(m.u) / p.U0) ** f.fouling_power
    for x, k in strips:
        w = m.v + x * m.r
        q = 0.5 * RHO * p.L * p.T * k * abs(w) * w
        Y, N = Y - q, N - x * q
    if f.tow[0]:
        k = 1 + 0.3 * sin(2 * pi * m.t / f.tow_s)
        X, Y, N = X + k * f.tow[0], Y + k * f.tow[1], N + k * f.tow[2]
    if f.pull[0]:
        k = 1 + 0.15 * sin(2 * pi * m.t / (4 * p.unit_s))
        X, Y = X + k * (f.pull[0] * m.c + f.pull[1] * m.s), Y + k * (f.pull[1] * m.c - f.pull[0] * m.s)
    if f.bank and bank_m:
        q = 0.5 * RHO * p.L * p.T * m.speed * m.speed * f.bank * p.B / abs(bank_m)
        to = 1.0 if bank_m > 0 else -1.0
        Y, N = Y + to * q, N - to * 0.3 * p.L * q
    if f.ice and sin(2 * pi * m.t / f.ice_s) + 0.5 * sin(5.3 * m.t / f.ice_s) > 0.6:
        X -= f.ice
    if f.passing[0]:
        k = (
            0.5
            * RHO
            * p.L
            * p.T
            * p.U0**2
            * exp(-((((m.t % f.passing_s) - 0.5 * f.passing_s) / (1.2 * p.unit_s)) ** 2))
        )
        Y, N = Y + k * f.passing[0], N + k * p.L * f.passing[1]
    if f.thruster:
        q = f.thruster * exp(-((m.u / (0.6 * p.U0)) ** 2))
        Y, N = Y + q, N + 0.42 * p.L * q
    if f.yaw_damping:
        N -= f.yaw_damping * m.r * abs(m.u) / p.U0
    if f.sway_damping:
        Y -= f.sway_damping * m.v
    if f.flap:
        q = f.flap * m.u * m.u
        Y, N = Y + q, N + 0.1 * p.L * q
    return X, Y, N
