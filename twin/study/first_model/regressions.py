"""A ship's numbers from its main particulars: published regressions, each with its source and the hulls it
was made from.

Prime form as in twin/physics/core.py. Names follow MMG where a regression does; `modulus.py` turns them into
the core's form."""

from math import atan, log10, pi
from typing import NamedTuple

from twin.num import as_given, num

Estimates = dict[str, tuple[float, str]]  # name -> value, key in SOURCES

SOURCES = {
    "given": "given by the owner",
    "PARTS": "as the ship's actuators have it",
    "KIJ90": "Kijima, Katsuno, Nakiri & Furukawa (1990) J. Soc. Naval Arch. Japan 168: hull beyond its "
    "linear part, a_H; by C_b B/L, T/B",
    "YM12": "Yoshimura & Masumoto (2012) MARSIM: the same, hull in surge, flow at the rudder, t_R; by C_b "
    "B/L, L/B",
    "CGH83": "Clarke, Gedling & Hine (1983) Trans. RINA 125, 45-68: added masses and linear damping by T/L, "
    "B/L, C_b B/T",
    "SOE82": "Soeding (1982) Schiffstechnik 29, 3-29: added mass in surge, 2.7 rho V^(5/3)/L^2",
    "HAS80": "Hasegawa (1980) J. Kansai Soc. Naval Arch. Japan 178: X_vr = (1.66 C_b - 1.525) m_y",
    "MAT80": "Matsumoto & Suemitsu (1980) J. Kansai Soc. Naval Arch. Japan 176: slipstream at the rudder, "
    "kappa = 0.6/epsilon, epsilon near 1.02",
    "FUJ61": "Fujii & Tsuda (1961) J. Soc. Naval Arch. Japan 110: slope of the rudder force 6.13 A/(A + "
    "2.25), A the aspect ratio",
    "DNV": "Det Norske Veritas (1975) Rules for Steel Ships: rudder area T L/100 (1 + 25 (B/L)^2)",
    "ITTC57": "ITTC (1957) friction line, Watanabe's form factor, Bowden & Davison's allowance, "
    "Denny-Mumford's wetted surface, residual part by Froude number",
    "TAY43": "Taylor (1943) The Speed and Power of Ships: w = 0.5 C_b - 0.05, twin screws 0.55 C_b - 0.2",
    "HAR83": "Harvald (1983) Resistance and Propulsion of Ships: t near 0.2 for single screws",
    "WAG": "Wageningen B-series, 4 blades: K_T = K_T0 (1 - J/(1.1 P/D)), K_T0 = 0.43 P/D - 0.02 (Oosterveld "
    "& van Oossanen 1975)",
    "CAR18": "Carlton (2018) Marine Propellers and Propulsion, ch. 6: C_T of a screw that stands still near "
    "-0.5 (four quadrants)",
    "ALEX": "Alexander's formula C_b = 1.08 - 1.68 Fr (Schneekluth & Bertram 1998)",
    "RULE": "rule of thumb from the bundled ships: expect +-30 %",
    "ROUGH": "a guess by size only: expect a factor of 2",
    "GYR": "k_zz = 0.25 L, usual for merchant ships",
    "LSQ": "made from the sources named by least squares (modulus form)",
    "RPM": "such that the shaft speed given drives it at service speed",
    "SEA": "sea water",
    "ZERO": "taken as zero",
}

# Source, quantity, and the range of the hulls it was made from (about, where the paper does not say).
VALIDITY: tuple[tuple[str, str, float, float], ...] = (
    ("KIJ90", "C_b", 0.50, 0.87),
    ("KIJ90", "L/B", 3.2, 8.0),
    ("KIJ90", "B/T", 2.0, 6.0),
    ("YM12", "C_b", 0.45, 0.86),
    ("CGH83", "L/B", 4.0, 9.0),
    ("CGH83", "B/T", 1.8, 6.0),
    ("ITTC57", "Fr", 0.05, 0.36),
    ("TAY43", "C_b", 0.45, 0.88),
)


class HullForm(NamedTuple):
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
        """Displaced volume [m3]."""
        return self.C_b * self.L * self.B * self.T

    @property
    def ratios(self) -> dict[str, float]:
        """The ratios by which regressions state their validity [-]."""
        return {
            "C_b": self.C_b,
            "L/B": self.L / self.B,
            "B/T": self.B / self.T,
            "Fr": self.U / (9.80665 * self.L) ** 0.5,
        }


