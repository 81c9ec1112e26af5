"""Hull, propeller and rudder of the MMG standard method, with heel after Son & Nomoto.

Everything takes a fleet `h` (see fleet.stack) and arrays (B,); forces in N and N m, body axes about midship.
"""

import numpy as np

R_CLIP = 1.2  # r' beyond which the polynomial has never been measured (pivoting at rest)


def limit(x, low, high):
    """np.clip without its overhead."""
    return np.minimum(np.maximum(x, low), high)


def hull(h, u, v, r, p, phi, shallow=(1.0, 1.0, 1.0)):
    """Force of the water on the bare hull: X, Y, N, K.

    MMG polynomials in v' and r' (Yasukawa & Yoshimura 2015) plus heel terms (Son & Nomoto 1981).
    Odd derivatives change sign when it goes astern; below walking pace a cross-flow yaw drag takes over.
    `shallow` multiplies resistance, sway and yaw derivatives.
    """
    U = np.sqrt(u * u + v * v + (0.02 * h.U0) ** 2)
    a, b, c = limit(u / (0.05 * h.U0), -1, 1), v / U, limit(r * h.L / U, -R_CLIP, R_CLIP)
    q = 0.5 * h.rho * h.L * h.d * U * U
    bb, cc, ff = b * b, c * c, phi * phi
    X = q * (
        -h.R0 * shallow[0] * u / U
        + h.X[0] * bb
        + h.X[1] * b * c * a
        + h.X[2] * cc
        + h.X[3] * bb * bb
        + h.heel_X[0] * ff
    )
    Y = (
        q
        * shallow[1]
        * (b * (h.Y[0] + h.Y[2] * bb + h.Y[4] * cc) + a * c * (h.Y[1] + h.Y[3] * bb + h.Y[5] * cc))
    )
    N = (
        q
        * h.L
        * shallow[2]
        * (a * b * (h.N[0] + h.N[2] * bb + h.N[4] * cc) + c * (h.N[1] + h.N[3] * bb + h.N[5] * cc))
    )
    N -= 0.02 * 0.5 * h.rho * h.d * h.L**4 * np.abs(r) * (r - c * U / h.L)
    if not h.heels:
        return X, Y, N, -h.z_H * Y
    Yh, Nh, Kh = _heel(h, b, c, p * h.L / U, phi)
    return X, Y + q * Yh, N + q * h.L * Nh, q * h.L * Kh - h.z_H * Y


def _heel(h, b, c, p, phi):
    """Heel-dependent part of Y', N' and the whole of K' (Son & Nomoto 1981); zero for hulls not so tested."""
    bb, cc, ff = b * b, c * c, phi * phi
    y, n, k = h.heel_Y, h.heel_N, h.heel_K
    Y = phi * (y[0] + y[1] * bb + y[3] * cc) + ff * (y[2] * b + y[4] * c)
    N = n[0] * p + phi * (n[1] + n[2] * bb + n[4] * cc) + ff * (n[3] * b + n[5] * c)
    K = (
        b * (k[0] + k[4] * bb + k[7] * cc)
        + c * (k[1] + k[5] * cc + k[6] * bb)
        + k[2] * p
        + phi * (k[3] + k[8] * bb + k[10] * cc)
        + ff * (k[9] * b + k[11] * c)
    )
    return Y, N, K


def open_water(h, n, u_P):
    """Thrust [N] = rho D^2 (k0 n^2 D^2 + k1 n D u_P + k2 u_P |u_P|): K_T(J) without its division by n.

    Astern (n < 0) the blades work on their backs: 65 % of the bollard pull, a third of the slope.
    """
    nD = n * h.D_P
    k0, k1, k2 = h.K_T
    ahead = k0 * nD * nD + k1 * nD * u_P
    astern = -0.65 * k0 * nD * nD - 0.35 * np.abs(k1 * nD) * np.abs(u_P)
    return h.rho * h.D_P**2 * (np.where(n >= 0, ahead, astern) + k2 * u_P * np.abs(u_P))


def inflow(h, u, v, r):
    """Axial speed at the propeller [m/s]: the wake thins with drift (Yasukawa & Yoshimura 2015)."""
    U = np.sqrt(u * u + v * v + (0.02 * h.U0) ** 2)
    b = -v / U - h.x_P * limit(r * h.L / U, -R_CLIP, R_CLIP)
    gain = 1 + (1 - np.exp(-h.C1 * np.abs(b))) * (np.where(b > 0, h.C2[0], h.C2[1]) - 1) + h.C_quad * b * b
    return u * np.where(u > 0, np.minimum((1 - h.w_P0) * gain, 1.1), 1.0)


def rudder(h, u, v, r, u_P, thrust, delta, gain=1.0, gamma_gain=1.0):
    """Rudder in the slipstream: X, Y, N, K (Yasukawa & Yoshimura 2015).

    The slipstream speed comes from momentum, sqrt(u_P^2 + 8 T / (pi rho D^2)): the u_P sqrt(1 + 8 K_T / (pi
    J^2)) of the paper without its division by J, so that it also holds with the propeller stopped or
    astern.
    """
    U = np.sqrt(u * u + v * v + (0.02 * h.U0) ** 2)
    sin, cos = np.sin(delta), np.cos(delta)
    v1, r1 = v / U, limit(r * h.L / U, -R_CLIP, R_CLIP)
    lever = v1 + h.l_R * r1
    gamma = np.where(lever < 0, h.gamma[0], h.gamma[1]) * gamma_gain
    v_R = U * (gamma * lever + r1 * r1 * (h.r_turn[0] * r1 + h.r_turn[1] * v1))
    jet = np.sqrt(np.maximum(u_P * u_P + 8 * thrust / (np.pi * h.rho * h.D_P**2), 0))
    mixed = np.sqrt(h.eta * (u_P + h.kappa * (jet - u_P)) ** 2 + (1 - h.eta) * u_P**2)
    u_R = h.epsilon * np.where(u_P >= 0, mixed, u_P)
    normal = u_R * sin + v_R * cos
    F = 0.5 * h.rho * h.A_R * h.f_alpha * np.sqrt(u_R * u_R + v_R * v_R) * normal * gain
    X, Y, N = -(1 - h.t_R) * F * sin, -(1 + h.a_H) * F * cos, -(-0.5 + h.a_H * h.x_H) * h.L * F * cos
    return X, Y, N, -h.z_R * Y
