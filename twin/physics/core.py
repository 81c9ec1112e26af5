"""The 3-DOF Fossen core: inertia, Coriolis, damping, propeller and rudder, by components.

    M nu_dot_r + C(nu_r) nu_r + D(nu_r) nu_r = tau_propeller + tau_rudder + ...        [Fossen 2021, ch. 6]

Derivatives are stored in prime form, made non-dimensional by 1/2 rho L T U^2 (forces) and 1/2 rho L^2 T U^2
(moment), with v' = v/U and r' = r L/U, so that one set of priors serves every size of ship; `coefficients`
gives them back their units.
"""

from dataclasses import dataclass
from math import pi

from .maths import cos, positive, sin, sqrt
from .ship_like import ShipLike
from .state import LIGHT, Growth, Number

GRAVITY = 9.80665  # m/s2
# flow across the rudder over that along it, about one degree, from which both sides differ in proportion to
# it
EVEN = 0.02
Tau = tuple[Number, Number, Number]  # (X, Y, N), as plain a tuple as can be: the loop makes thousands


@dataclass(frozen=True, slots=True)
class Coefficients:
    """The ship's derivatives with their units, and what M needs to be inverted; made once for a ship."""

    m: Number
    mx_G: Number
    X_udot: Number
    Y_vdot: Number
    Y_rdot: Number
    N_vdot: Number
    N_rdot: Number
    m_u: Number  # m - X_udot
    m_v: Number  # m - Y_vdot
    m_vr: Number  # m x_G - Y_rdot
    m_rv: Number  # m x_G - N_vdot
    m_r: Number  # I_z - N_rdot
    X_u: Number
    X_uu: Number
    X_uuu: Number
    X_vv: Number
    X_vr: Number
    X_rr: Number
    Y_v: Number
    Y_uv: Number
    Y_ur: Number
    Y_vv: Number
    Y_vr: Number
    Y_rv: Number
    Y_rr: Number
    N_r: Number
    N_uv: Number
    N_ur: Number
    N_vv: Number
    N_vr: Number
    N_rv: Number
    N_rr: Number
    T_nn: Number  # thrust [N] = T_nn |n| n + T_nu |n| u_a
    T_nu: Number
    thrust_share: Number  # 1 - t: what of the thrust drives the ship
    wake_share: Number  # 1 - w: the propeller's inflow over u_r
    slipstream: Number  # inflow speed^2 at the rudder per newton of thrust
    inflow: Number  # epsilon^2: inflow speed^2 at the rudder over the propeller's
    rudder: Number  # 1/2 rho A_R C_L
    drag_R: Number  # 1 - t_R
    side_R: Number  # 1 + a_H
    lever_R: Number  # x_R + a_H x_H [m]
    gamma_v: Number
    gamma_r: Number  # times L [m]
    gamma_a: Number


def coefficients(ship: ShipLike) -> Coefficients:
    """Prime derivatives of the ship with their units back."""
    d, L, T, rho = ship.derivatives, ship.L_pp, ship.T, ship.rho
    f = 0.5 * rho * L * T  # force for 1 m/s
    m_ = f * L  # mass
    wave = (GRAVITY * L) ** 0.5  # u over it is Froude's number
    slow = f * wave  # a damping that stays linear at rest
    m_u, m_v = ship.m - d.X_udot * m_, ship.m - d.Y_vdot * m_
    mx_G = ship.m * ship.x_G
    m_vr, m_rv = mx_G - d.Y_rdot * m_ * L, mx_G - d.N_vdot * m_ * L
    m_r = ship.I_z - d.N_rdot * m_ * L**2
    # a ship of actuators has no propeller and no rudder of its own: what they would give is nothing
    D, A_R = (1.0, 0.0) if ship.actuators else (ship.D_P, ship.A_R)
    n_scale = rho * D**4
    return Coefficients(
        m=ship.m,
        mx_G=mx_G,
        X_udot=d.X_udot * m_,
        Y_vdot=d.Y_vdot * m_,
        Y_rdot=d.Y_rdot * m_ * L,
        N_vdot=d.N_vdot * m_ * L,
        N_rdot=d.N_rdot * m_ * L**2,
        m_u=m_u,
        m_v=m_v,
        m_vr=m_vr,
        m_rv=m_rv,
        m_r=m_r,
        X_u=d.X_u * slow,
        X_uu=d.X_uu * f,
        X_uuu=d.X_uuu * f / wave,
        X_vv=d.X_vv * f,
        X_vr=d.X_vr * f * L,
        X_rr=d.X_rr * f * L**2,
        Y_v=d.Y_v * slow,
        Y_uv=d.Y_uv * f,
        Y_ur=d.Y_ur * f * L,
        Y_vv=d.Y_vv * f,
        Y_vr=d.Y_vr * f * L,
        Y_rv=d.Y_rv * f * L,
        Y_rr=d.Y_rr * f * L**2,
        N_r=d.N_r * slow * L**2,
        N_uv=d.N_uv * f * L,
        N_ur=d.N_ur * f * L**2,
        N_vv=d.N_vv * f * L,
        N_vr=d.N_vr * f * L**2,
        N_rv=d.N_rv * f * L**2,
        N_rr=d.N_rr * f * L**3,
        T_nn=d.K_T0 * n_scale,
        T_nu=d.K_T1 * n_scale / D,
        thrust_share=1.0 - d.t,
        wake_share=1.0 - d.w,
        slipstream=d.kappa * 8.0 / (pi * rho * D**2),
        inflow=d.epsilon**2,
        rudder=0.5 * rho * A_R * d.C_L,
        drag_R=1.0 - d.t_R,
        side_R=1.0 + d.a_H,
        lever_R=(d.x_R + d.a_H * d.x_H) * L,
        gamma_v=d.gamma_v,
        gamma_r=d.gamma_r * L,
        gamma_a=d.gamma_a,
    )