def outside(h: HullForm) -> list[str]:
    """In words, where this hull lies outside what a regression was made from."""
    found: dict[str, list[str]] = {}
    for source, name, lo, hi in VALIDITY:
        if not lo <= h.ratios[name] <= hi:
            found.setdefault(name, []).append(
                f"{SOURCES[source].split(')')[0]}) {as_given(lo)} to {as_given(hi)}"
            )
    return [
        f"{name} = {num(h.ratios[name], 3)} is unlike the hulls of {', '.join(where)}: rougher until "
        "calibrated"
        for name, where in found.items()
    ]


def nearest(h: HullForm) -> HullForm:
    """The hull of usual proportions that is nearest to this one: a regression is never asked far outside its
    hulls.

    A catamaran or a raft is taken for a ship of its length, draught and mass; calibration must do the rest.
    """
    B = min(h.L / 3.2, max(h.L / 9.0, h.B))
    return h._replace(B=B, C_b=min(0.87, max(0.42, h.C_b * h.B / B)))


def typical_block_coefficient(L: float, U: float | None) -> tuple[float, str]:
    """C_b of a ship of this speed (Watson & Gilfillan's curve), or of this size."""
    if U is None:
        return (0.75, "ROUGH") if L > 24.0 else (0.5, "ROUGH")
    return 0.70 + 0.125 * atan((23.0 - 100.0 * U / (9.80665 * L) ** 0.5) / 4.0), "RULE"


def service_speed(L: float, C_b: float) -> float:
    """U_0 [m/s] at which a hull of this fullness is usually driven (Alexander), Froude number 0.13 to
    0.34."""
    return min(0.34, max(0.13, (1.08 - C_b) / 1.68)) * (9.80665 * L) ** 0.5


# of L: the water that swaying sets in motion has its centre no farther from midship. The regression's is
# farther out on beamy hulls, where the energy of that water would be negative
FARTHEST_WATER = 0.1


def added_masses(h: HullForm) -> Estimates:
    """Added masses in prime form; the two couplings of sway and yaw are made equal (their mean), as potential
    flow has them."""
    aspect = pi * h.T / h.L  # pi (T/L)^2 over T/L, since we divide by T instead of L
    B_L, B_T = h.B / h.L, h.B / h.T
    sway = 1.0 + 0.16 * h.C_b * B_T - 5.1 * B_L**2
    farthest = FARTHEST_WATER * sway
    coupled = 0.5 * (0.67 * B_L - 0.0033 * B_T**2 + 1.1 * B_L - 0.041 * B_T)
    coupled = min(farthest, max(-farthest, coupled))
    return {
        "X_udot": (-2.7 * h.volume ** (5.0 / 3.0) / h.L**2 / (0.5 * h.L**2 * h.T), "SOE82"),
        "Y_vdot": (-aspect * sway, "CGH83"),
        "Y_rdot": (-aspect * coupled, "CGH83"),
        "N_vdot": (-aspect * coupled, "CGH83"),
        "N_rdot": (-aspect * max(0.03, 1.0 / 12.0 + 0.017 * h.C_b * B_T - 0.33 * B_L), "CGH83"),
    }


