"""Four hulls, each number with its source, in the normalisation of the MMG standard method.

Forces / (1/2 rho L d U^2), moments / (1/2 rho L^2 d U^2), masses / (1/2 rho L^2 d), inertias / (1/2 rho
L^4 d); v' = v/U, r' = r L/U; origin midship, x forward, y starboard, z down. Roll levers in metres, below the
centre of gravity.

Sources
  YY15  Yasukawa & Yoshimura (2015), J Mar Sci Technol 20, 37-52: KVLCC2.
  SN81  Son & Nomoto (1981), J. Soc. Naval Arch. Japan 150: container ship S175, with heel; normalised
        by L^2 there, so that every force coefficient is multiplied by L/d = 20.59 here.
  YM12  Yoshimura & Masumoto (2012), MARSIM: training ship Seiun Maru, 105 m, as the mmgdynamics project
        collected it (wake, thrust deduction and masses there from other regressions).
  HK    Froude's law of similitude for lengths, times and rates.
  EST   an estimate of ours, by the rule that stands beside it.
"""

from dataclasses import dataclass, replace
from math import sqrt


@dataclass(frozen=True)
class Hull:
    """One ship afloat; see the module text for units, axes and sources."""

    name: str
    L: float
    B: float
    d: float
    m: float  # mass'
    mx: float  # added mass' in surge, sway; added inertia' in yaw
    my: float
    Jz: float
    x_G: float  # [m] forward of midship
    k_zz: float  # yaw gyration / L
    U0: float  # [m/s] service speed, at which propeller_rate_service drives it
    R0: float  # calm resistance'
    X: tuple  # vv vr rr vvvv
    Y: tuple  # v r vvv vvr vrr rrr
    N: tuple  # v r vvv vvr vrr rrr
    D_P: float  # [m] propeller diameter
    x_P: float  # x_P / L
    t_P: float
    w_P0: float
    K_T: tuple  # k0 k1 k2 of K_T(J)
    C1: float  # wake change with drift: 1 + (1 - exp(-C1 |b|)) (C2 - 1) + C_quad b^2
    C2: tuple  # for b > 0 and b < 0
    A_R: float  # [m2] rudder area
    f_alpha: float
    eta: float  # D_P / rudder height
    kappa: float
    epsilon: float
    t_R: float
    a_H: float
    x_H: float  # x_H / L
    gamma: tuple  # flow straightening for beta_R > 0 and < 0
    l_R: float  # l_R / L
    GM: float  # [m]
    k_xx: float  # roll gyration / B, added inertia included
    z_H: float  # [m] lever of the hull's side force below G
    z_R: float  # [m] lever of the rudder below G
    l_y: float  # [m] lever of the sway added mass below G
    A_F: float  # [m2] frontal and lateral wind areas
    A_L: float
    house: tuple  # Isherwood's A_SS/A_L, S/L, C/L, M
    z_W: float  # [m] wind centre above G
    rudder_rate: float  # [deg/s] steering gear
    rudder_time: float  # [s] its first-order lag
    engine_time: float  # [s]
    noise: tuple  # GNSS [m], ground speed [m/s], heading [deg], yaw rate [deg/s], log [m/s]
    a_y: float = 0.0  # x lever of the sway added mass / L
    r_turn: tuple = (0.0, 0.0)  # rudder inflow: r'^3 and r'^2 v' terms (SN81)
    C_quad: float = 0.0
    heel_X: tuple = (0.0,)  # phi phi
    heel_Y: tuple = (0.0,) * 5  # phi vvphi vphiphi rrphi rphiphi
    heel_N: tuple = (0.0,) * 6  # p phi vvphi vphiphi rrphi rphiphi
    heel_K: tuple = (0.0,) * 12  # v r p phi vvv rrr vvr vrr vvphi vphiphi rrphi rphiphi
    roll_damping: float = 0.05  # share of critical at small angles; grows with the rate (bilge vortices)
    rho: float = 1025.0
    rudder_max: float = 35.0  # [deg]
    scale: float = 1.0  # length / full-scale length, for sea states