def resistance(u: Number, c: Coefficients) -> Number:
    """Force ahead [N] on the bare hull in calm water, and what waves make of it as its speed nears theirs
    (X_uuu)."""
    U = abs(u)
    return (c.X_u + (c.X_uu + c.X_uuu * U) * U) * u


def damping(u: Number, v: Number, r: Number, c: Coefficients) -> Tau:
    """-D(nu_r) nu_r: resistance, and linear, quadratic and cross-coupled drag of the hull, |.|. in Norrbin's
    second-order modulus form."""
    U, V, R = abs(u), abs(v), abs(r)
    return (
        resistance(u, c) + (c.X_vv * v + c.X_vr * r) * v + c.X_rr * r * r,
        (c.Y_v + c.Y_uv * U + c.Y_vv * V + c.Y_rv * R) * v + (c.Y_ur * u + c.Y_vr * V + c.Y_rr * R) * r,
        (c.N_uv * u + c.N_vv * V + c.N_rv * R) * v + (c.N_r + c.N_ur * U + c.N_vr * V + c.N_rr * R) * r,
    )


def coriolis(u: Number, v: Number, r: Number, c: Coefficients) -> Tau:
    """-C(nu_r) nu_r: rigid body and added mass, whose Munk moment turns a drifting ship broadside."""
    a_v = c.Y_vdot * v + c.Y_rdot * r
    return (
        (c.m * v + c.mx_G * r - a_v) * r,
        (c.X_udot - c.m) * u * r,
        (a_v - c.mx_G * r - c.X_udot * v) * u,
    )


def thrust(u: Number, n: Number, c: Coefficients) -> Number:
    """Propeller thrust [N], linear in the advance ratio [Fossen 2021, ch. 9]."""
    N = abs(n)
    return c.T_nn * N * n + c.T_nu * N * (c.wake_share * u)


def propeller(thrust: Number, c: Coefficients) -> Tau:
    """What of the thrust drives the ship."""
    return c.thrust_share * thrust, 0.0, 0.0


def rudder(u: Number, v: Number, r: Number, delta: Number, thrust: Number, c: Coefficients) -> Tau:
    """Rudder force in the propeller's slipstream (momentum theory), with the flow that drift and turning send
    across it.

    q = eps^2 (u_a |u_a| + kappa 8 T/(pi rho D^2)),
        F = 1/2 rho A_R C_L (q sin(delta) + sqrt|q| (w + gamma_a even(w)) cos(delta)),
    w = gamma_v v + gamma_r L r,  even(w) = sqrt(w^2 + e^2) - e,  e = EVEN sqrt|q|: behind a single screw more
    of it arrives from one side than from the other [Yasukawa & Yoshimura 2015: gamma_R of each side].
    """
    u_a = c.wake_share * u
    q = c.inflow * (u_a * abs(u_a) + c.slipstream * positive(thrust))
    si, co = sin(delta), cos(delta)
    w, inflow = c.gamma_v * v + c.gamma_r * r, sqrt(abs(q) + 1e-9)
    corner = EVEN * inflow
    across = inflow * (w + c.gamma_a * (sqrt(w * w + corner * corner) - corner))
    normal = c.rudder * (q * si + across * co)
    athwart = -normal * co
    return -c.drag_R * normal * si, c.side_R * athwart, c.lever_R * athwart


def force_for(u_dot: Number, v_dot: Number, r_dot: Number, c: Coefficients, grown: Growth = LIGHT) -> Tau:
    """M nu_dot: the force that an acceleration takes, the other way round of `accelerations`."""
    m_v, m_r = c.m_v - grown[0] * c.Y_vdot, c.m_r - grown[1] * c.N_rdot
    return c.m_u * u_dot, m_v * v_dot + c.m_vr * r_dot, c.m_rv * v_dot + m_r * r_dot


def accelerations(X: Number, Y: Number, N: Number, c: Coefficients, grown: Growth = LIGHT) -> Tau:
    """M^-1 tau by components: surge stands alone, sway and yaw are a 2 x 2 system. `grown`: by how much their
    added mass has."""
    m_v, m_r = c.m_v - grown[0] * c.Y_vdot, c.m_r - grown[1] * c.N_rdot
    det = m_v * m_r - c.m_vr * c.m_rv
    return X / c.m_u, (m_r * Y - c.m_vr * N) / det, (m_v * N - c.m_rv * Y) / det
