"""Wind, stream and swell of a voyage, and what they do to a ship: none of it as the twin has it."""

from dataclasses import dataclass, replace
from math import atan2, cos, exp, hypot, pi, sin, tau

import numpy as np
from scipy.signal import lfilter

from bench.fleet.random_particulars import RHO, G, Particulars

AIR = 1.225
STEP_DEG = 10


@dataclass(frozen=True)
class FleetWeather:
    """One voyage's: means, and how they wander."""

    wind: float = 0.0
    wind_from: float = 0.0
    gust: float = 0.15  # standard deviation over the mean
    gust_s: float = 25.0
    stream: float = 0.0
    stream_to: float = 0.0
    eddy: float = 0.0  # [m/s] standard deviation
    eddy_s: float = 500.0
    tide: float = 0.0  # [m/s] amplitude of a slow turn
    tide_s: float = 3000.0
    swell: float = 0.0  # significant height [m]
    swell_s: float = 8.0
    swell_from: float = 0.0
    depth: float = 1e4
    bank: float = 0.0  # distance to a bank, + starboard; 0: none
    squall: float = 0.0  # [m/s] of gusts that no instrument sees


def draw(p: Particulars, rng: np.random.Generator, calm: bool) -> FleetWeather:
    """An ordinary day; `calm`: one that was chosen for reference voyages."""
    big = min(1.0, (p.L / 120.0) ** 0.4)
    share = 0.5 if calm else 1.0
    stream = share * min(0.6, 0.08 * p.U0) * rng.weibull(1.5)
    high = share * rng.choice([0.0, 0.0, 1.0, 1.0, 2.0]) * 0.004 * p.L**0.75 * rng.uniform(0.3, 1.2)
    return FleetWeather(
        wind=share * big * 7.0 * rng.weibull(2.0),
        wind_from=rng.uniform(0, tau),
        gust=rng.uniform(0.08, 0.2),
        gust_s=rng.uniform(10, 40),
        stream=stream,
        stream_to=rng.uniform(0, tau),
        eddy=stream * rng.uniform(0.02, 0.15),
        eddy_s=rng.uniform(250, 900),
        swell=high,
        swell_s=float(np.clip((p.L / 1.56) ** 0.5 * rng.uniform(0.6, 1.3), 2, 14)),
        swell_from=rng.uniform(0, tau),
    )


class Windage:
    """Coefficients tabulated by the angle of the wind off the bow, every ten degrees; no formula."""

    def __init__(self, p: Particulars, rng: np.random.Generator) -> None:
        angle = np.radians(np.arange(0, 181, STEP_DEG))

        def wave(sd: float) -> np.ndarray:
            two, three = sd * rng.standard_normal(2)
            return two * np.sin(2 * angle) + three * np.sin(3 * angle)

        ahead, astern = rng.uniform(0.5, 0.9), rng.uniform(0.4, 0.8)
        self.x = np.where(angle < pi / 2, -ahead, -astern) * np.cos(angle) * (1 + 0.2 * np.sin(angle)) + wave(
            0.05
        )
        self.y = rng.uniform(0.7, 1.05) * np.sin(angle) ** rng.uniform(0.8, 1.3) + wave(0.04)
        self.n = (
            rng.uniform(0.06, 0.16) * np.sin(2 * angle)
            + rng.uniform(-0.05, 0.05) * np.sin(angle)
            + wave(0.01)
        )
        self.X, self.Y, self.N = ([float(v) for v in t] for t in (self.x, self.y, self.n))
        self.F, self.S = 0.5 * AIR * p.A_F, 0.5 * AIR * p.A_L
        self.arm = self.S * p.L

    def force(self, ahead: float, aside: float) -> tuple[float, float, float]:
        """Of air that comes from (ahead, aside) in body axes [m/s]."""
        speed2 = ahead * ahead + aside * aside
        angle = atan2(aside, ahead)
        side, at = (1.0 if angle > 0 else -1.0), abs(angle) * 18 / pi
        i = min(int(at), 17)
        f = at - i
        x, y, n = ((1 - f) * t[i] + f * t[i + 1] for t in (self.X, self.Y, self.N))
        return self.F * x * speed2, -side * self.S * y * speed2, -side * self.arm * n * speed2


