"""The slopes of the part of the operating set in which the ship surely is: cells, parts, and a step in them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from bench.stability.attack.cases import AttackCase, certified_for
from twin.live.certificate.certificate import Certificate, certify, digest
from twin.live.certificate.enclosure import contribution, points_of, situation_of
from twin.live.certificate.plant import usual_noise
from twin.live.certificate.rolled import InnerStep, way
from twin.live.certificate.set_cells import Cells
from twin.live.certificate.set_parts import SetPart, SetParts
from twin.live.observer.dynamics import KnownDynamics
from twin.physics.effects import find
from twin.physics.model import CORE, Model
from twin.physics.ship import load
from twin.physics.state import Force, Situation

SAMPLES = 4000


@pytest.fixture(scope="module")
def boat():
    model, c = certified_for(AttackCase("usv", 10.0))
    return Model.of(load("usv", arrays=False)), c, SetParts(c, c.plant.cells), model


def rates_at(model, at):
    """Rates and slopes (3, 5, N) of the physics at these points, in water without a current."""
    told = contribution(model, situation_of(at), frozenset(CORE))
    return np.array([[np.broadcast_to(x, SAMPLES) for x in (rate.value, *rate.slopes)] for rate in told])


def test_no_point_of_a_cell_is_steeper_than_its_numbers(boat):
    """Test: random points and corners of the set as far as a bound may reach. Expected: rate and slopes at each of
    them are no more than the numbers of the cell in which it lies, and the greatest are met to a tenth."""
    model, c, parts, _ = boat
    at = points_of({**parts.operating.ranges, "stream": (0.0, 0.0)}, SAMPLES, 5)
    rates, cells = rates_at(model, at), c.plant.cells
    met = np.zeros(3)
    for k in range(SAMPLES):
        here = tuple(float(at[name][k]) for name in ("u", "v", "r"))
        steep = cells.over(cells.span(here, here))
        size, own = np.abs(rates[:, 1:4, k]), np.diagonal(rates[:, 1:4, k])
        assert np.all(size.ravel() <= steep.size) and np.all(own <= steep.top)
        assert np.all(np.abs(rates[:, 4, k]) <= steep.heading) and np.all(
            np.abs(rates[:, 0, k]) <= steep.most
        )
        met = np.maximum(met, size.max(axis=1) / np.max(np.reshape(steep.size, (3, 3)), axis=1))
    assert np.all(met > 0.9)


def test_over_the_set_of_the_certificate_the_cells_are_as_steep_as_its_plant(boat):
    """Expected: the numbers of all cells in the set, with its greatest current, are those of the plant to what their
    cells reach beyond the set."""
    _, c, _, _ = boat
    low, high = zip(*(c.operating.ranges[name] for name in ("u", "v", "r")), strict=True)
    steep = c.plant.cells.over(c.plant.cells.span(low, high))
    current, size = c.operating.ranges["stream"][1], c.plant.magnitude()
    for i in range(3):
        for j in range(3):
            told = steep.size[3 * i + j] + (current if j == 2 and i < 2 else 0.0)
            assert size[i][j] <= told * 1.0001 and told <= 1.4 * size[i][j]


def test_a_part_of_the_set_holds_what_lies_in_it_with_its_way(boat):
    """Expected: the part around a motion contains it with its bound and the way of a step; at sea speed it is a
    fraction of the set and its way a fraction of the set's; near the edge there is none."""
    _, c, parts, _ = boat
    force, x = c.disturbance.at(0.0), (0.06, 0.06, 0.01, 0.005)
    part, everywhere = parts.around((1.2, 0.0, 0.0, 0.0), x, force), parts.everywhere.under(force)
    assert part.holds((1.2, 0.0, 0.0, 0.0), x)
    assert part.way[2] < 0.3 * everywhere.way[2]
    (u0, _), (_, v1), (_, r1) = (parts.operating.ranges[name] for name in ("u", "v", "r"))
    assert parts.around((1.2, v1 - 0.061, 0.0, 0.0), x, force) is None  # in the set, but its way is not
    assert parts.around((1.2, v1 - 0.09, 0.0, 0.0), x, force) is not None
    assert parts.around((u0 + 0.05, 0.0, 0.0, 0.0), x, force) is None
    assert parts.around((1.2, 0.0, r1, 0.0), x, force) is None
    most = parts.operating.ranges["stream"][1]
    assert parts.around((1.2, 0.0, 0.0, 1.01 * most), x, force) is None
    with_current = parts.around((1.2, 0.0, 0.0, most), x, force)
    assert all(a[2] > b[2] for a, b in zip(with_current.rows[:2], part.rows[:2], strict=True))


def test_rows_that_are_straight_in_the_force_are_those_of_the_inner_step(boat):
    _, c, _, _ = boat
    plant = replace(c.plant, cells=None).at_period(c.h / c.inner)
    ends = tuple(plant.operating.ranges[name] for name in ("u", "v", "r"))
    for force in ((2.0, 3.0, 5.0), (0.0, 7.0, 1.0)):
        part, step = SetPart(plant, ends, 0.0).under(force), InnerStep(plant, clipped=False)
        assert part.way == pytest.approx(way(plant, force))
        d = step.pushes(force, way(plant, force)[2])
        for row, m, told in zip(part.rows, step.M, d, strict=True):
            assert row == pytest.approx((*m, told), rel=1e-12)


