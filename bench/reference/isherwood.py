"""Wind on hull and house from Isherwood's regression, tabulated every ten degrees of apparent wind.

    X = q A_F C_X(g),  Y = -sign(g) q A_L C_Y(|g|),  N = -sign(g) q A_L L C_N(|g|),  q = 1/2 rho_air V^2
    g: where the apparent wind comes from, off the bow, starboard positive.
Source: Isherwood (1972), Wind resistance of merchant ships, Trans. RINA 115, 327-338: coefficients A, B, C.
"""

import numpy as np

RHO_AIR = 1.224
TABLE_STEP_DEG = 10.0
_A = """2.152 -5.00 .243 -.164 0 0 0|1.714 -3.33 .145 -.121 0 0 0|1.818 -3.97 .211 -.143 0 0 .033
|1.965 -4.81 .243 -.154 0 0 .041|2.333 -5.99 .247 -.190 0 0 .042|1.726 -6.54 .189 -.173 .348 0 .048
|.913 -4.68 0 -.104 .482 0 .052|.457 -2.88 0 -.068 .346 0 .043|.341 -.91 0 -.031 0 0 .032
|.355 0 0 0 -.247 0 .018|.601 0 0 0 -.372 0 -.020|.651 1.29 0 0 -.582 0 -.031
|.564 2.54 0 0 -.748 0 -.024|-.142 3.58 0 .047 -.700 0 -.028|-.677 3.64 0 .069 -.529 0 -.032
|-.723 3.14 0 .064 -.475 0 -.032|-2.148 2.56 0 .081 0 1.27 -.027|-2.707 3.97 -.175 .126 0 1.81 0
|-2.529 3.76 -.174 .128 0 1.55 0"""
_B = """0 0 0 0 0 0 0|.096 .22 0 0 0 0 0|.176 .71 0 0 0 0 0|.225 1.38 0 .023 0 -.29 0
|.329 1.82 0 .043 0 -.59 0|1.164 1.26 .121 0 -.242 -.95 0|1.163 .96 .101 0 -.177 -.88 0
|.916 .53 .069 0 0 -.65 0|.844 .55 .082 0 0 -.54 0|.889 0 .138 0 0 -.66 0|.799 0 .155 0 0 -.55 0
|.797 0 .151 0 0 -.55 0|.996 0 .184 0 -.212 -.66 .34|1.014 0 .191 0 -.280 -.69 .44
|.784 0 .166 0 -.209 -.53 .38|.536 0 .176 -.029 -.163 0 .27|.251 0 .106 -.022 0 0 0
|.125 0 .046 -.012 0 0 0|0 0 0 0 0 0 0"""
_C = """0 0 0 0 0 0|.0596 .061 0 0 0 -.074|.1106 .204 0 0 0 -.170|.2258 .245 0 0 0 -.380
|.2017 .457 0 .0067 0 -.472|.1759 .573 0 .0118 0 -.523|.1925 .480 0 .0115 0 -.546
|.2133 .315 0 .0081 0 -.526|.1827 .254 0 .0053 0 -.443|.2627 0 0 0 0 -.508
|.2102 0 -.0195 0 .0335 -.492|.1567 0 -.0258 0 .0497 -.457|.0801 0 -.0311 0 .0740 -.396
|-.0189 0 -.0488 .0101 .1128 -.420|.0256 0 -.0422 .0100 .0889 -.463|.0552 0 -.0381 .0109 .0689 -.476
|.0881 0 -.0306 .0091 .0366 -.415|.0851 0 -.0122 .0025 0 -.220|0 0 0 0 0 0"""


def _numbers(text):
    return np.array([[float(x) for x in row.split()] for row in text.split("|")])


A, B, C = map(_numbers, (_A, _B, _C))


def table(hull):
    """C_X, C_Y, C_N of one hull at 0, 10 ... 180 degrees, shape (3, 19)."""
    a_ss, s, c, masts = hull.house
    shape = [1, 2 * hull.A_L / hull.L**2, 2 * hull.A_F / hull.B**2, hull.L / hull.B, s, c]
    return np.stack([-(A @ np.array([*shape, masts])), B @ np.array([*shape, a_ss]), C @ np.array(shape)])


def force(h, tables, u_air, v_air):
    """X, Y, N, K of air that comes from (u_air ahead, v_air starboard) [m/s]; tables (B, 3, 19)."""
    speed2 = u_air**2 + v_air**2
    angle = np.abs(np.degrees(np.arctan2(v_air, u_air))) / TABLE_STEP_DEG
    low = np.minimum(angle.astype(int), 17)
    rest, rows = angle - low, np.arange(len(low))
    near, far = tables[rows, :, low].T, tables[rows, :, low + 1].T
    cx, cy, cn = near + rest * (far - near)
    q, side = 0.5 * RHO_AIR * speed2, np.sign(v_air)
    aside = -side * q * h.A_L
    Y = aside * cy
    return q * h.A_F * cx, Y, aside * h.L * cn, h.z_W * Y