kvlcc2 = Hull(
    "kvlcc2",
    L=320.0,
    B=58.0,
    d=20.8,  # YY15
    m=312_600 / (0.5 * 320**2 * 20.8),
    mx=0.022,
    my=0.223,
    Jz=0.011,  # YY15
    x_G=11.2,
    k_zz=0.25,
    U0=15.5 * 0.514444,
    R0=0.022,  # YY15
    X=(-0.040, 0.002, 0.011, 0.771),  # YY15
    Y=(-0.315, 0.083, -1.607, 0.379, -0.391, 0.008),  # YY15
    N=(-0.137, -0.049, -0.030, -0.294, 0.055, -0.013),  # YY15
    D_P=9.86,
    x_P=-0.48,
    t_P=0.220,
    w_P0=0.35,
    K_T=(0.2931, -0.2753, -0.1385),
    C1=2.0,
    C2=(1.6, 1.1),  # YY15
    A_R=112.5,
    f_alpha=2.747,
    eta=0.626,
    kappa=0.50,
    epsilon=1.09,
    t_R=0.387,
    a_H=0.312,
    x_H=-0.464,  # YY15
    gamma=(0.640, 0.395),
    l_R=-0.710,  # YY15
    GM=5.71,
    k_xx=0.44,  # SIMMAN 2008 particulars (k_xx 0.40 + 10 % added inertia, EST)
    z_H=8.2,
    z_R=10.8,
    l_y=8.2,  # EST: mid-draught and mid-rudder below KG 18.6 m
    A_F=1161.0,
    A_L=3258.0,  # loaded KVLCC2
    house=(0.33, 1.25, 0.56, 3.0),
    z_W=8.0,  # EST
    rudder_rate=2.34,
    rudder_time=1.0,
    engine_time=12.0,  # SIMMAN 2008; lags EST
    noise=(0.5, 0.03, 0.10, 0.010, 0.05),
)


LENGTHS = ("L", "B", "d", "x_G", "D_P", "GM", "z_H", "z_R", "l_y", "z_W", "scale")


def froude(hull: Hull, name: str, L: float, rho: float, **changes) -> Hull:
    """The same ship at another length: areas with s^2, times with sqrt(s), rates with 1/sqrt(s) (HK)."""
    s = L / hull.L
    lengths = {f: getattr(hull, f) * s for f in LENGTHS}
    areas = {f: getattr(hull, f) * s * s for f in ("A_R", "A_F", "A_L")}
    times = {f: getattr(hull, f) * sqrt(s) for f in ("U0", "rudder_time", "engine_time")}
    values = {**lengths, **areas, **times, "rudder_rate": hull.rudder_rate / sqrt(s), "rho": rho, **changes}
    return replace(hull, name=name, **values)


# The 7 m model of SIMMAN 2008 and YY15; at model scale the wake is thicker (w_P0 = 0.40, YY15).
kvlcc2_model = froude(
    kvlcc2, "kvlcc2_model", 7.0, 1000.0, w_P0=0.40, engine_time=0.4, noise=(0.01, 0.005, 0.10, 0.05, 0.01)
)


_L_d = 175.0 / 8.5  # SN81 normalises by L^2, we by L d


def _sn(*numbers):
    """SN81's force coefficients in our normalisation."""
    return tuple(n * _L_d for n in numbers)


