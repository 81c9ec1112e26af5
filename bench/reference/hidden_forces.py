"""Forces, wear and water hidden in the truth, each at strength s."""

from math import cos, pi, radians, sin, sqrt

from bench.reference import flaws
from bench.reference.hidden_plan import FULL_SCALE, Plan, calm_resistance, either
from bench.reference.weather import strong_waves, strong_wind


def wind(hull, rng, s):
    weather = strong_wind(hull, sqrt(s), float(rng.uniform(0, 360)))
    return Plan(
        weather=weather, truth={"wind_mps": weather["wind_mps"], "wind_from_deg": weather["wind_from_deg"]}
    )


def wave_drift(hull, rng, s):
    weather = strong_waves(hull, s, float(rng.uniform(0, 360)))
    return Plan(
        weather=weather, truth={"height_m": weather["wave_height_m"], "from_deg": weather["wave_from_deg"]}
    )


def cross_flow(hull, rng, s):
    return Plan({"crossflow": 0.4 * s}, truth={"drag_coefficient": 0.4 * s * float(flaws.STRIP_CD.mean())})


def fouling(hull, rng, s):
    return Plan({"fouling": 0.35 * s}, truth={"added_resistance_share": 0.35 * s})


def propeller_wear(hull, rng, s):
    return Plan({"prop_wear": 0.12 * s}, truth={"lost_thrust_share": 0.12 * s})


def rudder_wear(hull, rng, s):
    return Plan({"rudder_wear": 0.25 * s}, truth={"lost_effectiveness_share": 0.25 * s * 0.95})


def rudder_offset(hull, rng, s):
    angle = 2.0 * s * either(rng)
    return Plan({"rudder_offset": radians(angle)}, truth={"offset_deg": 0.97 * angle})


def loading(hull, rng, s):
    """12 % more mass, most of it aft, which nobody told the bridge: draught, centre, inertia, trim."""
    k, x_G = 1 + 0.12 * s, hull.x_G - 0.012 * s * hull.L
    d = hull.d * (1 + 0.11 * s)
    Y, N = list(hull.Y), list(hull.N)
    Y[0], N[0], N[1] = Y[0] * (1 + 0.08 * s), N[0] * (1 - 0.06 * s), N[1] * (1 + 0.06 * s)
    changes = {
        "m": hull.m * k * hull.d / d,
        "d": d,
        "x_G": x_G,
        "k_zz": hull.k_zz * (1 + 0.01 * s),
        "Y": tuple(Y),
        "N": tuple(N),
        "R0": hull.R0 * (1 - 0.06 * s),
    }
    return Plan(
        hull=changes, truth={"mass_share": 0.12 * s, "draught_share": 0.11 * s, "x_G_shift_m": x_G - hull.x_G}
    )


def bank(hull, rng, s):
    return Plan(
        {"bank_Y": 0.05 * s, "bank_N": 0.016 * s},
        weather={"bank_m": 1.2 * hull.B * either(rng)},
        truth={"clearance_m": 1.2 * hull.B},
    )


def tow_force(hull, rng, s):
    R, side = calm_resistance(hull), either(rng)
    X, Y = -0.12 * s * R, 0.15 * s * R * side
    N = 0.25 * hull.L * Y * either(rng)
    period = 1.5 * hull.L / hull.U0
    return Plan(
        {"tow_X": X, "tow_Y": Y, "tow_N": N, "tow_period": period}, truth={"X_N": X, "Y_N": Y, "N_Nm": N}
    )


def external_force(hull, rng, s):
    pull, to = 0.25 * s * calm_resistance(hull), rng.uniform(0, 2 * pi)
    north, east = pull * cos(to), pull * sin(to)
    return Plan(
        {"ext_north": north, "ext_east": east, "ext_period": 2.3 * hull.L / hull.U0},
        truth={"north_N": north, "east_N": east},
    )


def propeller_walk(hull, rng, s):
    return Plan({"walk": 0.06 * s}, truth={"side_share_of_thrust": 0.06 * s})


def roll_coupling(hull, rng, s):
    lost = (0.75 if hull.GM > 0.08 * hull.B else 0.35) * min(s, 1.2)
    return Plan(
        {"heel_N": -0.06 * s, "heel_Y": 0.05 * s},
        hull={"GM": hull.GM * (1 - lost)},
        truth={"N_phi": -0.06 * s, "Y_phi": 0.05 * s, "lost_GM_share": lost},
    )


def current(hull, rng, s):
    speed, to = (0.8 if hull.L > FULL_SCALE else 0.3) * s, float(rng.uniform(0, 360))
    return Plan(
        weather={"current_mps": speed, "current_to_deg": to, "current_spread_mps": 0.03 * speed},
        truth={"north_mps": speed * cos(radians(to)), "east_mps": speed * sin(radians(to))},
    )


def varying_current(hull, rng, s):
    """A tidal stream that turns and waxes within the voyage, plus eddies."""
    speed, to = (0.7 if hull.L > FULL_SCALE else 0.3) * s, float(rng.uniform(0, 360))
    period = 30 * 60.0 * rng.uniform(0.8, 1.2)
    return Plan(
        {"tide_mps": speed, "tide_period": period, "tide_to": radians(to)},
        weather={"current_spread_mps": 0.3 * speed, "current_time_s": 240.0},
        truth={"amplitude_mps": speed, "period_s": period},
    )


def shallow_water(hull, rng, s):
    share = min(0.67 * s**0.4, 0.85)  # draught / depth
    depth, heavier = hull.d / share, flaws.shallow(share)[2]
    return Plan(
        hull={"my": hull.my * heavier, "Jz": hull.Jz * heavier},
        weather={"depth_m": depth, "depth_swing": 0.08},
        truth={"depth_over_draught": depth / hull.d},
    )


def steering_lag(hull, rng, s):
    delay = 0.05 * s * hull.L / hull.U0
    return Plan(
        {"lag_time": delay, "lag_rate": 1 / (1 + 1.2 * s)},
        truth={"delay_s": delay + hull.rudder_time, "rate_degps": hull.rudder_rate / (1 + 1.2 * s)},
    )
