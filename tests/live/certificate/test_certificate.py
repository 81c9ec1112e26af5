"""The certificate: sure slopes, the theorem in numbers, what it refuses and what it keeps on file."""

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from twin.errors import SettingsError
from twin.live.certificate import certificate as cert
from twin.live.certificate import comparison_systems as c3
from twin.live.certificate import store
from twin.live.certificate.certificate import Certificate, Confined, Disturbance, certify
from twin.live.certificate.enclosure import sampled, slopes
from twin.live.observer.estimate import gain_for
from twin.physics.dual import Dual
from twin.physics.effects import BUILT_IN, find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation

SHIPS = ("kvlcc2", "container", "kvlcc2_model", "usv")
MOVING = [kind for kind in BUILT_IN if kind.kind in ("Force", "Flow")]


def windy(name):
    ship = load(name)
    return Model.of(ship).but(find("Wind").plausible(ship))


@pytest.fixture(scope="module")
def vlcc():
    model = windy("kvlcc2")
    return model, certify(model, 0.3, 0.1)


@pytest.mark.parametrize("name", SHIPS)
def test_the_sure_slopes_hold_every_sampled_one_and_are_little_wider(name):
    model = windy(name)
    ranges = {**cert.of_ship(model).ranges, "stream": (0.0, 0.0)}
    sure, seen = slopes(model, ranges), sampled(model, ranges, count=5000)
    for low, high, a, b in zip(sure.lo, sure.hi, seen.lo, seen.hi, strict=True):
        for j in range(3):
            assert low[j] <= a[j] and b[j] <= high[j]
            assert high[j] - low[j] < 1.5 * (b[j] - a[j])


@pytest.mark.parametrize("Kind", MOVING, ids=lambda kind: kind.__name__)
def test_every_effect_of_the_catalogue_can_be_certified(Kind):
    """Expected: finite bounds that hold sampled slopes; a current is seen from the water, so it is sampled
    over ground.
    """
    ship = load("kvlcc2")
    model = Model.of(ship).but(Kind.plausible(ship))
    operating = cert.of_ship(model)
    coarse = dict.fromkeys(operating.ranges, 3)
    sure, seen = slopes(model, operating.ranges, coarse), sampled(model, operating.ranges, count=2000)
    for i in range(3):
        for j in range(4):
            assert sure.lo[i][j] <= seen.lo[i][j] <= seen.hi[i][j] <= sure.hi[i][j]
    assert np.isfinite(sure.lo).all() and np.isfinite(sure.hi).all()


def test_a_current_of_any_direction_keeps_within_the_slopes():
    """Test: the true model over ground in random currents of the operating set. Expected: its own slopes lie
    in the bounds.
    """
    still = windy("kvlcc2")
    operating = cert.of_ship(still)
    sure = slopes(still, operating.ranges)
    rng = np.random.default_rng(3)
    at = {name: rng.uniform(lo, hi) for name, (lo, hi) in operating.ranges.items()}
    for _ in range(200):
        at = {
            name: float(rng.choice([lo, hi, rng.uniform(lo, hi)]))
            for name, (lo, hi) in operating.ranges.items()
        }
        stream, angle = at.pop("stream"), rng.uniform(-np.pi, np.pi)
        north, east = stream * np.cos(angle), stream * np.sin(angle)
        model = still.but(find("Current").plausible(still.ship).but(north=north, east=east))
        w = model.water(Situation(psi=at["psi"]))
        at["u"], at["v"] = at["u"] + w.u, at["v"] + w.v
        seeds = {
            n: Dual(at[n], tuple(float(n == k) for k in ("u", "v", "r", "psi")))
            for n in ("u", "v", "r", "psi")
        }
        for i, rate in enumerate(model.nu_dot(Situation(**at | seeds))):
            assert all(
                a - 1e-12 <= s <= b + 1e-12
                for a, s, b in zip(sure.lo[i], rate.slopes, sure.hi[i], strict=True)
            )
            assert sure.rate[i][0] <= rate.value <= sure.rate[i][1]


def test_the_usual_gain_of_the_loop_is_certified_for_a_tanker(vlcc):
    model, c = vlcc
    assert c.ok and 0.5 < c.margin < 1.0 and c.rate > 0.1
    assert certify(model, gain_for(model.ship), 0.02, (60, 60, 1)).ok
    assert c.bound[0] < 0.4 and c.bound[1] < 0.4 and c.bound[2] < 0.004
    assert "holds" in c.reason


def test_the_bound_is_what_the_gains_say(vlcc):
    _, c = vlcc
    by_parts = c3.add(c3.apply(c.gains_disturbance, c.disturbance.calm), c3.apply(c.gains_noise, c.noise))
    rest = tuple(b - p for b, p in zip(c.bound, by_parts, strict=True))
    assert all(0.0 <= r < 0.2 * b for r, b in zip(rest, c.bound, strict=True))  # what sampling costs
    assert all(a < b for a, b in zip(c.bound, c.bound_in(2.0), strict=True))


