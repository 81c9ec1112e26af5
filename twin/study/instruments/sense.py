"""What each instrument says of a path and a stream: prediction, and its slopes by states (exact) and by
shared numbers (differences).

`theta` (P,) holds the shared numbers in their own units; `rows`, where given, gets the slopes by the states.

Frames: north-east; the ship's axes ahead and to starboard. s = t - latency; R turns ship to earth.
    place     (N, E)(s) + R(psi) (a_x, a_y + a_z sin(phi))
    velocity  d/dt of that, smoothed: int exp(-q) V(s - T q) dq;
              of a receiver with its own attitude in the ship's axes at s
    heading   psi(s) + A + B sin psi + C cos psi + D sin 2 psi + E cos 2 psi
    rate      (1 + k_r) d psi/dt (s) + bias
    log       (1 + k)(u_r cos m + v_r sin m) + b,
    log aside (1 + k)(v_r cos m - u_r sin m);   (u_r, v_r) = R^T (V - stream)
    wind      turned by the vane: R^T ((1 + k_w) V - W), W = (1 + k_w) air, the wind as this anemometer would
              show it at rest. W is the state: were it the air, a larger k_w would make its steps smaller and
              be preferred for that alone
    drift     0 = v_r(t + l) - d_1 r - d_2 dr/dt - d_3 r |r| / r_0 - leeway V_a v_a / U, the ship's sway l
              later than its turn: so a late position looks to it, too, and only other instruments tell that
"""

import numpy as np

from twin.study.instruments.here import Here, Theta, at, get, stream_at
from twin.study.instruments.problem import NODES, SHARES, Problem, Rows


