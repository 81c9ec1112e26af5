"""The forms of the hidden effects: how nature writes what a catalogue would write otherwise.

`f` holds one array (B,) for each number that hidden_catalogue.py draws; a ship without the effect has zero
there.
"""

import numpy as np

FIELDS = [
    "fouling",
    "prop_wear",
    "rudder_wear",
    "rudder_offset",
    "crossflow",
    "tow_X",
    "tow_Y",
    "tow_N",
    "tow_period",
    "ext_north",
    "ext_east",
    "ext_N",
    "ext_period",
    "walk",
    "heel_N",
    "heel_Y",
    "lag_time",
    "lag_rate",
    "heading_bias",
    "heading_wave",
    "log_bias",
    "log_scale",
    "log_angle",
    "antenna_x",
    "antenna_y",
    "gnss_delay",
    "gyro_bias",
    "tide_mps",
    "tide_period",
    "tide_to",
    "ice",
    "ice_length",
    "ice_phase",
    "passing_Y",
    "passing_N",
    "passing_every",
    "passing_width",
    "slosh",
    "slosh_w",
    "slosh_x",
    "backlash",
    "squall_mps",
    "squall_from",
    "squall_every",
    "squall_width",
    "bank_Y",
    "bank_N",
    "windless",
    "waveless",
]

STATIONS = np.linspace(-0.45, 0.45, 10)  # strips of L/10
STRIP_CD = np.array(
    [1.6, 1.3, 1.0, 0.85, 0.8, 0.8, 0.8, 0.85, 0.95, 1.1]
)  # stern heavier than bow (Hoerner-like)


def crossflow(f, h, v, r):
    """Strip theory with a drag coefficient for each section, heavier aft: Y, N."""
    q, Y, N = -0.5 * h.rho * h.d * h.L / 10 * f.crossflow, 0.0, 0.0
    for x, cd in zip(STATIONS, STRIP_CD, strict=True):
        local = v + x * h.L * r
        y = q * cd * local * np.abs(local)
        Y, N = Y + y, N + x * h.L * y
    return Y, N


def fouling(f, h, u, v):
    """Rough skin: resistance that grows a little slower than u^2, and a dragging flank: X, Y."""
    q = 0.5 * h.rho * h.L * h.d * h.R0 * f.fouling
    return -q * h.U0**0.12 * u * np.abs(u) ** 0.88, -0.15 * q * np.abs(u) * v


def worn_thrust(f, h, thrust, n, u_P):
    """Lost thrust [N] of worn blades: 60 % of the loss evenly, the rest the more the faster they advance."""
    at_service = 0.5 * h.rho * h.L * h.d * h.U0**2 * h.R0 / (1 - h.t_P)
    advance = u_P * n / (h.U0 * (1 - h.w_P0) * h.n0)
    return f.prop_wear * np.where(
        n > 0, 0.6 * thrust + 0.4 * at_service * np.clip(advance, 0, 1.5), 0.6 * thrust
    )


def worn_rudder(f, h, delta):
    """Share of the normal force that is left: the loss grows with the angle."""
    return 1 - f.rudder_wear * (0.85 + 0.3 * np.abs(delta) / np.radians(h.rudder_max))


def blade_angle(f, h, feedback):
    """True blade angle of a rudder whose feedback is off, by a little less when hard over."""
    return feedback + f.rudder_offset * (1 - 0.15 * np.abs(feedback) / np.radians(h.rudder_max))


def propeller_walk(f, h, thrust, n, u_P, u):
    """The blades push the stern sideways, most when they back and when it is slow: Y, N."""
    load = np.abs(thrust) * (1 + 0.5 * np.exp(-((u / (0.3 * h.U0)) ** 2))) * np.where(n >= 0, 1.0, -2.0)
    Y = f.walk * load
    return Y, -0.49 * h.L * Y


