"""Voyages for the study's tests: of the reference sea with something hidden, and of the twin's own model
where a test wants to know what is in it."""

from copy import deepcopy
from dataclasses import replace
from functools import cache, lru_cache

import numpy as np
import pytest

from bench.bundled import recorded
from bench.reference import SeaCase, simulate
from twin.cli import main
from twin.commands.story import SHIP
from twin.physics.maths import RAD
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.physics.state import Situation
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage
from twin.study.diagnosis import effect_diagnosis
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.search import search
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track

HIDDEN = {
    "nothing": (),
    "HeadingBias": (("HeadingBias", 1.0),),
    "Current": (("Current", 1.0),),
    "RudderWear": (("RudderWear", 1.0),),
    "SteeringLag": (("SteeringLag", 1.0),),
    "IceLike": (("IceLike", 1.0),),
    "Wind": (("Wind", 1.0),),
    "Wind again": (("Wind", 1.0),),
    "RudderBacklash": (("RudderBacklash", 1.0),),
    "Sloshing": (("Sloshing", 1.0),),
}


@pytest.fixture(scope="session")
def tanker():
    return load(SHIP)


@pytest.fixture(scope="session")
def at_sea():
    """All that these rooms sail for 20 min on the reference sea, by name: a voyage for each name in HIDDEN, a
    straight one, three to calibrate on, three behind slow steering gears, one past other ships and one on
    a day of wind, stream and fouling; every second a sample, and what was hidden. Ships that sail side by
    side cost hardly more than one alone, and no ship feels another; who reads them writes into none."""
    cases = {
        name: SeaCase("kvlcc2", "mixed", hidden=h, seed=900 + i, duration_s=1200.0)
        for i, (name, h) in enumerate(HIDDEN.items())
    }
    for name, manoeuvre, seed, hidden in (
        ("straight", "straight", 950, ()),
        ("calm", "zigzag_20", 960, ()),
        ("calm too", "speed_changes", 961, ()),
        ("calm again", "mixed", 962, ()),
        ("slow gear zigzag", "zigzag_20", 970, (("SteeringLag", 0.5),)),
        ("slow gear", "mixed", 971, (("SteeringLag", 0.5),)),
        ("slower gear", "mixed", 972, (("SteeringLag", 2.0),)),
        ("passed", "zigzag_20", 909, (("PassingShip", 1.0),)),
        ("june", "mixed", 909, (("Wind", 0.5), ("Current", 0.5), ("HullFouling", 1.0))),
    ):
        cases[name] = SeaCase("kvlcc2", manoeuvre, hidden=hidden, seed=seed, duration_s=1200.0)
    sailed = simulate(list(cases.values()))
    return {
        name: (recorded(name, r.columns, every=10), r.hidden) for name, r in zip(cases, sailed, strict=True)
    }


@pytest.fixture(scope="session")
def voyages(at_sea):
    """The voyages of `at_sea`, by name."""
    return {name: voyage for name, (voyage, _) in at_sea.items()}


@pytest.fixture(scope="session")
def case_of(tanker, voyages):
    """The case of one of `voyages`, by its name: assembled once for all who ask; none writes into it."""
    return cache(lambda name: assemble([voyages[name]], tanker))


@pytest.fixture(scope="session")
def search_of(case_of):
    """What `search` finds in that case, by the voyage's name, once: none writes into it."""
    return cache(lambda name: search(case_of(name)))


@pytest.fixture(scope="session")
def searched(search_of):
    """The same as (weighed, found), and lists of one's own."""
    return lambda name: (list(search_of(name).weighed), dict(search_of(name).found))


@pytest.fixture(scope="session")
def asked(tanker, voyages, case_of):
    """What is said of one of `voyages`, by its name: (result, progress), asked once, of the case of all."""

    def ask(name):
        said = []
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(effect_diagnosis, "assemble", lambda *_: case_of(name))
            return effect_diagnosis.diagnose([voyages[name]], tanker, progress=said.append).result, said

    return cache(ask)


@pytest.fixture(scope="session")
def diagnosed(asked):
    """What is said of one of `voyages`, by its name: a copy for each who reads it."""
    return lambda name: deepcopy(asked(name)[0])


STEP_S = 320.0 / 7.97388 / 32.0  # the study's own grid for this ship


@lru_cache
def ship() -> Ship:
    return load("kvlcc2")


