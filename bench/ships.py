"""The bundled ship files, made from published numbers: `python -m bench.ships` writes them and prints their
sea trials.

The published tables stand in bench/reference/hulls.py (MMG: polynomials in v', r'). The twin writes the same
ships in another form, the core's modulus form, by least squares (twin/study/first_model/modulus.py); so a
bundled ship is a good nominal model and not the truth of any voyage of the reference sea, and nothing here
was fitted to one."""

import sys
from math import pi
from pathlib import Path

import numpy as np

from bench.reference.hulls import HULLS, Hull
from twin.physics.model import Model
from twin.physics.ship import DERIVATIVES, PARTICULARS, Derivatives, Ship, save
from twin.study.first_model.modulus import WORKING_J, error_share, modulus_form, slipstream
from twin.study.prediction.trial import straight_line_stability, turning_circle, zigzag

FOLDER = Path(__file__).parent.parent / "twin" / "ships"
NAMES = {
    "kvlcc2": "KVLCC2",
    "kvlcc2_model": "KVLCC2 model, 7 m",
    "usv": "USV, 2 m",
    "container": "S175 container ship",
}
SOURCES = {
    "YY15": "Yasukawa & Yoshimura (2015) J. Mar. Sci. Technol. 20, 37-52, tables 1-4",
    "SN81": "Son & Nomoto (1981) J. Soc. Naval Arch. Japan 150, made non-dimensional by L T instead of L^2",
    "YM12": "Yoshimura & Masumoto (2012) MARSIM: Seiun Maru, 105 m, by Froude's law to 2 m",
    "LSQ": "the published polynomial in modulus form, by least squares over |beta| <= 25 deg, |r'| <= 0.9 "
    "(bench/ships.py)",
    "EST": "an estimate for a ship of this type, or by the rule that stands beside it",
}
SOURCE = {"kvlcc2": "YY15", "kvlcc2_model": "YY15", "usv": "YM12", "container": "SN81"}
TURN = 0.4  # r' at which a rudder inflow of third order (SN81) is made linear

# Free-running tests of the 7 m model (SIMMAN 2008, MARIN), scaled to the ship: first and second overshoot
# [deg] to starboard and to port.
MEASURED_ZIGZAG = {10: ((8.0, 22.1), (9.4, 15.1)), 20: ((12.8, 15.8), (15.6, 12.8))}
TURNING_CLASS = "about 3.3 L and 3.4 L (model tests, 35 deg)"


def published(h: Hull) -> dict[str, float]:
    """The hull's polynomial, by name."""
    terms = ("v", "r", "vvv", "vvr", "vrr", "rrr")
    out = {f"X_{t}": value for t, value in zip(("vv", "vr", "rr", "vvvv"), h.X, strict=True)}
    return (
        out
        | {f"{a}_{t}": x for a, row in (("Y", h.Y), ("N", h.N)) for t, x in zip(terms, row, strict=True)}
        | {"R0": h.R0}
    )


def thrust_line(h: Hull) -> tuple[float, float]:
    """K_T0 and K_T1 of the straight line nearest to K_T(J) where it is positive."""
    K = np.polynomial.Polynomial(h.K_T)(WORKING_J)
    slope, start = np.polyfit(WORKING_J[K > 0], K[K > 0], 1)
    return float(start), float(slope)


def derivatives(h: Hull) -> dict[str, float]:
    """Everything the core needs, in prime form."""
    K_T0, K_T1 = thrust_line(h)
    epsilon, kappa = slipstream(K_T0, K_T1, h.epsilon, h.kappa, h.eta)
    gamma = sum(h.gamma) / 2.0
    inflow = {"gamma_v": gamma + h.r_turn[1] * TURN**2, "gamma_r": gamma * h.l_R + h.r_turn[0] * TURN**2}
    hull = modulus_form(published(h), h.mx, h.my)
    added = {
        "X_udot": -h.mx,
        "Y_vdot": -h.my,
        "N_rdot": -h.Jz,
        "Y_rdot": -h.my * h.a_y,
        "N_vdot": -h.my * h.a_y,
    }
    engine = {"K_T0": K_T0, "K_T1": K_T1, "t": h.t_P, "w": h.w_P0, "epsilon": epsilon, "kappa": kappa}
    blade = {"C_L": h.f_alpha, "t_R": h.t_R, "a_H": h.a_H, "x_R": -0.5, "x_H": h.x_H} | inflow
    return {k: float(f"{v:.5g}") + 0.0 for k, v in (added | hull | engine | blade).items()}


