"""A fitted hull's resistance grows with its speed as fast as a ship may be taken to go, whatever a few sailed
speeds seem to tell."""

import numpy as np
import pytest

from twin.physics import core
from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.estimation.box import within
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.dissipation import FASTEST, KEPT, half_spaces
from twin.study.estimation.fit import fit
from twin.study.estimation.innovations import NoiseModel
from twin.study.prediction.trial import shaft_speed
from twin.study.track.track import READINGS, Track

SHIPS = ("kvlcc2", "kvlcc2_model", "container", "usv")
STEP_S = 0.5


def resistance(ship, speeds):
    """(N,) [N] at these speeds (in service speeds), without its linear part."""
    c = ship.with_derivatives(X_u=0.0).c
    return np.array([-float(core.resistance(x * float(ship.U_0), c)) for x in speeds])


def rises(ship):
    """Whether it grows at every speed up to FASTEST."""
    return bool((np.diff(resistance(ship, np.linspace(0.0, FASTEST, 301))) > 0.0).all())


def resistance_only(ship):
    return [u for u in core_unknowns(Model.of(ship)) if u.name in ("X_uu", "X_uuu")]


def with_z(ship, unknowns, z):
    return ship.with_derivatives(**{u.name: u.centre + u.sd * x for u, x in zip(unknowns, z, strict=True)})


@pytest.mark.parametrize("name", SHIPS)
def test_resistance_grows_wherever_every_half_space_is_kept(name):
    """Test: pairs of X_uu and X_uuu drawn about the ship's. Expected: of those that are moved inside, all
    grow; of those as they were drawn, many fall."""
    ship = load(name)
    unknowns = resistance_only(ship)
    spaces = half_spaces(ship, unknowns)
    far, rng = np.full(2, 9.0), np.random.default_rng(2)
    drawn = 3.0 * rng.standard_normal((100, 2))
    assert np.mean([rises(with_z(ship, unknowns, z)) for z in drawn]) < 0.8
    for z in drawn:
        inside = within(z, np.eye(2), np.array([-far, far]), spaces)
        assert rises(with_z(ship, unknowns, inside))
        if rises(ship) and (spaces.rows @ z >= spaces.least).all():
            assert inside == pytest.approx(z)


def test_resistance_that_grows_less_than_quadratically_stays_as_it_is():
    """A boat that begins to plane: flat at FASTEST but for a fifth of the growth of the first model's."""
    ship = load("usv")
    unknowns = resistance_only(ship)
    wave = np.sqrt(core.GRAVITY * float(ship.L_pp))
    X_uu = unknowns[0].centre
    X_uuu = -0.8 * X_uu * 2.0 * wave / (3.0 * FASTEST * float(ship.U_0))
    z = np.array([0.0, X_uuu / unknowns[1].sd])
    far = np.full(2, 99.0)
    assert within(z, np.eye(2), np.array([-far, far]), half_spaces(ship, unknowns)) == pytest.approx(z)


def test_how_much_growth_is_kept_is_a_tenth_of_the_first_models_by_hand():
    """At FASTEST: 2 X_uu + 3 X_uuu F = KEPT 2 X_uu of the first model, F Froude's number."""
    ship = load("usv")
    unknowns = resistance_only(ship)
    far = np.full(2, 99.0)
    z = within(
        np.array([0.0, 20.0]), np.diag([1e-9, 1.0]), np.array([-far, far]), half_spaces(ship, unknowns)
    )
    F = FASTEST * float(ship.U_0) / np.sqrt(core.GRAVITY * float(ship.L_pp))
    X_uu = unknowns[0].centre
    assert unknowns[1].sd * z[1] == pytest.approx(-(1.0 - KEPT) * 2.0 * X_uu / (3.0 * F), rel=1e-6)


def planing(ship, u):
    """Resistance [N] over a hump at 0.6 of service speed, flat behind it and growing again."""
    x = np.abs(u) / float(ship.U_0)
    at_service = float(resistance(ship, [1.0])[0])
    hump = 0.35 * np.exp(-(((x - 0.6) / 0.16) ** 2))
    return at_service * np.sign(u) * (1.17 * x**2 / (0.3 + x**2) + hump + 0.1 * x**2)


def launch():
    """Ten minutes straight ahead of a boat that planes, its shaft changed each half a minute."""
    ship, rng, steps = load("usv"), np.random.default_rng(1), 1200
    U, c = float(ship.U_0), ship.c
    n = np.repeat(shaft_speed(Model.of(ship), U) * rng.uniform(0.6, 1.2, steps // 60), 60)
    path = np.zeros((steps, 6))
    path[0, 3] = 0.7 * U
    for k in range(steps - 1):
        u = path[k, 3]
        X = c.thrust_share * core.thrust(u, n[k], c) - planing(ship, u)
        path[k + 1, 3] = u + STEP_S * X / c.m_u
        path[k + 1, 0] = path[k, 0] + STEP_S * 0.5 * (u + path[k + 1, 3])
    measured = np.full((steps, len(READINGS)), np.nan)
    measured[:, :6] = path
    time_s, sd = STEP_S * np.arange(steps), np.full(8, 0.01)
    return ship, Track("l", time_s, STEP_S, path, np.zeros(steps), n, {}, measured, sd, np.ones(steps, bool))


def test_a_fit_to_a_boat_that_planes_has_no_resistance_that_falls():
    """Test: X_uu and X_uuu fitted to ten minutes of speed changes of a hull with a hump, up to 1.3 U_0; and
    where the same equations would go inside the boxes alone. Expected: that falls below FASTEST although
    it still dissipates there; the fit's grows."""
    ship, t = launch()
    unknowns = resistance_only(ship)
    found = fit([t], Model.of(ship), unknowns, catalogue(), NoiseModel())
    assert rises(found.model.ship)
    A, b, _ = found.normal.total()
    sd, centre = np.array([[u.sd, u.centre] for u in unknowns]).T
    z, spread = (found.value - centre) / sd, np.linalg.inv(A * np.outer(sd, sd) + np.eye(2))
    box = (np.array([[u.lo, u.hi] for u in unknowns]).T - centre) / sd
    free = within(z + spread @ (b * sd - z), spread, box, (np.zeros((0, 2)), np.zeros(0)))
    other = with_z(ship, unknowns, free)
    assert not rises(other)
    assert resistance(other, [FASTEST])[0] > KEPT * resistance(ship, [FASTEST])[0]
