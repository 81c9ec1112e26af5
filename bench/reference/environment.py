"""Air, current, waves, bottom and bank around each ship of a fleet, tick by tick."""

import numpy as np

from bench.reference import flaws, isherwood, jonswap
from bench.reference.chance import Wander

ANSWER_TICKS = 4  # the answer to waves follows the heading every fourth tick, the phase every tick
GUST_TIME, VEER_TIME, BANK_TIME, GNSS_TIME = 25.0, 60.0, 6.0, 120.0  # [s]; the bank's in L/U0


class Environment:
    """Holds what the motion and the sensors need at this tick: current, depth, bank, wind, wave loads."""

    def __init__(self, hulls, h, weathers, f, seeds, dt):
        def g(field):
            return np.array([getattr(w, field) for w in weathers], float)

        self.h, self.f, self.dt, unit = h, f, dt, h.L / h.U0
        self.wind_mean, self.wind_from0, self.gust = (
            g("wind_mps"),
            np.radians(g("wind_from_deg")),
            g("gust_share"),
        )
        to = np.radians(g("current_to_deg"))
        self.current_mean = np.stack([g("current_mps") * np.cos(to), g("current_mps") * np.sin(to)])
        self.spread, self.depth0, self.swing = g("current_spread_mps"), g("depth_m"), g("depth_swing")
        self.bank0 = g("bank_m")
        self.has_bottom, self.has_bank = np.isfinite(self.depth0).any(), np.isfinite(self.bank0).any()
        one, slow = np.ones(len(hulls)), g("current_time_s")
        small = np.where(h.L < 50, 0.3, 1.0)  # gusts over a boat's track are shorter
        times = [
            GUST_TIME * small,
            VEER_TIME * small,
            slow,
            slow,
            BANK_TIME * unit,
            GNSS_TIME * one,
            GNSS_TIME * one,
        ]
        self.wander = Wander(seeds, times, dt)
        self.take(hulls)
        self.sea = jonswap.stack_seas(
            [
                jonswap.components(w, np.random.default_rng([s, 4]))
                for w, s in zip(weathers, seeds, strict=True)
            ]
        )
        self.has_waves = bool(self.sea.a.any())
        self.current, self.has_tide, self.has_squall = None, bool(f.tide_mps.any()), bool(f.squall_mps.any())
        zero = np.zeros(len(hulls))
        self.wave_force, self.drift, self.heave, self.pitch = (zero,) * 4, (zero,) * 3, zero, zero

    def take(self, hulls):
        """What wind and waves must know of these hulls (`h` holds their numbers)."""
        self.tables = np.stack([isherwood.table(x) for x in hulls])
        self.oscillator = jonswap.oscillator(self.h)

    def step(self, tick, t, north, east, psi):
        """Bring the surroundings to this tick."""
        wander = self.wander.step(tick)
        gust, veer, _, _, bank, self.gnss_north, self.gnss_east = wander
        self.wind_speed = np.maximum(self.wind_mean * (1 + self.gust * gust), 0)
        self.wind_from = self.wind_from0 + 0.07 * veer
        self._stream(t, wander[2:4])
        self.depth, self.bank = self.depth0, self.bank0
        if self.has_bottom:
            path = (north + 0.7 * east) / (8 * self.h.L)
            self.depth = self.depth0 * (1 + self.swing * np.sin(2 * np.pi * path))
        if self.has_bank:
            self.bank = self.bank0 * np.exp(0.45 * bank)
        self._waves(tick, t, north, east, psi)

    def _stream(self, t, eddies):
        """Mean current, eddies (2, B) and tide; and their rate of change."""
        f, old = self.f, self.current
        self.current = self.current_mean + self.spread * eddies
        if self.has_tide:
            turn = 2 * np.pi * t / f.tide_period
            to = f.tide_to + 0.8 * np.sin(turn)
            self.current = self.current + f.tide_mps * np.sin(turn + 0.5) * np.stack([np.cos(to), np.sin(to)])
        self.current_rate = np.zeros_like(self.current) if old is None else (self.current - old) / self.dt

    def _waves(self, tick, t, north, east, psi):
        if self.has_waves:
            if tick % ANSWER_TICKS == 0:
                self.answer = jonswap.transfer(self.h, self.sea, psi)
            (X, Y, N, K, self.heave, self.pitch), drift = jonswap.loads(self.sea, self.answer, t, north, east)
            there = 1 - self.f.waveless
            self.wave_force = tuple(there * c for c in (X, Y, N, K))
            self.drift = tuple(there * c for c in drift)

    def apparent(self, u, v, cos, sin):
        """Where the air comes from, in body axes [m/s], for a ship with ground speed (u, v)."""
        ahead, aside = self.wind_speed * np.cos(self.wind_from), self.wind_speed * np.sin(self.wind_from)
        return u + ahead * cos + aside * sin, v + aside * cos - ahead * sin

    def air(self, s, cos, sin):
        """Wind force, and that of an unmeasured squall, by origin."""
        u = s[3] + self.current[0] * cos + self.current[1] * sin
        v = s[4] + self.current[1] * cos - self.current[0] * sin
        ua, va = self.apparent(u, v, cos, sin)
        there = 1 - self.f.windless
        steady = isherwood.force(self.h, self.tables, ua, va)
        out = {"wind": [there * c for c in steady]}
        if self.has_squall:
            gust = flaws.squall(self.f, self.t)
            ahead, aside = gust * np.cos(self.f.squall_from), gust * np.sin(self.f.squall_from)
            blown = isherwood.force(
                self.h, self.tables, ua + ahead * cos + aside * sin, va + aside * cos - ahead * sin
            )
            out["hidden"] = [a - b for a, b in zip(blown, steady, strict=True)]
        return out
