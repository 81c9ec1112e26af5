"""Four azimuths of one make share a gain and differ from it by little, unless the voyages clearly say
otherwise. The boats sail by the twin's own physics with hulls that are not as their ship file has them, in gusts
that nobody recorded."""

from functools import cache

import numpy as np
import pytest

from bench.boats.actuator_questions import from_sheet
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.recording.voyage import Voyage
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.fit import fit
from twin.study.estimation.innovations import NoiseModel
from twin.study.reference.nuisance import TEMPER
from twin.study.track.track import track

STEP_S, GAIN = 0.2, 0.9
OTHERWISE = {"X_uu": 1.2, "Y_uv": 0.85, "N_ur": 1.15}  # times what the ship file has of the hull
NOISE = {
    "north_m": 0.02,
    "east_m": 0.02,
    "heading_true_north_deg": 0.2,
    "yaw_rate_degps": 0.2,
} | dict.fromkeys(("surge_velocity_mps", "sway_velocity_mps"), 0.02)


@cache
def ferry():
    return from_sheet("ferry4")


def names():
    return [a.name for a in ferry().actuators]


def sailed(seed, seconds, shares=(), gusts=1.0):
    """Turns and angles held for some seconds, each azimuth's for itself. `shares`: of what its make gives, by
    name; `gusts`: of the force scale."""
    ship, rng = ferry(), np.random.default_rng(seed)
    changed = {n: float(ship.derivative(n)) * by for n, by in OTHERWISE.items()}
    gains = {f"{n}.gain": GAIN * dict(shares).get(n, 1.0) for n in names()}
    model, steps = Model.of(ship.with_derivatives(**changed, **gains)), round(seconds / STEP_S)

    def held(low, high):
        out, k = np.zeros(steps), 0
        while k < steps:
            n = round(rng.uniform(3.0, 9.0) / STEP_S)
            out[k : k + n] = rng.uniform(low, high)
            k += n
        return np.convolve(np.pad(out, (4, 4), "edge"), np.ones(9) / 9.0, "valid")

    recorded = {f"{n}.rate_rpm": held(150.0, 900.0) for n in names()}
    recorded |= {f"{n}.angle_deg": held(-50.0, 50.0) for n in names()}
    pushed = gusts * float(ship.scale("force")) / float(ship.m)
    rows, state, gust = [], (0.0, 0.0, 0.0, 1.0, 0.0, 0.0), np.zeros(3)
    for k in range(steps):
        rows.append(state)
        orders = {f"{n}.rate": recorded[f"{n}.rate_rpm"][k] / 60.0 for n in names()}
        orders |= {f"{n}.angle": np.radians(recorded[f"{n}.angle_deg"][k]) for n in names()}
        state = model.step(state, Situation(orders=orders), STEP_S)
        gust = 0.9 * gust + 0.4 * rng.standard_normal(3) * (1.0, 1.0, 1.0 / float(ship.L_pp))
        state = (*state[:3], *(np.array(state[3:]) + STEP_S * pushed * gust))
    x, y, psi, u, v, r = np.array(rows).T
    true = dict(zip(NOISE, (x, y, np.degrees(psi), np.degrees(r), u, v), strict=True))
    noisy = {c: true[c] + sd * rng.standard_normal(steps) for c, sd in NOISE.items()}
    noisy["heading_true_north_deg"] %= 360.0
    return Voyage(f"ferry4 {seed}", STEP_S * np.arange(steps), noisy | recorded)


def strengths(voyage, ship):
    """What each azimuth gives over its curve, as a fit to this voyage has it."""
    model = Model.of(ship)
    found = fit(
        [track(voyage, ship)], model, core_unknowns(model), of_ship(ship), NoiseModel(), temper=TEMPER
    )
    return {a.name: float(a.strength) for a in found.model.ship.actuators}


def of_several_makes():
    """The same ferry, its azimuths told apart by what their ship file says of their gain."""
    return ferry().with_derivatives(**{f"{n}.gain": 1.0 + 1e-6 * i for i, n in enumerate(names())})


@pytest.mark.parametrize("seed", [1, 2])
def test_azimuths_that_are_alike_come_out_alike_on_a_short_voyage_in_gusts(seed):
    """Expected: within the 5 % by which a make is taken to differ, and less than half as far apart as four
    gains that are found each for itself."""
    voyage = sailed(seed, 60.0)
    one, each = (np.array(list(strengths(voyage, s).values())) for s in (ferry(), of_several_makes()))
    assert one.std() < 0.05 and one.std() < 0.5 * each.std()
    assert one.mean() == pytest.approx(GAIN, abs=0.2)


def test_one_that_gives_a_fifth_less_is_found_where_the_voyage_tells_it():
    """Expected: its share of what the others give within 5 % of the truth, though that is four times what
    two of one make usually differ by; the others alike."""
    found = strengths(sailed(2, 200.0, (("aft_port", 0.8),)), ferry())
    weak, others = found.pop("aft_port"), np.array(list(found.values()))
    assert weak / others.mean() == pytest.approx(0.8, rel=0.05)
    assert others.std() < 0.05