container = Hull(
    "container",
    L=175.0,
    B=25.4,
    d=8.5,  # SN81
    m=0.00792 * _L_d,
    mx=0.000238 * _L_d,
    my=0.007049 * _L_d,
    Jz=0.000419 * _L_d,  # SN81
    x_G=0.0,
    k_zz=sqrt(0.000456 / 0.00792),
    U0=8.0,
    R0=0.0004226 * _L_d,  # SN81
    X=_sn(-0.00386, -0.00311, 0.00020, 0.0),  # SN81
    Y=_sn(-0.0116, 0.00242, -0.109, 0.0214, -0.0405, 0.00177),  # SN81
    N=_sn(-0.0038545, -0.00222, 0.001492, -0.0424, 0.00156, -0.00229),  # SN81
    D_P=6.533,
    x_P=-0.526,
    t_P=0.175,
    w_P0=0.184,
    K_T=(0.527, -0.455, 0.0),  # SN81
    C1=0.0,
    C2=(1.0, 1.0),
    C_quad=1.09 / 0.816,  # SN81
    A_R=33.0376,
    f_alpha=6.13 * 1.8219 / (1.8219 + 2.25),
    eta=0.631,
    kappa=1.0,
    epsilon=0.921,  # SN81
    t_R=0.29,
    a_H=0.237,
    x_H=-0.48,
    gamma=(0.088, 0.088),
    l_R=-0.156 / 0.088,
    r_turn=(-0.275, 1.96),  # SN81
    GM=0.6,
    k_xx=0.0,  # EST: between SN81's 0.3 m and the 1.0 m usual in seakeeping tests of S175; k_xx below
    z_H=0.0,
    z_R=0.033 * 175,
    l_y=0.0313 * 175,
    a_y=0.05,  # SN81
    heel_X=_sn(-0.00020),
    heel_Y=_sn(-0.000063, 0.04605, 0.00304, 0.009325, -0.001368),  # SN81
    heel_N=_sn(0.000213, -0.0001424, -0.019058, -0.0053766, -0.0038592, 0.0024195),  # SN81
    heel_K=_sn(
        0.0003026,
        -0.000063,
        -0.0000075,
        -0.000021,
        0.002843,
        -0.0000462,
        -0.000588,
        0.0010565,
        -0.0012012,
        -0.0000793,
        -0.000243,
        0.00003569,
    ),  # SN81
    A_F=680.0,
    A_L=2900.0,
    house=(0.20, 1.30, 0.50, 4.0),
    z_W=10.0,  # EST: deck load of three tiers
    rudder_rate=3.0,
    rudder_time=0.8,
    engine_time=5.65 / 1.2,  # rate EST within SOLAS; engine SN81
    noise=(0.5, 0.03, 0.10, 0.012, 0.05),
)
container = replace(container, k_xx=sqrt((0.0000176 + 0.0000034) / 0.00792) * 175 / 25.4)  # SN81

_seiun = Hull(
    "seiun_maru",
    L=105.0,
    B=17.91,
    d=5.966,  # YM12
    m=5701.565 / (0.5 * 105**2 * 5.966),
    mx=0.0087,
    my=0.1576,
    Jz=0.009,  # YM12
    x_G=-2.249,
    k_zz=0.25,
    U0=0.34 * sqrt(9.81 * 105),  # YM12; U0 at Froude number 0.34
    R0=0.024,  # EST: ITTC-57 at 2 m and 1.5 m/s plus residuary 0.0035, wetted surface 3.2 L d
    X=(-0.0804, 0.072, 0.022, 0.439),  # YM12
    Y=(-0.317, 0.052, -1.604, -0.75, -0.8599, -0.051),  # YM12
    N=(-0.1136, -0.0795, -0.3095, -0.6257, -0.3143, -0.0502),  # YM12
    D_P=4.7,
    x_P=-0.48,
    t_P=0.21,
    w_P0=0.204,
    K_T=(0.40, -0.40, 0.0),
    C1=2.0,
    C2=(1.2, 1.2),  # YM12; C2 EST
    A_R=13.405,
    f_alpha=2.88,
    eta=0.90,
    kappa=0.60,
    epsilon=1.033,  # YM12; eta, kappa EST
    t_R=0.341,
    a_H=0.236,
    x_H=-0.40,  # YM12
    gamma=(0.353, 0.353),
    l_R=-0.947,  # YM12, mean of its two sides: this hull is symmetric
    GM=0.9,
    k_xx=0.42,
    z_H=2.2,
    z_R=2.6,
    l_y=2.2,  # EST
    A_F=170.0,
    A_L=900.0,
    house=(0.40, 1.35, 0.48, 2.0),
    z_W=5.0,  # EST
    rudder_rate=4.0,
    rudder_time=0.6,
    engine_time=3.0,
    noise=(0.5, 0.03, 0.1, 0.01, 0.05),
)

# A 2 m uncrewed boat: the Seiun Maru hull form by Froude's law, one propeller, one rudder, batteries low
# (GM EST); noise of a satellite receiver with corrections from ashore.
usv = froude(_seiun, "usv", 2.0, 1025.0, GM=0.04, roll_damping=0.12, noise=(0.02, 0.015, 0.20, 0.15, 0.02))

HULLS = {h.name: h for h in (kvlcc2, kvlcc2_model, container, usv)}