NOTES = {
    "X_u": "none was published",
    "X_uuu": "none was published",
    "Y_v": "none was published",
    "N_r": "none was published",
    "K_T0": "K_T(J) as a straight line over 0.05 < J < 0.8",
    "K_T1": "see K_T0",
    "epsilon": "inflow at the rudder as eps^2 (u_a^2 + kappa 8T/(pi rho D^2))",
    "kappa": "see epsilon",
    "gamma_v": "mean of both sides",
    "gamma_r": "mean of both sides times l_R",
    "gamma_a": "mean of both sides",
    "x_R": "at the aft perpendicular",
}


def how(name: str, source: str) -> str:
    """Where a derivative comes from."""
    hull = (
        name[0] in "XYN" and name not in ("X_uu", "X_uuu", "X_u", "Y_v", "N_r") and not name.endswith("dot")
    )
    note = "LSQ" if hull else NOTES.get(name)
    return note if note and note.startswith("none") else "; ".join(filter(None, (source, note)))


def ship(key: str) -> Ship:
    """One bundled ship."""
    h, source = HULLS[key], SOURCE[key]
    m = h.m * 0.5 * h.rho * h.L**2 * h.d
    values = {
        "L_pp": h.L,
        "B": h.B,
        "T": h.d,
        "m": m,
        "C_b": m / (h.rho * h.L * h.B * h.d),
        "x_G": h.x_G,
        "I_z": m * ((h.k_zz * h.L) ** 2 + h.x_G**2),
        "rho": h.rho,
        "U_0": h.U0,
        "D_P": h.D_P,
        "A_R": h.A_R,
        "A_F": h.A_F,
        "A_L": h.A_L,
    }
    values = {k: float(f"{v:.6g}") for k, v in values.items()}
    notes = {
        "C_b": "m/(rho L B T)",
        "I_z": f"m ((k_zz L)^2 + x_G^2), k_zz = {h.k_zz:.3g}",
        "rho": "fresh water of a tank" if h.rho < 1010 else "sea water",
        "A_F": "EST",
        "A_L": "EST",
    }
    d = derivatives(h)
    sources = {
        "particulars": {k: {"value": values[k], "source": notes.get(k, source)} for k in values},
        "derivatives": {
            f.name: {"value": d.get(f.name, 0.0), "source": how(f.name, source)} for f in DERIVATIVES
        },
    }
    used = {"LSQ", "EST", source}
    sources["sources"] = {k: text for k, text in SOURCES.items() if k in used}
    filled = {f.name: d.get(f.name, 0.0) for f in DERIVATIVES}
    assert set(values) == {f.name for f in PARTICULARS}
    return Ship(NAMES[key], **values, derivatives=Derivatives(**filled), notes=sources)


def trials(key: str) -> str:
    """A ship's sea trials in words and numbers."""
    model, h = Model.of(ship(key)), HULLS[key]
    rate = h.rudder_rate * pi / 180.0
    lines = [
        f"{NAMES[key]}: modulus form off by "
        f"{' and '.join(f'{100 * e:.0f} %' for e in error_share(published(h), derivatives(h), h.mx, h.my))}"
    ]
    lines[0] += f" (sway, yaw, rms); straight-line stability C' = {straight_line_stability(model):+.4f}"
    for side, sign in (("starboard", 1.0), ("port", -1.0)):
        c = turning_circle(model, sign * 35.0 * pi / 180.0, rate=rate)
        lines.append(
            f"  35 deg to {side:9}: advance {c.advance:.2f} L, transfer {c.transfer:.2f} L, tactical "
            f"diameter {c.tactical_diameter:.2f} L,"
            f" speed left {100 * c.speed_left:.0f} %"
        )
    if key.startswith("kvlcc2"):
        lines.append(f"    published: advance and tactical diameter {TURNING_CLASS}")
    for angle in (10, 20):
        over = zigzag(model, angle * pi / 180.0, angle * pi / 180.0, rate=rate)
        lines.append(f"  {angle}/{angle} zigzag: overshoots {', '.join(f'{o:.1f}' for o in over[:3])} deg")
        if key.startswith("kvlcc2"):
            starboard, port = MEASURED_ZIGZAG[angle]
            lines.append(
                f"    measured (SIMMAN 2008, MARIN): {starboard[0]}, {starboard[1]} to starboard first; "
                f"{port[0]}, {port[1]} to port first"
            )
    return "\n".join(lines)


def main() -> int:
    """Write all bundled ship files and print their trials."""
    for key in NAMES:
        save(ship(key), FOLDER / f"{key}.toml")
        print(trials(key))
    return 0


if __name__ == "__main__":
    sys.exit(main())