def place(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(2 N,) the antenna's place [m] at each reading: all north, then all east. Its height counts where roll
    was read, with the roll at the reading's own time."""
    t, n = p.by["place"].t, p.by["place"].t.size
    here = at(p, t, get(theta, "gnss_delay"))
    ahead, aside = get(theta, "antenna_ahead"), np.full(n, get(theta, "antenna_starboard"))
    if "roll" in p.by:
        aside = aside + get(theta, "antenna_above") * np.sin(
            np.interp(t, p.by["roll"].t, p.by["roll"].y[:, 0])
        )
    if rows:
        rows.add(0, p.at[0][:, 0], here.weights(0))
        rows.add(n, p.at[0][:, 1], here.weights(0))
        rows.add(0, p.at[0][:, 2], here.weights(0), -ahead * here.s - aside * here.c)
        rows.add(n, p.at[0][:, 2], here.weights(0), ahead * here.c - aside * here.s)
    return np.concatenate(
        [here.x[:, 0] + ahead * here.c - aside * here.s, here.x[:, 1] + ahead * here.s + aside * here.c]
    )


def velocity(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(2 N,) the antenna's velocity over ground [m/s] at each reading: all ahead, then all to starboard, of a
    receiver with its own attitude; else all north, then all east."""
    t, n = p.by["velocity"].t, p.by["velocity"].t.size
    late, T = get(theta, "gnss_delay"), get(theta, "smoothing")
    now = at(p, t, late)
    ahead, aside = get(theta, "antenna_ahead"), get(theta, "antenna_starboard")
    north, east = np.zeros(n), np.zeros(n)
    c, s = (now.c, now.s) if p.own else (np.ones(n), np.zeros(n))
    for q, share in zip(NODES, SHARES, strict=True) if abs(T) > 1e-9 else ((0.0, 1.0),):
        h = at(p, t, late, float(T * q))
        r = h.v[:, 2]
        swing_n, swing_e = -ahead * h.s - aside * h.c, ahead * h.c - aside * h.s
        north, east = north + share * (h.v[:, 0] + r * swing_n), east + share * (h.v[:, 1] + r * swing_e)
        if rows:
            one, none = np.ones(n), np.zeros(n)
            for j, (dn, de) in enumerate(((one, none), (none, one), (swing_n, swing_e))):
                rows.add(0, p.at[0][:, j], h.weights(1), share * (dn * c + de * s))
                rows.add(n, p.at[0][:, j], h.weights(1), share * (de * c - dn * s))
            if ahead or aside:
                dn, de = -r * swing_e, r * swing_n
                rows.add(0, p.at[0][:, 2], h.weights(0), share * (dn * c + de * s))
                rows.add(n, p.at[0][:, 2], h.weights(0), share * (de * c - dn * s))
    u, v = north * c + east * s, east * c - north * s
    if rows and p.own:
        rows.add(0, p.at[0][:, 2], now.weights(0), v)
        rows.add(n, p.at[0][:, 2], now.weights(0), -u)
    return np.concatenate([u, v])


def heading(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(N,) heading [rad] that a late compass with a bias and a deviation shows at each reading."""
    here = at(p, p.by["heading"].t, get(theta, "heading_delay"))
    A, B, C, D, E = (get(theta, k) for k in "ABCDE")
    c, s = here.c, here.s
    if rows:
        bent = B * c - C * s + 2.0 * D * (c * c - s * s) - 4.0 * E * s * c
        rows.add(0, p.at[0][:, 2], here.weights(0), 1.0 + bent)
    return np.asarray(here.x[:, 2] + A + B * s + C * c + 2.0 * D * s * c + E * (c * c - s * s))


def rate(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(N,) rate of turn [rad/s] that a late rate gyro with a bias and a scale shows at each reading."""
    here, scale = at(p, p.by["rate"].t, get(theta, "rate_delay")), 1.0 + get(theta, "gyro_scale")
    if rows:
        rows.add(0, p.at[0][:, 2], here.weights(1), scale)
    return np.asarray(scale * here.v[:, 2] + get(theta, "gyro_bias"))


def _through_water(here: Here, theta: Theta) -> tuple[np.ndarray, np.ndarray]:
    north, east = stream_at(here, theta)
    return here.body(here.v[:, 0] - north, here.v[:, 1] - east)


def _turned(
    p: Problem,
    rows: Rows,
    here: Here,
    u: np.ndarray,
    v: np.ndarray,
    a: float | np.ndarray,
    b: float | np.ndarray,
) -> None:
    """Slopes of a u_r + b v_r by the states."""
    dn, de = a * here.c - b * here.s, a * here.s + b * here.c
    for j, d in enumerate((dn, de)):
        rows.add(0, p.at[0][:, j], here.weights(1), d)
        rows.add(0, p.at[1][:, j], here.slow, -d)
    rows.add(0, p.at[0][:, 2], here.weights(0), a * v - b * u)


def _log(p: Problem, theta: Theta, rows: Rows | None, aside: bool) -> np.ndarray:
    here = at(p, p.by["log aside" if aside else "log"].t, get(theta, "log_delay"))
    u, v = _through_water(here, theta)
    k, c, s = 1.0 + get(theta, "log_scale"), np.cos(get(theta, "log_angle")), np.sin(get(theta, "log_angle"))
    if "log aside" not in p.by:
        c = 1.0  # what is lost ahead is a scale to a log of one axis
    a, b = (-k * s, k * c) if aside else (k * c, k * s)
    if rows:
        _turned(p, rows, here, u, v, a, b)
    return np.asarray(a * u + b * v + (0.0 if aside else get(theta, "log_bias")))


def log(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(N,) speed through the water [m/s] along the log's axis at each reading. Of a log of one axis, what its
    angle loses ahead is left to its scale."""
    return _log(p, theta, rows, False)


def log_aside(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(N,) speed through the water [m/s] across the log's axis, to starboard, at each reading: scale and
    angle are those of `log`; there is no bias."""
    return _log(p, theta, rows, True)


def drift(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(N,) speed to starboard through the water [m/s] beyond what turning and wind make of it, at the times
    of the grid: nothing is expected. `rows` gets no slopes of the leeway."""
    here, later = at(p, p.grid), at(p, p.grid, -get(theta, "drift_late"))
    north, east = stream_at(here, theta)
    u, v = here.body(later.v[:, 0] - north, later.v[:, 1] - east)
    r, r_dot = here.v[:, 2], here.a[:, 2]
    d1, d2, d3 = (get(theta, k) for k in ("drift_r", "drift_rr", "drift_r_r"))
    usual = 0.1 * p.readings.speed / p.length
    if rows:
        for j, d in enumerate((-here.s, here.c)):
            rows.add(0, p.at[0][:, j], later.weights(1), d)
            rows.add(0, p.at[1][:, j], here.slow, -d)
        rows.add(0, p.at[0][:, 2], here.weights(0), -u)
        rows.add(0, p.at[0][:, 2], here.weights(1), -d1 - 2.0 * d3 * np.abs(r) / usual)
        rows.add(0, p.at[0][:, 2], here.weights(2), -d2)
    return np.asarray(
        v - d1 * r - d2 * r_dot - d3 * r * np.abs(r) / usual - get(theta, "leeway") * blown(p, here)
    )


def has_way_ahead(p: Problem, theta: Theta) -> np.ndarray:
    """(N,) whether the ship goes ahead through the water, at the times of the grid. Where it does not, it
    turns about another point than its drift's formula has: astern the pivot point lies abaft of midship."""
    return np.asarray(_through_water(at(p, p.grid), theta)[0] > 0.0)


def blown(p: Problem, here: Here) -> np.ndarray:
    """(N,) at the times of the grid: apparent wind speed times its part from abeam, toward starboard, over
    the ship's speed [m/s], beyond what it would be in still air: what a leeway of 1 would be."""
    if "wind" not in p.by:
        return np.zeros(p.grid.size)
    w = p.by["wind"]
    push = np.interp(p.grid, w.t, -np.hypot(*w.y.T) * w.y[:, 1])
    u, v = here.body(here.v[:, 0], here.v[:, 1])
    return np.asarray((push + np.hypot(u, v) * v) / p.readings.speed)


def wind(p: Problem, theta: Theta, rows: Rows | None) -> np.ndarray:
    """(2 N,) apparent wind [m/s] that the anemometer shows at each reading, positive from ahead and from
    starboard: all ahead, then all to starboard. For a problem whose wind was read."""
    t, n = p.by["wind"].t, p.by["wind"].t.size
    assert p.wind is not None
    here, slow = at(p, t), p.wind.weights(t)
    k, c, s = 1.0 + get(theta, "wind_scale"), np.cos(get(theta, "vane")), np.sin(get(theta, "vane"))
    shown = p.wind.value(p.x[p.at[2]], slow)  # k air
    u, v = here.body(k * here.v[:, 0] - shown[:, 0], k * here.v[:, 1] - shown[:, 1])
    for first, a, b in ((0, c, -s), (n, s, c)) if rows else ():
        assert rows is not None
        for j, d in enumerate((a * here.c - b * here.s, a * here.s + b * here.c)):
            rows.add(first, p.at[0][:, j], here.weights(1), k * d)
            rows.add(first, p.at[2][:, j], slow, -d)
        rows.add(first, p.at[0][:, 2], here.weights(0), a * v - b * u)
    return np.concatenate([u * c - v * s, u * s + v * c])