def hull_polynomial(h: HullForm, m_y: float) -> dict[str, float]:
    """The hull in v' = -beta and r'; vv stands for |v| v.

    Linear part by CGH83. Beyond it the regressions disagree, KIJ90 turning wide and YM12 tight, with the
    tests of KVLCC2 and S175 between
    them: we take their mean.
    """
    s, T_L, T_B, L_B = h.C_b * h.B / h.L, h.T / h.L, h.T / h.B, h.L / h.B
    full, fine, lift = T_B * h.C_b, T_B * (1.0 - h.C_b), pi * h.T / h.L
    linear = {
        "Y_v": -lift * (1.0 + 0.4 * h.C_b / T_B), "Y_r": lift * (0.5 - 2.2 / L_B + 0.08 / T_B),
        "N_v": -lift * (0.5 + 2.4 * T_L), "N_r": -lift * (0.25 + 0.039 / T_B - 0.56 / L_B),
    }  # fmt: skip
    surge = {
        "X_vv": 1.15 * s - 0.18,
        "X_vr": (1.66 * h.C_b - 1.525) * m_y,
        "X_rr": 0.01,
        "X_vvvv": 1.1 - 6.68 * s,
    }
    kijima = {
        "Y_vv": -(2.5 * fine + 0.5),
        "Y_rr": 0.343 * full - 0.07,
        "Y_vvr": 1.5 * full - 0.65,
        "Y_vrr": -5.95 * fine,
        "N_vv": 0.96 * fine - 0.066,
        "N_rr": 0.5 * s - 0.09,
        "N_vvr": -(57.5 * s * s - 18.4 * s + 1.6),
        "N_vrr": 0.5 * full - 0.05,
    }
    yoshimura = {
        "Y_vvv": -(0.185 * L_B + 0.48),
        "Y_vvr": -0.75,
        "Y_vrr": -(0.26 * (1.0 - h.C_b) * L_B + 0.11),
        "Y_rrr": -0.051,
        "N_vvv": 0.69 * h.C_b - 0.66,
        "N_vvr": 1.55 * s - 0.76,
        "N_vrr": -(0.075 * (1.0 - h.C_b) * L_B + 0.098),
        "N_rrr": 0.25 * s - 0.056,
    }
    mean = {k: 0.5 * (kijima.get(k, 0.0) + yoshimura.get(k, 0.0)) for k in kijima | yoshimura}
    return surge | linear | mean


def resistance(h: HullForm) -> float:
    """R / (1/2 rho L T U^2) at service speed."""
    surface = 1.7 * h.L * h.T + h.volume / h.T
    reynolds = max(1e5, h.U * h.L / 1.19e-6)
    friction = 0.075 / (log10(reynolds) - 2.0) ** 2
    form = max(0.02, -0.095 + 25.6 * h.C_b / ((h.L / h.B) ** 2 * (h.B / h.T) ** 0.5))
    roughness = min(4e-4, (105.0 * (150e-6 / h.L) ** (1.0 / 3.0) - 0.64) * 1e-3)
    # of the order of Guldhammer & Harvald (1974)
    residual = min(0.012, 4e-4 + 1e-3 * 10.0 ** (5.2 * (h.ratios["Fr"] - 0.27)))
    # 5 % for appendages
    return 1.05 * (friction * (1.0 + form) + roughness + residual) * surface / (h.L * h.T)


def usual_pitch(h: HullForm) -> float:
    """Pitch over diameter of a screw that is usual for a hull as full as this."""
    return min(1.2, max(0.6, 1.7 - 1.2 * h.C_b))


def open_water(pitch_ratio: float) -> dict[str, float]:
    """Thrust coefficient of one screw at rest, and its slope over the advance ratio."""
    K_T0 = 0.43 * pitch_ratio - 0.02
    return {"K_T0": K_T0, "K_T1": -K_T0 / (1.1 * pitch_ratio)}


def propulsion(h: HullForm, pitch_ratio: float, screws: float = 1.0) -> Estimates:
    """Thrust of one screw; wake and thrust deduction of a ship that has one, or more."""
    wake = 0.5 * h.C_b - 0.05 if screws == 1.0 else 0.55 * h.C_b - 0.2
    return {
        **{name: (value, "WAG") for name, value in open_water(pitch_ratio).items()},
        "w": (max(0.0, wake), "TAY43"),
        "t": (0.2, "HAR83"),
    }


def steering(h: HullForm, aspect: float) -> Estimates:
    """Rudder force and what hull and propeller do to it, but for the slipstream."""
    s = h.C_b * h.B / h.L
    gamma, l_R = 2.06 * s + 0.14, 1.7 * s - 1.0
    return {
        "C_L": (6.13 * aspect / (aspect + 2.25), "FUJ61"),
        "t_R": (0.39, "YM12"),
        "a_H": (max(0.0, 0.627 * h.C_b - 0.153), "KIJ90"),
        "x_R": (-0.5, "RULE"),
        "x_H": (-0.45, "YM12"),
        "gamma_v": (gamma, "YM12"),
        "gamma_r": (gamma * l_R, "YM12"),
    }
