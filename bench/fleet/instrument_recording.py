"""What the instruments of a ship write down: noise, lateness, small faults that are usual on this ship,
steps of
quantisation, gaps; and the faults that are hidden."""

import numpy as np
from scipy.signal import lfilter

from bench.fleet.fleet_weather import FleetWeather, apparent, wander
from bench.fleet.hidden_causes import Flaws
from bench.fleet.random_ship import RandomShip


def record(
    ship: RandomShip,
    true: dict[str, np.ndarray],
    weather: FleetWeather,
    seed: int,
    flaws: Flaws | None = None,
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times and columns as the twin reads them."""
    f, k, p = flaws or Flaws(), ship.kit, ship.p
    rng = np.random.default_rng([seed, 13])
    dt = float(true["t"][1] - true["t"][0])
    every = max(1, round(k.every_s / dt))
    t = true["t"][::every]

    def noise(sd: float) -> np.ndarray:
        return sd * rng.standard_normal(t.size)

    def at(name: str, late: float) -> np.ndarray:
        return np.interp(t - late, true["t"], true[name])

    def step(values: np.ndarray, size: float) -> np.ndarray:
        return np.round(values / size) * size if k.coarse else values

    late = k.gnss_late + f.late_s
    psi, heel = at("psi", late), at("heel", late)
    ax, ay = k.arm[0] + f.antenna[0], k.arm[1] + f.antenna[1]
    high = k.high if k.has_roll else 0.0
    ay = ay - high * np.sin(heel)
    drifts = [
        wander(rng, 120.0, dt * every, t.size) * k.gnss_wander
        + wander(rng, 400.0, dt * every, t.size) * f.wander
        for _ in range(2)
    ]
    c = {
        "north_m": at("x", late) + np.cos(psi) * ax - np.sin(psi) * ay + drifts[0] + noise(k.gnss),
        "east_m": at("y", late) + np.sin(psi) * ax + np.cos(psi) * ay + drifts[1] + noise(k.gnss),
    }
    slow = k.speed_late + f.late_s
    r = at("r", slow)
    swing = np.interp(t - slow, true["t"], np.gradient(np.sin(true["heel"]), dt))
    u, v = at("u", slow) - r * ay + noise(k.speed), at("v", slow) + r * ax - high * swing + noise(k.speed)
    c["surge_velocity_mps"], c["sway_velocity_mps"] = step(u, 0.05), step(v, 0.05)
    seen = true["psi"]
    if f.compass_s:
        a = dt / (dt + f.compass_s)
        seen = seen[0] + lfilter([a], [1, a - 1], seen - seen[0])
    seen = np.interp(t, true["t"], seen)
    seen = seen + k.heading_bias + f.heading + (k.deviation + f.deviation) * np.sin(seen + 0.4)
    c["heading_true_north_deg"] = step(np.degrees(seen + noise(k.heading)), 0.1) % 360
    if k.by_course:
        over_ground = step(np.hypot(u, v), 0.05)
        course = np.radians(step(np.degrees(np.arctan2(v, u) + at("psi", slow)), 0.1))
        drift = course - np.radians(c["heading_true_north_deg"])
        c["surge_velocity_mps"], c["sway_velocity_mps"] = (
            over_ground * np.cos(drift),
            over_ground * np.sin(drift),
        )
    c["yaw_rate_degps"] = step(
        np.degrees((1 + f.rate_scale) * at("r", 0.0) + k.rate_bias + f.gyro + noise(k.rate)), 0.01
    )
    if k.has_log:
        u, v = at("u_r", k.log_late), at("v_r", k.log_late)
        a, scale = k.log_angle + f.log_angle, 1 + k.log_scale + f.log_scale * (0.9 + 0.1 * np.abs(u) / p.U0)
        bias = f.log_bias * (0.85 + 0.15 * np.abs(u) / p.U0)
        c["surge_velocity_through_water_mps"] = step(
            scale * (np.cos(a) * u + np.sin(a) * v) + bias + noise(k.log), 0.05
        )
        c["sway_velocity_through_water_mps"] = step(
            scale * (np.cos(a) * v - np.sin(a) * u) + noise(k.log), 0.05
        )
    gear = "order" if ship.drive.ordered else "rudder"
    c["rudder_angle_deg"] = step(np.degrees(at(gear, 0.0)) + noise(0.05), 0.1)
    c["propeller_rate_rpm"] = 60 * at("n", 0.0) * (1 + noise(0.002))
    if k.has_wind:
        seen_wind = [
            apparent(w, a - h, u, v)
            for w, a, h, u, v in zip(
                at("wind", 0.0), at("wind_from", 0.0), at("psi", 0.0), at("u", 0.0), at("v", 0.0), strict=True
            )
        ]
        speed, angle = np.array(seen_wind).T
        speed, angle = speed * k.wind_factor * (1 + noise(0.05)), angle + k.wind_angle + noise(0.05)
        ahead, aside = (
            speed * np.cos(angle) - c["surge_velocity_mps"],
            speed * np.sin(angle) - c["sway_velocity_mps"],
        )
        c["true_wind_speed_mps"] = np.hypot(ahead, aside)
        c["true_wind_direction_deg"] = np.degrees(np.arctan2(aside, ahead) + seen) % 360
    one = np.ones(t.size)
    if k.has_sea:
        c["wave_height_significant_m"] = max(0.0, weather.swell * (1 + 0.1 * rng.standard_normal())) * one
        c["wave_period_peak_s"] = weather.swell_s * one
        c["wave_direction_deg"] = np.degrees(weather.swell_from + 0.15 * rng.standard_normal()) % 360 * one
    if k.has_roll:
        c["roll_deg"] = -np.degrees(at("heel", 0.0)) + noise(0.1)  # heel is to port, roll to starboard
    if k.has_depth:
        c["water_depth_m"] = np.minimum(weather.depth, 15 * p.T) * (1 + noise(0.01))
    if k.has_bank:
        for name, sign in (("port", -1), ("starboard", 1)):
            there = abs(weather.bank) if weather.bank * sign > 0 else 20 * p.B
            c[f"bank_distance_{name}_m"] = there * (1 + noise(0.02))
    if k.lost:
        gone = rng.random((2, t.size)) < k.lost
        for name in ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps"):
            c[name] = np.where(gone[0], np.nan, c[name])
    return t, c