def test_the_bound_is_a_fixed_point_of_the_recursion(vlcc):
    _, c = vlcc
    d = c3.add(c3.apply(c.push, c.disturbance.calm), c.calm)
    E = c3.add(c3.apply(c.step.V, c.bound), d)
    told, now, drift = (
        c.step.left_by(d, c.noise),
        c3.apply(c.step.now, c.bound),
        c3.apply(c.step.drift, c.bound),
    )
    for i in range(3):
        assert now[i] + c.step.again[i] * E[i] + drift[i] + told[i] == pytest.approx(c.bound[i], rel=1e-9)


def test_continuous_and_sampled_theorem_meet_when_the_loop_is_fast():
    model = windy("kvlcc2")
    plant = cert.plant_of(model, cert.of_ship(model), 1e-3)
    least = cert.gains_that_do(plant, (0, 0, 0))[0]
    c = certify(model, least, 1e-3, 0)
    assert c.margin == pytest.approx(0.0, abs=0.01)


def test_a_gain_that_is_too_small_is_refused_with_the_one_that_would_do():
    model = windy("kvlcc2")
    c = certify(model, 0.03, 0.1)
    assert not c.ok and c.margin < 0.0 and c.bound == (float("inf"),) * 3
    assert "too small" in c.reason
    least = float(c.reason.split("K from ")[1].split()[0])
    assert certify(model, 1.02 * least, 0.1).ok and not certify(model, 0.98 * least, 0.1).ok


def test_a_gain_that_is_too_large_for_the_delay_is_refused():
    c = certify(windy("kvlcc2"), 9.0, 0.1, delay_samples=5)
    assert not c.ok and "5/5/5 samples old" in c.reason and "would do" in c.reason


def test_a_small_boat_is_told_to_run_faster():
    c = certify(windy("usv"), 12.0, 0.1, noise=(0.06, 0.06, 0.008))
    assert not c.ok and "Run the loop every 0.0" in c.reason
    assert certify(windy("usv"), 20.0, 0.02, 0, noise=(0.06, 0.06, 0.008)).ok


@pytest.mark.parametrize(
    ("name", "hz", "least"), [("kvlcc2", 10.0, 0.29), ("container", 10.0, 0.7), ("usv", 50.0, 13.0)]
)
def test_the_loops_own_gain_is_that_of_the_ship(name, hz, least):
    """Expected: the usual 12 U_0/L for a tanker, more for the others, and a bound that is narrower than the
    operating set on every axis."""
    ship = load(name)
    c = certify(Model.of(ship), None, 1.0 / hz, 1, cert.usual_noise(ship), heading_noise=0.005)
    assert c.ok and c.K[0] >= gain_for(ship) * (1.0 - 1e-9) and least < c.K[0] < 1.6 * least
    assert all(b < 0.6 * c.operating.ranges[a][1] for a, b in zip(("u", "v", "r"), c.bound, strict=True))


def test_a_measurement_one_sample_late_costs_a_strongly_damped_boat_little():
    """Test: the 2 m boat, whose yaw dies in a sixth of a second, at 50 Hz. Expected: a bound within twice
    that of measurements in time."""
    model, K = windy("usv"), 17.0
    late, prompt = (certify(model, K, 0.02, m, noise=(0.06, 0.06, 0.008)) for m in (1, 0))
    assert all(b < 2.0 * a for a, b in zip(prompt.bound, late.bound, strict=True))


def test_slopes_without_a_bound_are_refused_in_words():
    model = windy("kvlcc2")
    wild = cert.of_ship(model, u=(-3.0, 8.0))  # through rest, where the rudder's inflow has an infinite slope
    c = certify(model, 0.3, 0.1, operating_set=wild)
    assert not c.ok and "no K holds" in c.reason and "narrow the operating set" in c.reason


def test_the_best_gain_beats_the_usual_one(vlcc):
    model, c = vlcc
    best = cert.best_gain(c.plant, c.delays, c.noise, c.disturbance)
    assert max(certify(model, best, 0.1).bound) < max(c.bound)


def test_a_network_fed_with_its_own_estimate_needs_a_larger_gain(vlcc):
    _, c = vlcc
    force, moment = 2e6, 7e8
    extra = cert.self_regressor(
        c.plant,
        (0.1 * force, 0.1 * force, 0.1 * moment),
        cert.lipschitz([1.5, 1.2, 1.0, 0.8]),
        (0.1, 0.5, 80.0),
    )
    without, with_ = cert.gains_that_do(c.plant, c.delays), cert.gains_that_do(c.plant, c.delays, extra)
    assert with_[0] > without[0]
    assert cert.output_bound(3.0, 2.0, 5.0) == 5.0 and cert.output_bound(1.0, 2.0, 5.0) == 2.0


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"K": -0.1}, "gains"),
        ({"h": 0.0}, "period"),
        ({"noise": (0.1, 0.1)}, "noise"),
        ({"delay_samples": -1}, "delay"),
    ],
)
def test_settings_that_are_none_are_refused(changes, word):
    settings = {"K": 0.3, "h": 0.1} | changes
    with pytest.raises(SettingsError, match=word):
        certify(windy("kvlcc2"), **settings)