def heel(f, h, u, v, r, phi):
    """A heeled hull is a cambered wing: side force and yaw moment with sin(2 phi), more at a drift: Y, N."""
    q = 0.5 * h.rho * h.L * h.d * u * np.abs(u) * 0.5 * np.sin(2 * phi)
    drift = 1 + 3 * np.abs(v) / (np.abs(u) + 0.1 * h.U0)
    return f.heel_Y * q * drift, f.heel_N * q * h.L * drift


def tow(f, t):
    """A line made fast: a mean pull in the body frame that surges by 15 %: X, Y, N."""
    surge = 1 + 0.15 * np.sin(2 * np.pi * t / f.tow_period)
    return f.tow_X * surge, f.tow_Y * surge, f.tow_N * surge


def external(f, t, psi):
    """A pull from a fixed bearing, wavering by 15 %: X, Y, N."""
    waver = 1 + 0.15 * np.sin(2 * np.pi * t / f.ext_period + 1.0)
    c, s = np.cos(psi), np.sin(psi)
    return (
        (f.ext_north * c + f.ext_east * s) * waver,
        (f.ext_east * c - f.ext_north * s) * waver,
        f.ext_N * waver,
    )


def bank(f, h, u, clearance):
    """Suction to the bank and bow away from it, falling off exponentially with clearance / beam: Y, N.

    `clearance` [m] is signed: positive when the bank lies to starboard.
    """
    q = 0.5 * h.rho * h.L * h.d * u * u * np.exp(-np.abs(clearance) / h.B) * np.sign(clearance)
    return f.bank_Y * q, -f.bank_N * q * h.L


def ice(f, h, x, y, u):
    """Brash fields: extra drag where it happens to be: X."""
    length = f.ice_length
    field = np.sin(x / length + f.ice_phase) * np.sin(y / length + 2 * f.ice_phase) + 0.4 * np.sin(
        (x - y) / (0.4 * length)
    )
    cover = 1 / (1 + np.exp(-6 * (field - 0.2)))
    return -f.ice * 0.5 * h.rho * h.L * h.d * h.R0 * h.U0**2 * cover * np.tanh(u / (0.2 * h.U0))


def passing(f, h, t):
    """A ship goes by now and then: bow out, suction, stern out: Y, N."""
    x = ((t % f.passing_every) - 0.5 * f.passing_every) / f.passing_width
    q = 0.5 * h.rho * h.L * h.d * h.U0**2
    return -f.passing_Y * q * (1 - 2 * x * x) * np.exp(-x * x), f.passing_N * q * h.L * 2 * x * np.exp(-x * x)


def slosh(f, h, lag, speed, sway_acceleration):
    """Water in a slack tank, a hardly damped mass on a spring: its acceleration, and Y, N, K on the ship."""
    push = f.slosh_w**2 * lag + 0.04 * f.slosh_w * speed
    Y = f.slosh * h.M * push
    return -push - sway_acceleration, Y, f.slosh_x * h.L * Y, 0.3 * h.d * Y


def squall(f, t):
    """Wind speed [m/s] of a squall that the anemometer, in the lee of the house, does not feel."""
    x = ((t % f.squall_every) - 0.6 * f.squall_every) / f.squall_width
    return f.squall_mps * np.exp(-(x**4))


SHALLOW_T_H = np.array([0.0, 0.2, 0.4, 0.55, 0.67, 0.77, 0.85, 0.95])
SHALLOW = np.array(
    [
        [1.0, 1.02, 1.08, 1.17, 1.32, 1.60, 2.1, 3.0],  # resistance
        [1.0, 1.03, 1.16, 1.45, 1.95, 2.75, 4.0, 7.0],  # sway
        [1.0, 1.01, 1.07, 1.22, 1.48, 1.85, 2.4, 3.5],
    ]
)  # yaw


def shallow(draught_over_depth):
    """Multipliers of resistance, sway and yaw derivatives by draught / depth: an estimate of ours, of the
    order that tank tests with full tankers report (resistance x2, sway x4, yaw x2.4 at 1.18 draughts)."""
    return [np.interp(draught_over_depth, SHALLOW_T_H, row) for row in SHALLOW]
