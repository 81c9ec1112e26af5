"""A fleet: the numbers of many hulls side by side, every number an array of shape (B,)."""

from dataclasses import fields
from types import SimpleNamespace

import numpy as np

from bench.reference.mmg import open_water


def stack(hulls) -> SimpleNamespace:
    """Every number as (B,), every tuple as a tuple of (B,); and the SI inertias that the motion needs."""
    h = SimpleNamespace()
    for f in fields(hulls[0]):
        values = [getattr(x, f.name) for x in hulls]
        if isinstance(values[0], tuple):
            longest = max(map(len, values))
            padded = [v + (0.0,) * (longest - len(v)) for v in values]
            setattr(h, f.name, tuple(np.array(c, float) for c in zip(*padded, strict=True)))
        elif not isinstance(values[0], str):
            setattr(h, f.name, np.array(values, float))
    return _with_inertia(h)


def _with_inertia(h):
    """Masses [kg], inertias [kg m2] about midship, and the inverse of the sway-yaw-roll matrix.

    [ m + my        m x_G + my a_y    -my l_y ] [v']   [Y]
    [ m x_G + my a_y   I_z + J_z          0   ] [r'] = [N]
    [ -my l_y             0            I_x+J_x] [p']   [K]      (Son & Nomoto 1981)
    """
    _with_products(h)
    mass, inertia = 0.5 * h.rho * h.L**2 * h.d, 0.5 * h.rho * h.L**4 * h.d
    h.M, h.Mx, h.My = h.m * mass, h.mx * mass, h.my * mass
    h.Iz = h.M * (h.k_zz * h.L) ** 2 + h.M * h.x_G**2
    h.Izz, h.Ixx = h.Iz + h.Jz * inertia, h.M * (h.k_xx * h.B) ** 2
    a22, a23, a24 = h.M + h.My, h.M * h.x_G + h.My * h.a_y * h.L, -h.My * h.l_y
    det = a22 * h.Izz * h.Ixx - a24**2 * h.Izz - a23**2 * h.Ixx
    h.inv_vY, h.inv_vN, h.inv_vK = h.Izz * h.Ixx / det, -a23 * h.Ixx / det, -a24 * h.Izz / det
    h.inv_rN, h.inv_rK = (a22 * h.Ixx - a24**2) / det, a23 * a24 / det
    h.inv_pK = (a22 * h.Izz - a23**2) / det
    h.surged, h.swayed, h.off, h.rolled = h.M + h.Mx, h.M + h.My, h.M * h.x_G, h.Mx * h.l_y
    h.GZ = h.M * 9.81 * h.GM
    h.w_roll = np.sqrt(h.GZ / h.Ixx)
    h.B44 = 2 * h.roll_damping * np.sqrt(h.GZ * h.Ixx)
    h.heels = any(np.any(c) for table in (h.heel_X, h.heel_Y, h.heel_N, h.heel_K) for c in table)
    h.n0 = propeller_rate_service(h)
    return h


def _with_products(h):
    """What mmg.py, isherwood.py and the helmsman would else multiply out at every tick."""
    h.unit, h.slow2, h.walking = h.L / h.U0, (0.02 * h.U0) ** 2, 0.05 * h.U0
    h.pressed, h.spun = 0.5 * h.rho * h.L * h.d, 0.02 * 0.5 * h.rho * h.d * h.L**4
    h.sway_yaw = [np.stack(pair) for pair in zip(h.Y, h.N, strict=True)]
    h.disc, h.jet = h.rho * h.D_P**2, np.pi * h.rho * h.D_P**2
    h.back, h.wake = -0.65 * h.K_T[0], 1 - h.w_P0
    h.blade, h.outside = 0.5 * h.rho * h.A_R * h.f_alpha, 1 - h.eta
    h.on_X, h.on_Y, h.on_N = -(1 - h.t_R), -(1 + h.a_H), -(-0.5 + h.a_H * h.x_H) * h.L
    h.hard_over, h.fastest = np.radians(h.rudder_max), np.radians(h.rudder_rate)


def propeller_rate_service(h):
    """Propeller rate [1/s] that balances the calm resistance at U0 (bisection)."""
    need = 0.5 * h.rho * h.L * h.d * h.U0**2 * h.R0 / (1 - h.t_P)
    low, high = np.zeros_like(need), 5 * h.U0 / h.D_P
    for _ in range(60):
        n = 0.5 * (low + high)
        enough = open_water(h, n, h.U0 * (1 - h.w_P0)) > need
        low, high = np.where(enough, low, n), np.where(enough, n, high)
    return 0.5 * (low + high)