def test_an_operating_set_of_nonsense_is_refused():
    model = windy("kvlcc2")
    for bad in ({"u": (3.0, 2.0)}, {"spin": (0.0, 1.0)}, {"v": (float("nan"), 1.0)}):
        with pytest.raises(SettingsError, match="operating set"):
            cert.of_ship(model, **bad)


def test_the_confined_model_is_the_model_inside_and_the_nearest_motion_outside():
    model = windy("kvlcc2").but(find("Current").plausible(load("kvlcc2")).but(north=1.0))
    operating = cert.of_ship(model)
    twin = Confined.to(model, operating)
    inputs = {"psi": 0.4, "r": 0.001, "n": 1.5, "delta": 0.1, "wind_speed": 8.0, "wind_to": 1.0}
    assert twin.nu_dot(Situation(u=6.0, v=0.2, **inputs)) == pytest.approx(
        model.nu_dot(Situation(u=6.0, v=0.2, **inputs)), rel=1e-12
    )
    w = model.water(Situation(psi=0.4))
    edge = operating.ranges["v"][1] + w.v
    assert twin.nu_dot(Situation(u=6.0, v=9.0, **inputs)) == pytest.approx(
        model.nu_dot(Situation(u=6.0, v=edge, **inputs)), rel=1e-12
    )


def test_a_certificate_goes_through_its_file_unchanged(vlcc, tmp_path):
    model, c = vlcc
    assert Certificate.from_json(c.to_json()) == c
    path = tmp_path / "kvlcc2.certificate.json"
    first = store.kept(path, model, 0.3, 0.1)
    stamp = path.stat().st_mtime_ns
    assert store.kept(path, model, 0.3, 0.1) == first and path.stat().st_mtime_ns == stamp
    other = store.kept(path, model.but(find("HullFouling").plausible(model.ship)), 0.3, 0.1)
    assert other.fingerprint != first.fingerprint
    for garbage in ("", "{", json.dumps({"version": 0}), "[]"):
        path.write_text(garbage)
        assert store.kept(path, model, 0.3, 0.1) == first


def test_the_loop_reads_a_certificate_without_numpy(vlcc, tmp_path):
    path = tmp_path / "c.json"
    path.write_text(vlcc[1].to_json())
    code = (
        "import sys; from twin.live.certificate.certificate import Certificate; from twin.live.certificate.observer_tube import Tube; from pathlib import "
        "Path;"
        f"t = Tube(Certificate.from_json(Path({str(path)!r}).read_text())); t.step((True, True, False)); "
        "print('numpy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == "False", done.stderr


def test_a_larger_disturbance_a_later_measurement_and_more_noise_widen_the_bound(vlcc):
    model, c = vlcc
    twice = Disturbance(tuple(2.0 * x for x in c.disturbance.calm))
    for worse in (
        certify(model, 0.3, 0.1, disturbance=twice),
        certify(model, 0.3, 0.1, 3),
        certify(model, 0.3, 0.1, noise=tuple(2.0 * x for x in c.noise)),
        certify(model, 0.3, 0.1, heading_noise=0.01),
    ):
        assert all(b > a for a, b in zip(c.bound, worse.bound, strict=True))


def test_perron_and_inverse_against_numpy():
    rng = np.random.default_rng(7)
    for _ in range(50):
        a = rng.random((3, 3)) * np.outer([1.0, 1.0, 1e-3], [1.0, 1.0, 1e3])  # units differ as in a ship
        t = tuple(map(tuple, a.tolist()))
        rho = max(abs(np.linalg.eigvals(a)))
        assert c3.radius(t) == pytest.approx(rho, rel=1e-9)
        assert c3.contracts(t, 1.001 * rho) and not c3.contracts(t, 0.999 * rho)
        assert np.array(c3.inverse(t)) == pytest.approx(np.linalg.inv(a), rel=1e-6)
        beyond = np.array(c3.beyond_first(c3.scaled(0.1, t)))
        exact = sum(np.linalg.matrix_power(0.1 * a, k) / np.prod(range(1, k + 1)) for k in range(2, 20))
        assert beyond == pytest.approx(exact, rel=1e-9)


def test_effects_switched_off_keep_within_the_certificate():
    """Test: the wind sensor fails, the wind effect goes. Expected: slopes without it lie within the bounds
    with it.
    """
    model = windy("usv")
    operating = cert.of_ship(model)
    with_, without = slopes(model, operating.ranges), slopes(replace(model, effects=()), operating.ranges)
    for i in range(3):
        for j in range(4):
            assert with_.lo[i][j] <= without.lo[i][j] and without.hi[i][j] <= with_.hi[i][j]
