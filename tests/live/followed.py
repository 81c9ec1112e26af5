"""A tube and an estimate in the place of the true ones, that take down what the stabilizer tells them."""

from math import cos, inf, sin
from types import SimpleNamespace

import pytest

from twin.live.certificate.observer_tube import NONE
from twin.live.certificate.rolled_tube import RolledTube
from twin.live.observer.rollback import RollBack
from twin.live.signals.measured import Measured
from twin.live.stabilizer import Stabilizer

H = 0.5  # the certified period [s]
WINDOW = 4
CARRIED = (0.35, 0.1, 0.02), 0.1
EVERY = {"u": 5.2, "v": 0.1, "r": 0.021, "psi": 0.72, "delta": 0.0, "n": 1.0, "H_s": 0.5}
INSTRUMENTS = (0.3, 0.4, 0.011), 0.04  # what those leave open at no age: gap and noise, u v r and psi


class Followed:
    """In the tube's place."""

    beta, psi, widest, noise, heading_noise = (0.3, 0.4, 0.05), 0.2, (1.0, 1.1, 0.3), (0.1, 0.2, 0.01), 0.02
    way, oldest_s, window = (0.5, 0.4, 0.03), 1.0, WINDOW

    def __init__(self):
        self.certificate = SimpleNamespace(
            ok=True, margin=0.6, step_margin=0.05, h=H, K=(0.4, 0.5, 0.6), heading_noise=0.02
        )
        self.periods = SimpleNamespace(count=lambda dt: 1 if dt <= H else 2 if dt <= 2.0 * H else 0)
        self.takes = False  # whether a reset sets its bound
        self.from_s = inf  # what its bound rests on is no older
        self.only_way = False  # whether only the way to now has left it
        self.left, self.nothing = None, []  # what leaves the set; answers of says_nothing, then None
        self.told, self.stepped, self.asked, self.looked_back, self.seas = [], [], [], [], []

    def under(self, H_s, acts):
        self.seas.append((H_s, acts))

    def outside(self, s, within, dt, on_the_way=True):
        self.asked.append((within, dt))
        return self.left if on_the_way or not self.only_way else None

    def rests_on(self, since_s):
        return since_s <= self.from_s

    def says_nothing(self):
        return self.nothing.pop(0) if self.nothing else None

    def carried(self, pulled, turned, since_s):
        self.looked_back.append((pulled, turned, since_s))
        return CARRIED

    def know(self, nu, psi):
        self.told.append(("know", nu, psi))

    def reset(self, nu, psi):
        self.told.append(("reset", nu, psi))
        if self.takes:
            self.beta, self.psi = nu, psi

    def step(self, got, sea, pulled, dt, acts, heading, turned):
        self.stepped.append((got, sea, pulled, dt, acts, heading, turned))


class RolledAlong(RolledTube):
    """The same of an observer that rolls back: whom it distrusts while it follows."""

    def __init__(self):
        vars(self).update(vars(Followed()))
        for name in ("beta", "psi", "noise", "heading_noise", "way", "oldest_s", "window"):
            setattr(self, name, getattr(Followed, name))
        self.distrusted, self.uncounted, self.followed = NONE, [0.0, 0.0, 0.0], []

    widest = Followed.widest
    outside, says_nothing, carried = Followed.outside, Followed.says_nothing, Followed.carried
    rests_on, left = Followed.rests_on, None
    know, reset, under = Followed.know, Followed.reset, Followed.under

    def follow(self, path, sea, acts):
        self.followed.append((path, sea, acts, self.distrusted))


class Motion(RollBack):
    """An estimate that stays where it is; `RollBack` only for RolledAlong."""

    def __init__(self):
        self.restarts, self.most, self.path = 0, (6.0, 2.0, 0.05), "the way"
        self.received = dict.fromkeys(("u", "v", "r", "psi"), True)
        self.pulled, self.innovation = {"u": 0.01, "v": 0.02, "r": 0.03, "psi": 0.04}, {}
        self.ready = True

    @property
    def estimate(self):
        c, s = cos(0.7), sin(0.7)
        return SimpleNamespace(
            ready=self.ready, u=5.0, v=0.3, r=0.02, psi=0.7, velocity_ned=lambda: (5.0 * c - 0.3 * s, 5.0 * s)
        )


class Watch:
    """Steps a stabilizer; `outside` of each tick in `why`."""

    def __init__(self, tube=None, **of):
        self.tube = tube or Followed()
        self.one, self.observer, self.now_s, self.why = Stabilizer(self.tube, **of), Motion(), 100.0, []

    def run(self, ticks=1, lost=(), derived=(), ages=(), dt=H, steps=None, fresh=(), more=None, **of):
        for _ in range(ticks):
            self.now_s += dt or H
            si = {a: x for a, x in (EVERY | (more or {})).items() if a not in lost}
            time = {a: self.now_s - dict(ages).get(a, 0.0) for a in si}
            measured = Measured(
                self.now_s, si, dict.fromkeys(fresh, dt), steps or {}, derived=set(derived), time=time
            )
            self.tube.told.clear()
            self.said = self.one.step(self.observer, measured, "where", dt, **of)
            self.why.append(self.one.outside)
        return self.said


def bounds(ages=0.0):
    (u, v, r), psi = INSTRUMENTS
    return (u + 0.5 * ages, v + 0.4 * ages, r + 0.03 * ages), psi + 0.05 * ages


def told(tube, number=-1):
    """What the tube was told in this tick, the last of it or another."""
    name, nu, psi = tube.told[number]
    return name, pytest.approx(nu), pytest.approx(psi)


def least(a, b):
    return tuple(map(min, a[0], b[0])), min(a[1], b[1])
