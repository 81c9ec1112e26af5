"""What an effect's form may miss that the ship's file got after its calibration."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics import core
from twin.physics.effects import find
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.open_loop_check import mean_error_m
from twin.study.estimation.columns import ROUGH
from twin.study.estimation.respond import respond, standard
from twin.study.estimation.rough import KNOWN, TERMS, accelerations, doubted, elsewhere


@pytest.fixture(scope="module")
def windy(tanker, voyages):
    """A voyage in wind, by a ship whose file knows the wind since it was calibrated."""
    return assemble([voyages["Wind"]], tanker.with_effects(find("Wind").plausible(tanker)))


def test_a_tenth_of_a_known_wind_is_doubted_at_each_moment_and_for_each_course(windy):
    """And where along the hull it pushes it aside by a twentieth of its length: N = L Y / 20."""
    (track,), model = windy.tracks, windy.model
    force = respond(track, model)[0] - respond(track, replace(model, effects=()))[0]
    pushed = model.known(track.situation())["Wind"].Y
    turned = core.accelerations(0.0 * pushed, 0.0 * pushed, 0.05 * model.ship.L_pp * pushed, model.c)
    doubt = np.hypot(KNOWN * force, np.column_stack(turned))
    np.testing.assert_allclose(doubted(track, model), doubt)
    terms, usual = accelerations(track, model), np.sqrt(np.mean(doubt**2, axis=0))
    strength = np.linalg.norm(doubt / standard(model), axis=1)
    assert tuple(terms) == TERMS
    np.testing.assert_allclose(
        terms["sway_sin"][:, 1],
        usual[1] * strength / np.sqrt(np.mean(strength**2)) * np.sin(track.state[:, 2]),
    )
    assert not terms["sway_sin"][:, [0, 2]].any() and np.sqrt(
        np.mean(terms["yaw_always"][:, 2] ** 2)
    ) == pytest.approx(usual[2])


def test_only_a_ship_that_learned_an_effect_after_her_calibration_has_such_columns(case_of, windy):
    assert (
        sum(u.owner == ROUGH for u in windy.unknowns)
        == len(TERMS)
        == sum(u.owner == ROUGH for u in windy.nuisance.unknowns)
    )
    case = case_of("nothing")
    assert not any(u.owner == ROUGH for u in case.unknowns)


def test_a_known_wind_that_a_voyage_did_not_record_pushes_it_nowhere_else(tanker, voyages):
    """Test: a ship whose file knows the wind since it was calibrated, on a voyage without an anemometer.
    Expected: how far off wind's lever may leave it there is nothing."""
    calm = voyages["nothing"]
    columns = {name: x for name, x in calm.columns.items() if "wind" not in name}
    windy = tanker.with_effects(find("Wind").plausible(tanker))
    case = assemble([calm.with_rows(calm.time_s, columns)], windy)
    assert "wind_speed" in case.tracks[0].missing()
    levered = [mean_error_m(case, model) for both in elsewhere(case.model) for model in both]
    assert levered == pytest.approx([mean_error_m(case, case.model)] * 2, rel=1e-12)


def test_a_steady_pull_that_a_known_wind_may_have_missed_tells_little(windy):
    """Test: what a voyage in a known wind says of a constant force over ground, with and without the doubt
    about the wind's form. Expected: less with it, for the wind blew from one side; and as much of a compass
    that is off."""
    sure = replace(windy, nuisance=_sure(windy.nuisance))
    with_doubt, without = (case.reduced(case.lines, case.scenarios(["usual"]))[0] for case in (windy, sure))
    pull, compass = (with_doubt.rows((name,)) for name in ("ExternalForce", "HeadingBias"))
    tells = lambda reduced, rows: float(np.trace(reduced.A[np.ix_(rows, rows)]))
    assert tells(with_doubt, pull) < 0.92 * tells(without, pull)
    assert tells(with_doubt, compass) > 0.95 * tells(without, compass)


def _sure(nuisance):
    certain = np.array([1e8 if u.owner == ROUGH else 0.0 for u in nuisance.unknowns])
    return replace(nuisance, information=nuisance.information + np.diag(certain))