@pytest.mark.parametrize("speed", [1.4, 1.0])
def test_damping_takes_an_error_of_turning_away_where_nothing_is_clipped(boat, speed):
    """Test: a step without a force from an error of turning alone. Expected: in the part of the set it falls, and
    by the slopes of the whole set, where clipping may switch damping off, it grows."""
    _, c, parts, _ = boat
    part = parts.around((speed, 0.0, 0.0, 0.0), (0.02, 0.02, 0.02, 0.0), (0.0, 1e-9, 0.0))
    whole = InnerStep(replace(c.plant, cells=None).at_period(c.h / c.inner))
    assert part.rows[2][2] < 0.995 < 1.0 < whole.M[2][2]


@pytest.mark.parametrize("current", [0.0, 0.3])
def test_no_pair_of_motions_parts_faster_than_a_region_says(boat, current):
    """Test: random pairs of ship and estimate in a current, a hostile force within D, any rudder and propeller, the
    ship sailed in forty steps, the estimate in one of the observer's. Expected: their distance after an inner step is
    within M x + d of the part that holds it, and nearly reaches it."""
    model, c, parts, _ = boat
    rng, force, h = np.random.default_rng(3), c.disturbance.at(0.0), c.h / c.inner
    dynamics, ranges = KnownDynamics(model, (0.0, current)), parts.operating.ranges
    closest, tried = np.zeros(3), 0
    scale = np.array([0.08, 0.1, 0.1, 0.01])
    while tried < 250:
        delta, n = (rng.uniform(*ranges[name]) for name in ("delta", "n"))
        psi, side = rng.uniform(-3.0, 3.0), rng.choice((-1.0, 1.0), 4)
        known = scale * rng.random() * np.array([1.0, 1.0, rng.random(), 1.0])
        water = dynamics.water(Situation(psi=psi))
        nu = np.array([rng.uniform(*ranges[name]) for name in ("u", "v", "r")])
        nu += np.array((water.u, water.v, 0.0))
        at = Situation(0.0, 0.0, psi, *nu, delta=delta, n=n)
        dynamics.forces(at)
        part = parts.around((at.u_r, at.v_r, at.r, current), tuple(known), force)
        if part is None:
            continue
        tried += 1
        push = Force(*(force * rng.choice((-1.0, 1.0), 3)))
        there = Situation(0.0, 0.0, psi + side[3] * known[3], *(nu + side[:3] * known[:3]), delta=delta, n=n)
        mean = dynamics.mean_rates(at, dynamics.forces(at), Force(0.0, 0.0, 0.0), h)
        estimate = np.array([*(nu + h * np.array(mean)), psi + h * (at.r + 0.5 * h * mean[2])])
        for _ in range(40):
            rates = dynamics.mean_rates(there, dynamics.forces(there), push, h / 40)
            there.psi += h / 40 * (there.r + 0.5 * h / 40 * rates[2])
            there.u, there.v, there.r = (
                z + h / 40 * rate for z, rate in zip((there.u, there.v, there.r), rates, strict=True)
            )
        error = np.abs(estimate - (there.u, there.v, there.r, there.psi))
        most = np.array([np.dot(row[:4], known) + row[4] for row in part.rows])
        assert np.all(error <= most * (1.0 + 1e-9)), (nu, known, error / most)
        closest = np.maximum(closest, (error / most)[:3])
    assert np.all(closest > 0.8)


def test_cells_that_do_not_fill_the_set_or_lack_a_number_are_not_believed(boat):
    """Test: a certificate whose file was changed, with a checksum that fits. Expected: ValueError."""
    _, c, _, _ = boat
    cells, ranges = c.plant.cells, c.operating.reach
    assert cells.whole(ranges) and Certificate.from_json(c.to_json()) == c
    first = cells.steep[0]
    for wrong in (
        replace(cells, steep=cells.steep[1:]),
        replace(cells, steep=(first[1:], *cells.steep[1:])),
        replace(cells, steep=((-first[0] - 1.0, *first[1:]), *cells.steep[1:])),
        replace(cells, steep=((float("nan"), *first[1:]), *cells.steep[1:])),
        replace(cells, edges=(cells.edges[0], cells.edges[2], cells.edges[1][::-1])),
        replace(cells, edges=(tuple(1.01 * x for x in cells.edges[0]), *cells.edges[1:])),
        replace(cells, moved=(-1.0, 0.0, 0.0)),
    ):
        assert not wrong.whole(ranges)
        table = json.loads(replace(c, plant=replace(c.plant, cells=wrong)).to_json())
        del table["version"], table["sha256"]
        told = json.dumps({"version": json.loads(c.to_json())["version"], "sha256": digest(table), **table})
        with pytest.raises(ValueError, match="does not follow"):
            Certificate.from_json(told)


def test_only_an_observer_with_inner_steps_has_cells_and_numbers_that_move_count_in_them():
    """Expected: what adaptation moves is no less over the set as far as a bound reaches than over the set."""
    ship = load("kvlcc2_model", arrays=False)
    model = Model.of(ship)
    worn = model.but(find("HullFouling").plausible(ship))
    usual = certify(model, 2.0, 0.05, noise=usual_noise(ship))
    assert usual.plant.cells is None
    cells = certify(model, None, 0.1, noise=usual_noise(ship), inner=3).plant.cells
    assert isinstance(cells, Cells) and cells.moved == (0.0, 0.0, 0.0)
    assert len(cells.steep) == 600
    plant = certify(worn, None, 0.1, noise=usual_noise(ship), inner=3, adapted=True).plant
    assert plant.moved[0] > 0.0 and all(a >= b for a, b in zip(plant.cells.moved, plant.moved, strict=True))
