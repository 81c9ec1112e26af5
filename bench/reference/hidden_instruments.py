"""Faults of instruments hidden in the truth, each at strength s."""

from math import degrees, radians

from bench.reference.hidden_plan import Plan, either


def heading_bias(hull, rng, s):
    bias = radians(2.0 * s) * either(rng)
    return Plan({"heading_bias": bias, "heading_wave": 0.15 * bias}, truth={"bias_deg": degrees(bias)})


def log_bias(hull, rng, s):
    bias = 0.035 * s * hull.U0 * either(rng)
    return Plan({"log_bias": bias}, truth={"surge_bias_mps": bias})


def log_scale(hull, rng, s):
    scale = 0.06 * s * either(rng)
    return Plan({"log_scale": scale}, truth={"scale_share": scale})


def log_misalignment(hull, rng, s):
    angle = radians(2.5 * s) * either(rng)
    return Plan({"log_angle": angle}, truth={"angle_deg": degrees(angle)})


def antenna_offset(hull, rng, s):
    x, y = 0.25 * s * hull.L * either(rng), 0.2 * s * hull.B * either(rng)
    return Plan({"antenna_x": x, "antenna_y": y}, truth={"x_m": x, "y_m": y})


def sensor_delay(hull, rng, s):
    delay = s * (0.05 * hull.L / hull.U0 + 0.35)
    return Plan({"gnss_delay": delay}, truth={"delay_s": delay})


def gyro_bias(hull, rng, s):
    bias = 0.02 * s * hull.U0 / hull.L * either(rng)
    return Plan({"gyro_bias": bias}, truth={"bias_degps": degrees(bias)})
