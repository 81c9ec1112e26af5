"""Hull, propeller and rudder of the MMG standard method, with heel after Son & Nomoto.

Everything takes a fleet `h` (see fleet.stack) and arrays (B,); forces in N and N m, body axes about midship.
"""

import numpy as np

R_CLIP = 1.2  # r' beyond which the polynomial has never been measured (pivoting at rest)


def limit(x, low, high):
    """np.clip without its overhead."""
    return np.minimum(np.maximum(x, low), high)


def angles(h, u, v, r):
    """Speed through the water [m/s] (never quite nothing), v' and r' (B,), as hull, propeller and rudder
    take them."""
    U = np.sqrt(u * u + v * v + h.slow2)
    return U, v / U, limit(r * h.L / U, -R_CLIP, R_CLIP)


def hull(h, there, u, r, p, phi, shallow=None):
    """Force of the water on the bare hull: X, Y, N, K. `there`: what `angles` gives.

    MMG polynomials in v' and r' (Yasukawa & Yoshimura 2015) plus heel terms (Son & Nomoto 1981).
    Odd derivatives change sign when it goes astern; below walking pace a cross-flow yaw drag takes over.
    `shallow` multiplies resistance, sway and yaw derivatives.
    """
    U, b, c = there
    a, q = limit(u / h.walking, -1, 1), h.pressed * U * U
    bb, cc, ff, sway, yaw = b * b, c * c, phi * phi, q, q * h.L
    resisted = -h.R0
    if shallow is not None:
        resisted, sway, yaw = resisted * shallow[0], sway * shallow[1], yaw * shallow[2]
    X = q * (
        resisted * u / U
        + h.X[0] * bb
        + h.X[1] * b * c * a
        + h.X[2] * cc
        + h.X[3] * bb * bb
        + h.heel_X[0] * ff
    )
    k = h.sway_yaw
    (Y_b, N_b), (Y_c, N_c) = k[0] + k[2] * bb + k[4] * cc, k[1] + k[3] * bb + k[5] * cc
    Y, N = sway * (b * Y_b + a * c * Y_c), yaw * (a * b * N_b + c * N_c)
    N -= h.spun * np.abs(r) * (r - c * U / h.L)
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
    turned, ahead = k0 * nD * nD + k1 * nD * u_P, n >= 0
    if not ahead.all():
        astern = h.back * nD * nD - 0.35 * np.abs(k1 * nD) * np.abs(u_P)
        turned = np.where(ahead, turned, astern)
    return h.disc * (turned + k2 * u_P * np.abs(u_P))


def inflow(h, there, u):
    """Axial speed at the propeller [m/s]: the wake thins with drift (Yasukawa & Yoshimura 2015)."""
    _, v1, r1 = there
    b = -v1 - h.x_P * r1
    gain = 1 + (1 - np.exp(-h.C1 * np.abs(b))) * (np.where(b > 0, h.C2[0], h.C2[1]) - 1) + h.C_quad * b * b
    return u * np.where(u > 0, np.minimum(h.wake * gain, 1.1), 1.0)


def rudder(h, there, u_P, thrust, delta):
    """Rudder in the slipstream: X, Y, N, K (Yasukawa & Yoshimura 2015).

    The slipstream speed comes from momentum, sqrt(u_P^2 + 8 T / (pi rho D^2)): the u_P sqrt(1 + 8 K_T / (pi
    J^2)) of the paper without its division by J, so that it also holds with the propeller stopped or
    astern.
    """
    U, v1, r1 = there
    sin, cos = np.sin(delta), np.cos(delta)
    lever = v1 + h.l_R * r1
    gamma = np.where(lever < 0, h.gamma[0], h.gamma[1])
    v_R = U * (gamma * lever + r1 * r1 * (h.r_turn[0] * r1 + h.r_turn[1] * v1))
    jet = np.sqrt(np.maximum(u_P * u_P + 8 * thrust / h.jet, 0))
    mixed = np.sqrt(h.eta * (u_P + h.kappa * (jet - u_P)) ** 2 + h.outside * u_P**2)
    u_R = h.epsilon * np.where(u_P >= 0, mixed, u_P)
    normal = u_R * sin + v_R * cos
    F = h.blade * np.sqrt(u_R * u_R + v_R * v_R) * normal
    X, Y, N = h.on_X * F * sin, h.on_Y * F * cos, h.on_N * F * cos
    return X, Y, N, -h.z_R * Y
