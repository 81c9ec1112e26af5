"""What the ship's instruments report: noise, own rates, latency, dropouts, and the faults hidden in them.

Body velocities over ground come from a satellite and inertial unit with an attitude of its own, so that a
wrong compass does not turn them.
"""

import numpy as np

from bench.reference.chance import Chance

COLUMNS = [
    "time_s",
    "north_m",
    "east_m",
    "heading_true_north_deg",
    "surge_velocity_mps",
    "sway_velocity_mps",
    "surge_velocity_through_water_mps",
    "sway_velocity_through_water_mps",
    "yaw_rate_degps",
    "rudder_angle_deg",
    "propeller_rate_rpm",
    "true_wind_speed_mps",
    "true_wind_direction_deg",
    "apparent_wind_speed_mps",
    "apparent_wind_angle_deg",
    "water_depth_m",
    "wave_height_significant_m",
    "wave_period_peak_s",
    "wave_direction_deg",
    "draught_mean_m",
    "bank_distance_port_m",
    "bank_distance_starboard_m",
    "roll_deg",
]

# instrument: seconds between samples, seconds late, share of samples lost, its columns
INSTRUMENTS = {
    "gnss": (0.2, 0.1, 0.002, "north_m east_m surge_velocity_mps sway_velocity_mps"),
    "compass": (0.1, 0.0, 0.0005, "heading_true_north_deg yaw_rate_degps roll_deg"),
    "log": (0.5, 0.2, 0.005, "surge_velocity_through_water_mps sway_velocity_through_water_mps"),
    "rudder": (0.1, 0.0, 0.0, "rudder_angle_deg"),
    "engine": (0.5, 0.0, 0.0, "propeller_rate_rpm"),
    "anemometer": (
        1.0,
        0.0,
        0.002,
        "true_wind_speed_mps true_wind_direction_deg apparent_wind_speed_mps apparent_wind_angle_deg",
    ),
    "sounder": (1.0, 0.0, 0.01, "water_depth_m"),
    "shore": (1.0, 0.0, 0.0, "bank_distance_port_m bank_distance_starboard_m"),
    "bridge": (
        60.0,
        0.0,
        0.0,
        "wave_height_significant_m wave_period_peak_s wave_direction_deg draught_mean_m",
    ),
}
DELAYED = ("north", "east", "psi", "u", "v", "r", "u_r", "v_r")
MEMORY = 1024  # ticks that a late instrument may look back
DEEP, OPEN = (
    12.0,
    20.0,
)  # reported depth / draught and bank distance / beam where there is neither bottom nor bank


