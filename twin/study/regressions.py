"""A ship's numbers from her main particulars: published regressions, each with its source and the hulls it was made from.

Prime form as in twin/physics/core.py. Names follow MMG where a regression does; `modulus.py` turns them into the core's form.
"""

from math import atan, log10, pi
from typing import NamedTuple

Estimates = dict[str, tuple[float, str]]  # name -> value, key in SOURCES

SOURCES = {
    "given": "given by the owner",
    "YM12": "Yoshimura & Masumoto (2012) MARSIM: hull polynomial, steering and flow at the rudder, by C_b B/L, L/B, 2T/L",
    "CGH83": "Clarke, Gedling & Hine (1983) Trans. RINA 125, 45-68: added masses by T/L, B/L, C_b B/T",
    "SOE82": "Soeding (1982) Schiffstechnik 29, 3-29: added mass in surge, 2.7 rho V^(5/3)/L^2",
    "HAS80": "Hasegawa (1980) J. Kansai Soc. Naval Arch. 178: X_vr = (1.66 C_b - 1.525) m_y",
    "KIJ90": "Kijima, Katsuno, Nakiri & Furukawa (1990) J. Soc. Naval Arch. Japan 168: a_H = 0.627 C_b - 0.153",
    "FUJ61": "Fujii & Tsuda (1961): slope of the rudder force 6.13 A/(A + 2.25), A the aspect ratio",
    "DNV": "DNV Rules for Ships Pt.3 Ch.14: rudder area T L/100 (1 + 25 (B/L)^2)",
    "ITTC57": "ITTC (1957) friction line, Watanabe's form factor, Bowden & Davison's allowance, Denny-Mumford's wetted surface, residual part by Froude number",
    "TAY43": "Taylor (1943) The Speed and Power of Ships: w = 0.5 C_b - 0.05, single screw",
    "HAR83": "Harvald (1983) Resistance and Propulsion of Ships: t near 0.2 for single screws",
    "WAG": "Wageningen B-series, 4 blades: K_T = K_T0 (1 - J/(1.1 P/D)), K_T0 = 0.43 P/D - 0.02 (Oosterveld & van Oossanen 1975)",
    "ALEX": "Alexander's formula C_b = 1.08 - 1.68 Fr (Schneekluth & Bertram 1998)",
    "RULE": "rule of thumb from the bundled ships: expect +-30 %",
    "ROUGH": "a guess by size only: expect a factor of 2",
    "GYR": "k_zz = 0.25 L, usual for merchant ships (ITTC 7.5-02-06-01)",
    "LSQ": "made from the sources named by least squares (modulus form)",
    "RPM": "such that the shaft speed given drives her at service speed",
    "SEA": "sea water",
    "ZERO": "taken as zero",
}

# Source, quantity, and the range of the hulls it was made from (about, where the paper does not say).
VALIDITY: tuple[tuple[str, str, float, float], ...] = (
    ("YM12", "C_b", 0.45, 0.86),
    ("YM12", "L/B", 2.6, 8.0),
    ("YM12", "B/T", 1.8, 5.0),
    ("CGH83", "L/B", 4.0, 9.0),
    ("CGH83", "B/T", 1.8, 6.0),
    ("ITTC57", "Fr", 0.05, 0.36),
    ("TAY43", "C_b", 0.45, 0.88),
)


class Hull(NamedTuple):
    """What the regressions start from, SI."""

    L: float
    B: float
    T: float
    C_b: float
    U: float
    x_G: float
    rho: float

    @property
    def volume(self) -> float:
        return self.C_b * self.L * self.B * self.T

    @property
    def ratios(self) -> dict[str, float]:
        return {"C_b": self.C_b, "L/B": self.L / self.B, "B/T": self.B / self.T, "Fr": self.U / (9.80665 * self.L) ** 0.5}


def outside(h: Hull) -> list[str]:
    """In words, where this hull lies outside what a regression was made from."""
    found: dict[str, list[str]] = {}
    for source, name, lo, hi in VALIDITY:
        if not lo <= h.ratios[name] <= hi:
            found.setdefault(name, []).append(f"{SOURCES[source].split(')')[0]}) {lo:g} to {hi:g}")
    return [f"{name} = {h.ratios[name]:.3g} is unlike the hulls of {', '.join(where)}" for name, where in found.items()]


def nearest(h: Hull) -> Hull:
    """The hull of usual proportions that is nearest to this one: a regression is never asked far outside its hulls.

    A catamaran or a raft is taken for a ship of her length, draught and mass; calibration must do the rest.
    """
    B = min(h.L / 3.2, max(h.L / 9.0, h.B))
    return h._replace(B=B, C_b=min(0.87, max(0.42, h.C_b * h.B / B)))


def typical_block_coefficient(L: float, U: float | None) -> tuple[float, str]:
    """C_b of a ship of this speed (Watson & Gilfillan's curve), or of this size."""
    if U is None:
        return (0.75, "ROUGH") if L > 24.0 else (0.5, "ROUGH")
    return 0.70 + 0.125 * atan((23.0 - 100.0 * U / (9.80665 * L) ** 0.5) / 4.0), "RULE"


