"""The sea itself: ships, each with its helmsman, weather, flaws and instruments, stepped tick by tick."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from bench.reference import flaws, kinetics, machinery
from bench.reference.autopilot import Autopilot
from bench.reference.environment import Environment
from bench.reference.hidden_catalogue import prepare, stack_flaws
from bench.reference.hull_arrays import stack
from bench.reference.hulls import HULLS, Hull
from bench.reference.mmg import limit
from bench.reference.sensor_suite import COLUMNS, SensorSuite, compass_error
from bench.reference.trial_legs import legs
from bench.reference.weather import WEATHERS, Weather, rotated

ORIGINS = ("hull", "propeller", "rudder", "wind", "waves", "hidden", "known")
TRUE = [
    "north",
    "east",
    "psi",
    "u",
    "v",
    "r",
    "u_r",
    "v_r",
    "phi",
    "p",
    "heave",
    "pitch",
    "rudder",
    "rudder_feedback",
    "rudder_order",
    "rudder_recorded",
    "n",
    "wind_speed",
    "wind_from",
    "current_north",
    "current_east",
    "depth",
    "bank",
]
LAG_TICKS = 512


def hull_of(case) -> Hull:
    if isinstance(case.hull, Hull):
        return case.hull
    if case.hull not in HULLS:
        raise ValueError(f"unknown hull {case.hull!r}. Known: {', '.join(HULLS)}.")
    return HULLS[case.hull]


def hull_later(case) -> Hull:
    """Its hull once it has changed."""
    now = hull_of(case)
    later = now if case.change.hull is None else hull_of(replace(case, hull=case.change.hull))
    if later.L != now.L:
        raise ValueError(
            f"a change cannot make {now.name} ({now.L:g} m) a ship of {later.L:g} m. Give a "
            "hull of its length."
        )
    return later


def weather_of(case) -> Weather:
    if isinstance(case.weather, Weather):
        return case.weather
    if case.weather not in WEATHERS:
        raise ValueError(f"unknown weather {case.weather!r}. Known: {', '.join(WEATHERS)}.")
    return WEATHERS[case.weather]


def first_heading(case):
    """[rad]; drawn from the seed unless the case fixes it."""
    drawn = np.random.default_rng([case.seed, 8]).uniform(0, 360)
    return np.radians(drawn if case.heading_deg is None else case.heading_deg)


class Sea:
    """Ships at sea. `advance(dt)` moves them on; `readings()` gives what their instruments say now.

    For one case the readings are floats, for a sequence arrays (B,). Everything comes from the cases' seeds.
    """

    def __init__(self, cases, tick_s=0.1):
        self.single = not isinstance(cases, (list, tuple))
        self.cases = [cases, cases] if self.single else list(cases)  # numpy sums one ship otherwise than many
        self.dt, self.tick, self.ahead = tick_s, 0, 0.0
        self._build()
        self._tick()

    def _build(self):
        cases, seeds = self.cases, [c.seed for c in self.cases]
        calm = [hull_of(c) for c in cases]
        self.heading = np.array([first_heading(c) for c in cases])
        turned = [
            rotated(weather_of(c), float(np.degrees(p))) for c, p in zip(cases, self.heading, strict=True)
        ]
        real = [
            prepare(x, w, c.hidden, c.decoys, c.seed) for x, w, c in zip(calm, turned, cases, strict=True)
        ]
        self.hulls, self.weathers, numbers, self.hidden = (list(z) for z in zip(*real, strict=True))
        self.asked = {name: any(name in x for x in self.hidden) for name in ("Wind", "WaveDrift")}
        self.h, self.f = stack(self.hulls), stack_flaws(numbers)
        self.on = SimpleNamespace(**{n: bool(getattr(self.f, n).any()) for n in flaws.FIELDS})
        self.on.ext_north = self.on.ext_north or self.on.ext_east
        self.on.shallow = any(np.isfinite(w.depth_m) for w in self.weathers)
        self.known_wind, self.known_waves = (
            np.array([n in c.decoys for c in cases], float) for n in ("wind", "waves")
        )
        self.has_known = bool(self.known_wind.any() or self.known_waves.any())
        self.env = Environment(self.hulls, self.h, self.weathers, self.f, seeds, self.dt)
        shortest = min(x.L for x in self.hulls)
        self.substeps = max(1, round(self.dt / (0.05 if shortest < 20 else 0.25)))
        share = np.array([c.speed_fraction for c in cases])
        n_start = stack(calm).n0 * share
        plans = [
            legs(c.manoeuvre, x, c.duration_s or 24 * 3600, np.random.default_rng([c.seed, 9]))
            for c, x in zip(cases, calm, strict=True)
        ]
        self.pilot = Autopilot(plans, self.h, n_start, self.heading)
        perfect = [c.sensors == "perfect" for c in cases]
        self.instruments = SensorSuite(
            self.h, self.f, np.array([x.d for x in calm]), self.weathers, seeds, self.dt, perfect
        )
        self._plan_changes(turned)
        self._rest(share, n_start)

    def _plan_changes(self, weathers):
        """Which ships change at which tick, and what their hulls are then, hidden effects included."""
        self.changes = {}
        for i, c in enumerate(self.cases):
            if c.change is not None:
                later = prepare(hull_later(c), weathers[i], c.hidden, c.decoys, c.seed)[0]
                self.changes.setdefault(int(np.ceil(c.change.at_s / self.dt - 1e-9)), []).append((i, later))

    def _change(self):
        """Hulls and wind that change at this tick; motion, helmsman, waves, current and instruments go on."""
        due = self.changes.pop(self.tick, ())
        for i, later in due:
            self.hulls[i] = later
            self.env.wind_mean[i] *= self.cases[i].change.wind
        if due:
            vars(self.h).update(vars(stack(self.hulls)))
            self.env.take(self.hulls)

    def _rest(self, share, n_start):
        count = len(self.cases)
        self.s, self.old = np.zeros((14, count)), None
        self.s[kinetics.PSI], self.s[kinetics.U] = self.heading, self.h.U0 * share
        self.n, self.gear, self.blade = n_start.copy(), np.zeros(count), np.zeros(count)
        self.orders, self.behind = (
            np.zeros((LAG_TICKS, count)),
            np.rint(self.f.lag_time / self.dt).astype(int),
        )
        self.lags = self.f.lag_time > 0
        self.tally = kinetics.Tally(count)

    def _controls(self, t):
        """Orders from the helmsman, through gear and engine, to blade and shaft."""
        s, f, h = self.s, self.f, self.h
        heading = s[kinetics.PSI] + compass_error(f, s[kinetics.PSI])
        order, rate = self.pilot.order(t, heading, s[kinetics.R], s[kinetics.U], self.dt)
        self.orders[self.tick % LAG_TICKS] = order
        back = np.minimum(self.behind, min(self.tick, LAG_TICKS - 1))
        late = self.orders[(self.tick - back) % LAG_TICKS, self.instruments.rows]
        self.gear = machinery.steer(h, self.gear, late, self.dt, f.lag_rate)
        self.blade = machinery.play(self.blade, flaws.blade_angle(f, h, self.gear), f.backlash)
        self.n = machinery.turn_engine(h, self.n, rate, self.dt)
        self.order = limit(order, -h.hard_over, h.hard_over)

    def _tick(self):
        """Look at this instant: surroundings, controls, forces, instruments. The state stays."""
        t, s = self.tick * self.dt, self.s
        self._change()
        self.env.t = t
        self.env.step(
            self.tick,
            t,
            s[kinetics.NORTH],
            s[kinetics.EAST],
            s[kinetics.PSI],
        )
        self._controls(t)
        self.slope = self._slope(t)
        self.forces = self._forces()
        self.true = self._true()
        self.row = self.instruments.read(self.tick, t, self.true, self.env)

    def _slope(self, t):
        sway = 0.0 if self.old is None else self.old[kinetics.V] + self.s[kinetics.U] * self.s[kinetics.R]
        return kinetics.rate(
            self.tally, self.f, self.on, self.h, self.s, sway, self.env, t, self.n, self.blade, self.gear
        )

    def _forces(self):
        """Force by origin, (7, 3, B); and the running size of what weather does."""
        by, zero = self.tally.by, self.tally.nothing
        if self.has_known:
            by["known"] = [
                self.known_wind * a + self.known_waves * b
                for a, b in zip(by["wind"], self.env.drift, strict=True)
            ]
        if self.asked["Wind"]:
            self.tally.remember("Wind", *by["wind"])
        if self.asked["WaveDrift"]:
            self.tally.remember("WaveDrift", *self.env.drift)
        if self.env.has_squall:
            self.tally.remember("Squall", *by["hidden"])
        nothing = (zero, zero, zero)
        every = [zero if isinstance(c, float) else c for o in ORIGINS for c in by.get(o, nothing)]
        return np.concatenate(every).reshape(len(ORIGINS), 3, -1) + 0.0  # -0.0 is 0.0

    def _true(self):
        s, env = self.s, self.env
        cos, sin = np.cos(s[kinetics.PSI]), np.sin(s[kinetics.PSI])
        north, east = env.current
        recorded = np.where(self.lags, self.order, self.gear)
        values = (
            s[0],
            s[1],
            s[2],
            s[3] + north * cos + east * sin,
            s[4] + east * cos - north * sin,
            s[5],
            s[3],
            s[4],
            s[6],
            s[7],
            s[8],
            s[10],
            self.blade,
            self.gear,
            self.order,
            recorded,
            self.n,
            env.wind_speed,
            env.wind_from,
            north,
            east,
            env.depth,
            env.bank,
        )
        return dict(zip(TRUE, values, strict=True))

    def step(self):
        """One tick onward: Adams-Bashforth of second order, in substeps that a small boat's heave needs."""
        h = self.dt / self.substeps
        for i in range(self.substeps):
            slope = self.slope if i == 0 else self._slope(self.tick * self.dt + i * h)
            self.s = self.s + h * (slope if self.old is None else 1.5 * slope - 0.5 * self.old)
            self.old = slope
        self.tick += 1
        self._tick()

    def advance(self, dt):
        """Sail on for `dt` seconds (whole ticks; what is left over is carried to the next call)."""
        self.ahead += dt
        while self.ahead > self.dt - 1e-9:
            self.step()
            self.ahead -= self.dt

    def readings(self):
        """What the instruments say at this tick: a dict of columns, NaN where there is no new sample."""
        if self.single:
            return {name: float(self.row[name][0]) for name in COLUMNS}
        return {name: self.row[name].copy() for name in COLUMNS}
