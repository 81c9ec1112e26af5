"""A short-crested JONSWAP sea, its first-order loads on a box of the ship's size, and its slow drift.

Components a_i cos(w_i t - k_i (x cos m_i + y sin m_i) + e_i), m_i the direction of travel. First order: the
Froude-Krylov pressure integrated over a box L x B x d (Journee & Massie 2001, ch. 6), enlarged by the added
mass. Second order: Newman (1974), F = |sum a_i sqrt(D_i) exp(i p_i)|^2, D_i those of a wall that reflects
what does not pass under the keel, R = 1 - exp(-k d).
"""

from types import SimpleNamespace

import numpy as np

G = 9.81
N_FREQUENCY, SPREAD = 14, np.radians([-25.0, 0.0, 25.0])


def jonswap(f, peak, gamma=3.3):
    """Shape of the spectrum at frequency f [Hz], scaled to its height afterwards (Hasselmann et al. 1973)."""
    fp = 1 / peak
    sigma = np.where(f <= fp, 0.07, 0.09)
    shape = f**-5.0 * np.exp(-1.25 * (fp / f) ** 4) * gamma ** np.exp(-0.5 * ((f - fp) / (sigma * fp)) ** 2)
    return shape


def components(weather, rng):
    """Amplitude, angular frequency, wave number, direction of travel, phase: arrays (42,)."""
    edges = np.geomspace(0.65, 2.2, N_FREQUENCY + 1) / weather.wave_period_s
    f = edges[:-1] + rng.uniform(0.2, 0.8, N_FREQUENCY) * np.diff(edges)
    energy = jonswap(f, weather.wave_period_s) * np.diff(edges)
    energy *= weather.wave_height_m**2 / 16 / energy.sum()
    share = np.array([0.25, 0.5, 0.25])
    a = np.sqrt(2 * np.outer(energy, share)).ravel()
    w = np.repeat(2 * np.pi * f, 3) * (1 + 0.01 * rng.uniform(-1, 1, 3 * N_FREQUENCY))
    to = np.radians(weather.wave_from_deg + 180) + np.tile(SPREAD, N_FREQUENCY)
    return a, w, w * w / G, to, rng.uniform(0, 2 * np.pi, a.size)


def stack_seas(seas):
    """Components of B ships as arrays (42, B)."""
    a, w, k, to, e = (np.stack(c, 1) for c in zip(*seas, strict=True))
    return SimpleNamespace(a=a, w=w, k=k, to=to, e=e, cos_to=np.cos(to), sin_to=np.sin(to))


def _sinc(q):
    return np.sinc(q / np.pi)


def _arm(q):
    """(sin q - q cos q)/q^2: how unevenly a wave of half-length phase q loads bow and stern."""
    q = np.where(np.abs(q) < 1e-3, 1e-3, q)
    return (np.sin(q) - q * np.cos(q)) / (q * q)


def transfer(h, sea, psi):
    """What hangs on heading only: loads per amplitude (42, B), and the roots of the drift coefficients."""
    chi = sea.to - psi
    cos, sin = np.cos(chi), np.sin(chi)
    ql, qb = 0.5 * sea.k * h.L * cos, 0.5 * sea.k * h.B * sin
    deep = np.exp(-0.5 * sea.k * h.d)
    even = _sinc(ql) * _sinc(qb) * deep
    odd = _arm(ql) * _sinc(qb) * deep
    push, plane = G * sea.k, h.rho * G * h.L * h.B * 0.85
    aside = (h.M + h.My) * push * sin
    X, Y, N = -h.M * push * cos * even, -aside * even, 0.5 * h.L * aside * odd
    K, Z, M = -h.GZ * sea.k * sin * even, plane * even, plane * 0.5 * h.L * odd
    return (X, Y, N, K, Z, M), _drift_roots(h, cos, sin, deep)


def _drift_roots(h, cos, sin, deep):
    """Roots of the drift coefficients, pushing and pulling; a quartering sea bears off centre (1/8 L)."""
    reflect = (1 - deep**2) ** 2 * 0.5 * h.rho * G
    ahead, aside = reflect * h.B * 0.35 * cos * np.abs(cos), reflect * h.L * sin * np.abs(sin)
    turning = -0.125 * h.L * reflect * h.L * sin * cos
    return [(np.sqrt(np.maximum(D, 0)), np.sqrt(np.maximum(-D, 0))) for D in (ahead, aside, turning)]


def loads(sea, answer, t, x, y):
    """First-order X, Y, N, K, heave force Z, pitch moment M; and drift X, Y, N; each (B,)."""
    phase = sea.w * t - sea.k * (x * sea.cos_to + y * sea.sin_to) + sea.e
    c, s = sea.a * np.cos(phase), sea.a * np.sin(phase)
    (X, Y, N, K, Z, M), roots = answer
    first = [(X * s).sum(0), (Y * s).sum(0), (N * c).sum(0), (K * s).sum(0), (Z * c).sum(0), (M * s).sum(0)]
    drift = []
    for plus, minus in roots:
        gain = (c * plus).sum(0) ** 2 + (s * plus).sum(0) ** 2
        drift.append(gain - (c * minus).sum(0) ** 2 - (s * minus).sum(0) ** 2)
    return first, tuple(drift)


def oscillator(h):
    """Heave and pitch as masses on springs: natural frequencies [rad/s] and damping shares.

    w = sqrt(rho g A_w / (2 m)) with the added mass taken equal to the mass (strip theory, B/d near 2.5).
    """
    w = np.sqrt(h.rho * G * h.L * h.B * 0.85 / (2 * h.M))
    return w, 0.3, 1.05 * w, 0.3, 2 * h.M, 2 * h.M * (0.26 * h.L) ** 2