class SensorSuite:
    """Turns the truth of each tick into measured columns (B,), NaN where an instrument has no sample."""

    def __init__(self, h, f, draught, weathers, seeds, dt, perfect):
        self.h, self.f, self.dt, self.draught = h, f, dt, draught
        self.noise, self.lost = Chance(seeds, 3, 24), Chance(seeds, 5, len(INSTRUMENTS))
        self.perfect, self.ring = np.array(perfect), np.zeros((MEMORY, len(DELAYED), len(seeds)))
        self.noisy = np.where(self.perfect, 0.0, 1.0)
        self.rows, self.any_perfect = np.arange(len(seeds)), bool(self.perfect.any())
        self.nothing = np.full(len(seeds), np.nan)
        self.every = [max(1, round(period / dt)) for period, *_ in INSTRUMENTS.values()]
        # a normal number that small: the share that is lost
        self.small = 1.2533 * np.array([share for _, _, share, _ in INSTRUMENTS.values()])[:, None]
        eye = np.stack([np.random.default_rng([s, 6]).standard_normal(2) for s in seeds], 1) * self.noisy
        reported = np.array([(w.wave_height_m, w.wave_period_s, w.wave_from_deg) for w in weathers], float).T
        self.height, self.period, self.wave_from = (
            reported[0] * (1 + 0.1 * eye[0]),
            reported[1],
            reported[2] + 10 * eye[1],
        )

    def _late(self, tick, seconds):
        """The delayed rows as they were `seconds` (B,) ago, between ticks by straight lines."""
        back = np.minimum(np.asarray(seconds) / self.dt + np.zeros(len(self.rows)), min(tick, MEMORY - 2))
        whole = back.astype(int)
        part = back - whole
        near, far = (
            self.ring[(tick - whole) % MEMORY, :, self.rows],
            self.ring[(tick - whole - (part > 0)) % MEMORY, :, self.rows],
        )
        return ((1 - part[:, None]) * near + part[:, None] * far).T

    def read(self, tick, t, true, env):
        """Measured columns of this tick, a dict of arrays (B,)."""
        e = self.noise.at(tick) * self.noisy
        np.concatenate([true[name] for name in DELAYED], out=self.ring[tick % MEMORY].reshape(-1))
        out = dict.fromkeys(COLUMNS, self.nothing)
        out["time_s"] = np.full(len(self.rows), t)
        lost = np.abs(self.lost.at(tick)) < self.small
        some = lost.any(1).tolist()
        for i, (name, (*_, columns)) in enumerate(INSTRUMENTS.items()):
            due = tick % self.every[i] == 0
            if due or self.any_perfect:
                getattr(self, "_" + name)(tick, true, env, out, e)
                if some[i] or not due:
                    self._blank(out, columns, due, lost[i])
        return out

    def _blank(self, out, columns, due, lost):
        """NaN where the instrument has no sample at this tick, or has lost it; a perfect one has all."""
        gone = (lost if due else ~self.perfect) & ~self.perfect
        for name in columns.split():
            out[name] = np.where(gone, np.nan, out[name])

    def _gnss(self, tick, true, env, out, e):
        f, latency = self.f, INSTRUMENTS["gnss"][1] * self.noisy
        north, east, psi, u, v, r, _, _ = self._late(tick, latency + f.gnss_delay)
        cos, sin = np.cos(psi), np.sin(psi)
        position, speed = self.h.noise[0], self.h.noise[1]
        wander = 0.3 * position * self.noisy
        out["north_m"] = (
            north + cos * f.antenna_x - sin * f.antenna_y + position * e[0] + wander * env.gnss_north
        )
        out["east_m"] = (
            east + sin * f.antenna_x + cos * f.antenna_y + position * e[1] + wander * env.gnss_east
        )
        out["surge_velocity_mps"] = u - r * f.antenna_y + speed * e[2]
        out["sway_velocity_mps"] = v + r * f.antenna_x + speed * e[3]

    def _compass(self, tick, true, env, out, e):
        f, psi = self.f, true["psi"]
        heading = psi + compass_error(f, psi)
        out["heading_true_north_deg"] = (np.degrees(heading) + self.h.noise[2] * e[4]) % 360
        out["yaw_rate_degps"] = np.degrees(true["r"] + f.gyro_bias) + self.h.noise[3] * e[5]
        out["roll_deg"] = np.degrees(true["phi"]) + self.h.noise[2] * e[6]

    def _log(self, tick, true, env, out, e):
        f, h = self.f, self.h
        *_, u, v = self._late(tick, INSTRUMENTS["log"][1] * self.noisy)
        scale = 1 + f.log_scale * (0.9 + 0.1 * np.abs(u) / h.U0)
        cos, sin = np.cos(f.log_angle), np.sin(f.log_angle)
        bias = f.log_bias * (0.8 + 0.2 * np.tanh(2 * u / h.U0))
        out["surge_velocity_through_water_mps"] = scale * (cos * u + sin * v) + bias + h.noise[4] * e[7]
        out["sway_velocity_through_water_mps"] = scale * (cos * v - sin * u) + h.noise[4] * e[8]

    def _anemometer(self, tick, true, env, out, e):
        psi = true["psi"]
        ahead, aside = env.apparent(true["u"], true["v"], np.cos(psi), np.sin(psi))
        out["true_wind_speed_mps"] = env.wind_speed * (1 + 0.03 * e[11])
        out["true_wind_direction_deg"] = (np.degrees(env.wind_from) + 2 * e[12]) % 360
        out["apparent_wind_speed_mps"] = np.hypot(ahead, aside) * (1 + 0.03 * e[13])
        angle = np.degrees(np.arctan2(aside, ahead)) + 2 * e[14]
        out["apparent_wind_angle_deg"] = (angle + 180) % 360 - 180

    def _rudder(self, tick, true, env, out, e):
        out["rudder_angle_deg"] = np.degrees(true["rudder_recorded"]) + 0.05 * e[9]

    def _engine(self, tick, true, env, out, e):
        out["propeller_rate_rpm"] = 60 * true["n"] * (1 + 0.001 * e[10])

    def _sounder(self, tick, true, env, out, e):
        deep = np.where(np.isfinite(env.depth), env.depth, DEEP * self.h.d)
        out["water_depth_m"] = deep * (1 + 0.005 * e[15])

    def _shore(self, tick, true, env, out, e):
        there, away, far, beam = np.isfinite(env.bank), np.abs(env.bank), OPEN * self.h.B, 0.02 * self.h.B
        out["bank_distance_port_m"] = np.where(there & (env.bank < 0), away, far) + beam * e[16]
        out["bank_distance_starboard_m"] = np.where(there & (env.bank >= 0), away, far) + beam * e[17]

    def _bridge(self, tick, true, env, out, e):
        out["wave_height_significant_m"], out["wave_period_peak_s"] = self.height, self.period
        out["wave_direction_deg"], out["draught_mean_m"] = self.wave_from % 360, self.draught


def compass_error(f, psi):
    """Error of the compass [rad]: a constant and a deviation that goes round with the heading."""
    return f.heading_bias + f.heading_wave * np.sin(psi + 0.6)