class Surroundings:
    """The weather as the ship meets it, step by step."""

    def __init__(
        self,
        w: FleetWeather,
        p: Particulars,
        windage: Windage,
        rng: np.random.Generator,
        dt: float,
        steps: int,
    ) -> None:
        self.w, self.p, self.windage, self.dt = w, p, windage, dt
        gust, veer, east, north, squall = (
            wander(rng, s, dt, steps) for s in (w.gust_s, 3 * w.gust_s, w.eddy_s, w.eddy_s, 60.0)
        )
        t = np.arange(steps) * dt
        self.wind = (w.wind * np.maximum(1 + w.gust * gust, 0.0)).tolist()
        self.wind_from = (w.wind_from + 0.08 * veer).tolist()
        to = w.stream_to + 0.6 * np.sin(tau * t / w.tide_s)
        speed = w.stream + w.tide * np.sin(tau * t / w.tide_s + 0.7)
        self.stream_n, self.stream_e = (
            (speed * np.cos(to) + w.eddy * north).tolist(),
            (speed * np.sin(to) + w.eddy * east).tolist(),
        )
        self.squall = (w.squall * np.maximum(squall - 0.8, 0.0)).tolist()
        self.waves = self._swell(rng) if w.swell > 0 else []

    def _swell(self, rng: np.random.Generator) -> list[tuple[float, ...]]:
        """Wave components: amplitude, frequency, number, direction, phase."""
        f = np.geomspace(0.75, 1.6, 9) / self.w.swell_s * (1 + 0.03 * rng.uniform(-1, 1, 9))
        s = (
            f**-5
            * np.exp(-1.25 * (self.w.swell_s * f) ** -4)
            * 3.3 ** np.exp(-0.5 * ((self.w.swell_s * f - 1) / 0.08) ** 2)
        )
        e = s * np.gradient(f)
        a = np.sqrt(2 * e / e.sum() * self.w.swell**2 / 16)
        spread = self.w.swell_from + pi + 0.25 * rng.standard_normal(9)
        return [
            (float(A), float(tau * F), float((tau * F) ** 2 / G), float(D), float(rng.uniform(0, tau)))
            for A, F, D in zip(a, f, spread, strict=True)
        ]

    def air(self, i: int, u: float, v: float, psi: float) -> tuple[float, float, float]:
        """Force of the wind on a ship of ground speed (u, v)."""
        speed = self.wind[i] + self.squall[i]
        if speed <= 0.0 and abs(u) < 1e-9:
            return 0.0, 0.0, 0.0
        angle = self.wind_from[i] - psi
        return self.windage.force(u + speed * cos(angle), v + speed * sin(angle))

    def sea(self, t: float, x: float, y: float, psi: float, mass: float) -> tuple[float, float, float]:
        """First-order and drift force of the swell."""
        X = Y = N = ahead = aside = 0.0
        p, half = self.p, 0.5 * self.p.L
        for a, w, k, to, e in self.waves:
            chi = to - psi
            c, s = cos(chi), sin(chi)
            phase = w * t - k * (x * cos(to) + y * sin(to)) + e
            q = k * half * c
            even = exp(-0.5 * k * p.T) * (sin(q) / q if abs(q) > 1e-3 else 1.0)
            deep, g = mass * G * k * a * even, sin(phase)
            X -= deep * c * g
            Y -= 1.7 * deep * s * g
            N += 0.25 * deep * half * s * (q if abs(q) < 1 else 1 / q) * cos(phase)
            reflect = (1 - exp(-k * p.T)) ** 2
            root = a * reflect**0.5
            ahead += root * cos(phase)
            aside += root * sin(phase)
        if self.waves:
            chi = self.w.swell_from + pi - psi
            energy = RHO * G * 0.5 * (ahead * ahead + aside * aside)
            c, s = cos(chi), sin(chi)
            X += 0.5 * energy * p.B * c * abs(c) * (1.6 if c < 0 else 0.6)
            Y += 0.8 * energy * p.L * s * abs(s)
            N -= 0.10 * energy * p.L**2 * s * c
        return X, Y, N


def wander(rng: np.random.Generator, time_s: float, dt: float, steps: int) -> np.ndarray:
    """A number of unit variance that wanders with a correlation time."""
    k = exp(-dt / time_s)
    e = rng.standard_normal(steps) * (1 - k * k) ** 0.5
    e[0] = rng.standard_normal()
    return lfilter([1.0], [1.0, -k], e)


def stronger(w: FleetWeather, **changes: float) -> FleetWeather:
    return replace(w, **changes)


def apparent(speed: float, angle: float, u: float, v: float) -> tuple[float, float]:
    """Apparent wind (speed, angle off the bow) of a true wind from `angle` off the bow."""
    ahead, aside = u + speed * cos(angle), v + speed * sin(angle)
    return hypot(ahead, aside), atan2(aside, ahead)