def voyage(*effects, **facts) -> Voyage:
    """A voyage of one's own to change: see `sail`."""
    made = sail(*effects, **facts)
    return made.with_rows(made.time_s.copy(), {k: x.copy() for k, x in made.columns.items()})


@lru_cache(maxsize=32)
def sail(
    *effects,
    seed: int = 0,
    seconds: float = 1500.0,
    step: float = STEP_S,
    noise: float = 1.0,
    wind: float | None = None,
    veer: float = 0.0,
    name: str = "made",
    of: Ship | None = None,
) -> Voyage:
    """Turns and straight legs of a ship with these effects, measured with noise; `wind` [m/s] from the east,
    if measured, that turns by `veer` [rad] on the voyage, clockwise."""
    model, rng = Model.of(of or ship()).but(*effects), np.random.default_rng(seed)
    t = np.arange(0.0, seconds, step)
    legs = np.repeat(rng.choice([-20.0, -10.0, 0.0, 10.0, 20.0], t.size), rng.integers(50, 130, t.size))
    order = legs[: t.size]
    rudder = np.radians(np.convolve(np.pad(order, (5, 5), "edge"), np.ones(11) / 11.0, "valid"))  # 2.2 deg/s
    n = np.interp(t, [0.6 * seconds, 0.6 * seconds + 120.0], [1.6, 1.25])
    to = 1.5 * np.pi + veer * t / seconds
    rows, state = [], (0.0, 0.0, 0.3 * seed, 7.0, 0.0, 0.0)
    for k in range(t.size):
        seas = {} if wind is None else {"wind_speed": wind, "wind_to": to[k]}
        s = Situation(delta=rudder[k], n=n[k], t=t[k], **seas)
        half = Situation(delta=rudder[k : k + 2].mean(), n=n[k : k + 2].mean(), t=t[k] + 0.5 * step, **seas)
        s.x, s.y, s.psi, s.u, s.v, s.r = state
        rates = model.nu_dot(s)
        s.u_dot, s.v_dot = rates.u, rates.v
        shown = s
        for fault in model.faults:
            shown = fault.read(replace(shown), model.loaded)
        rows.append([shown.x, shown.y, shown.psi, shown.u, shown.v, shown.r, shown.u_r, shown.v_r])
        state = model.step(state, half, step)
    x, y, psi, u, v, r, u_r, v_r = (
        np.array(rows) + noise * rng.normal(size=(t.size, 8)) * [0.4, 0.4, 1e-3, 0.02, 0.02, 2e-5, 0.03, 0.03]
    ).T
    columns = {
        "north_m": x,
        "east_m": y,
        "heading_true_north_deg": np.mod(psi * RAD, 360.0),
        "surge_velocity_mps": u,
        "sway_velocity_mps": v,
        "yaw_rate_degps": r * RAD,
        "surge_velocity_through_water_mps": u_r,
        "sway_velocity_through_water_mps": v_r,
        "rudder_angle_deg": rudder * RAD,
        "propeller_rate_rpm": n * 60.0,
    }
    if wind is not None:
        columns |= {
            "true_wind_speed_mps": np.full(t.size, wind),
            "true_wind_direction_deg": np.mod((to - np.pi) * RAD, 360.0),
        }
    return Voyage(name, t, columns, {"start_time_utc": f"2026-05-0{1 + seed % 9}T08:00:00Z"})


def seldom(voyage: Voyage, every: int = 2) -> Voyage:
    """The voyage of which only one sample in so many was logged."""
    columns = {name: x[::every] for name, x in voyage.columns.items()}
    return voyage.with_rows(voyage.time_s[::every], columns)


@pytest.fixture(scope="session")
def make():
    """The function that makes a voyage."""
    return voyage


@pytest.fixture(scope="session")
def kvlcc2():
    return ship()


@pytest.fixture
def sailed():
    """A voyage and its track, as the verbs take them."""

    def wrap(voyage: Voyage, of: Ship | None = None, sha256: str = "") -> Sailed:
        return Sailed(voyage, track(voyage, of or ship()), sha256 or voyage.name)

    return wrap


@pytest.fixture
def on_disk(tmp_path):
    """A voyage as a file."""

    def write(voyage: Voyage) -> str:
        path = tmp_path / f"{voyage.name}.mcap"
        write_voyage(voyage, path)
        return str(path)

    return write


@pytest.fixture
def verb():
    """Runs a verb as the command line does: words in, exit code out."""
    return lambda *words: main([str(w) for w in words])