def service_speed(L: float, C_b: float) -> float:
    """U_0 [m/s] at which a hull of this fullness is usually driven (Alexander), Froude number 0.13 to 0.34."""
    return min(0.34, max(0.13, (1.08 - C_b) / 1.68)) * (9.80665 * L) ** 0.5


def added_masses(h: Hull) -> Estimates:
    """Added masses in prime form; the two couplings of sway and yaw are made equal (their mean), as potential flow has them."""
    aspect = pi * h.T / h.L  # pi (T/L)^2 over T/L, since we divide by T instead of L
    B_L, B_T = h.B / h.L, h.B / h.T
    coupled = 0.5 * (0.67 * B_L - 0.0033 * B_T**2 + 1.1 * B_L - 0.041 * B_T)
    return {
        "X_udot": (-2.7 * h.volume ** (5.0 / 3.0) / h.L**2 / (0.5 * h.L**2 * h.T), "SOE82"),
        "Y_vdot": (-aspect * (1.0 + 0.16 * h.C_b * B_T - 5.1 * B_L**2), "CGH83"),
        "Y_rdot": (-aspect * coupled, "CGH83"),
        "N_vdot": (-aspect * coupled, "CGH83"),
        "N_rdot": (-aspect * max(0.03, 1.0 / 12.0 + 0.017 * h.C_b * B_T - 0.33 * B_L), "CGH83"),
    }


def hull_polynomial(h: Hull, m_x: float, m_y: float) -> dict[str, float]:
    """The MMG polynomial of YM12, and X_vr of HAS80."""
    k, s, L_B, fine = 2.0 * h.T / h.L, h.C_b * h.B / h.L, h.L / h.B, 1.0 - h.C_b
    return {
        "X_vv": 1.15 * s - 0.18, "X_vr": (1.66 * h.C_b - 1.525) * m_y, "X_rr": 0.008 - 0.085 * s, "X_vvvv": 1.1 - 6.68 * s,
        "Y_v": -(0.5 * pi * k + 1.4 * s), "Y_r": m_x + 0.5 * s, "Y_vvv": -(0.185 * L_B + 0.48), "Y_vvr": -0.75,
        "Y_vrr": -(0.26 * fine * L_B + 0.11), "Y_rrr": -0.051,
        "N_v": -k, "N_r": k * k - 0.54 * k, "N_vvv": 0.69 * h.C_b - 0.66, "N_vvr": 1.55 * s - 0.76,
        "N_vrr": -(0.075 * fine * L_B + 0.098), "N_rrr": 0.25 * s - 0.056,
    }  # fmt: skip


def resistance(h: Hull) -> float:
    """R / (1/2 rho L T U^2) at service speed."""
    surface = 1.7 * h.L * h.T + h.volume / h.T
    reynolds = max(1e5, h.U * h.L / 1.19e-6)
    friction = 0.075 / (log10(reynolds) - 2.0) ** 2
    form = max(0.02, -0.095 + 25.6 * h.C_b / ((h.L / h.B) ** 2 * (h.B / h.T) ** 0.5))
    roughness = min(4e-4, (105.0 * (150e-6 / h.L) ** (1.0 / 3.0) - 0.64) * 1e-3)
    residual = min(0.012, 4e-4 + 1e-3 * 10.0 ** (5.2 * (h.ratios["Fr"] - 0.27)))  # of the order of Guldhammer & Harvald (1974)
    return 1.05 * (friction * (1.0 + form) + roughness + residual) * surface / (h.L * h.T)  # 5 % for appendages


def propulsion(h: Hull, pitch_ratio: float) -> Estimates:
    """Thrust, wake and thrust deduction of a single screw."""
    K_T0 = 0.43 * pitch_ratio - 0.02
    return {
        "K_T0": (K_T0, "WAG"), "K_T1": (-K_T0 / (1.1 * pitch_ratio), "WAG"),
        "w": (max(0.0, 0.5 * h.C_b - 0.05), "TAY43"), "t": (0.2, "HAR83"),
    }  # fmt: skip


def steering(h: Hull, aspect: float) -> Estimates:
    """Rudder force and what hull and propeller do to it, but for the slipstream."""
    s = h.C_b * h.B / h.L
    gamma, l_R = 2.06 * s + 0.14, 1.7 * s - 1.0
    return {
        "C_L": (6.13 * aspect / (aspect + 2.25), "FUJ61"), "t_R": (0.39, "YM12"), "a_H": (max(0.0, 0.627 * h.C_b - 0.153), "KIJ90"),
        "x_R": (-0.5, "RULE"), "x_H": (-0.45, "YM12"), "gamma_v": (gamma, "YM12"), "gamma_r": (gamma * l_R, "YM12"),
    }  # fmt: skip
