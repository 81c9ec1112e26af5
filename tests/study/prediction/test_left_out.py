"""Which part of a single voyage is predicted by which half of it."""

from dataclasses import replace

import numpy as np

from tests.study.track.test_holes import with_hole
from twin.physics.model import Model
from twin.study.estimation.columns import core_unknowns, with_values
from twin.study.estimation.dissipation import DIRECTIONS, power
from twin.study.estimation.normal import Normal
from twin.study.prediction import left_out
from twin.study.prediction.left_out import halved_at
from twin.study.track.segments import segments
from twin.study.track.track import track


def test_a_single_voyage_with_a_hole_is_halved_where_the_fit_halves_it(make, kvlcc2):
    """Test: a hole behind the first of four segments, and no hole. Expected: the half that is predicted begins
    where the second half of the segments does; in the middle where there is no hole."""
    whole = make(seconds=2600.0)
    holed, whole = (track(v, kvlcc2) for v in (with_hole(whole, 4e4, at_s=660.0), whole))
    where = tuple(segments([holed], float(kvlcc2.scale("time"))))
    halves = Normal(*[np.zeros(0)] * 6, where).voyages()
    assert halves.tolist() == [0, 0, 1, 1]
    assert abs(halved_at(holed) - where[2][1]) < 0.01 * len(holed)
    assert halved_at(whole) == len(whole) // 2


def test_what_was_not_read_counts_for_no_error_of_zero():
    """Test: unit errors of all channels, of the log on one of three voyages. Expected: unit variances, and a
    covariance."""
    errors = np.random.default_rng(0).standard_normal((1200, 8))
    errors[400:, 6:] = np.nan
    S = left_out._mean_square(errors)
    np.testing.assert_allclose(np.diag(S), 1.0, atol=0.25)
    assert np.linalg.eigvalsh(S).min() > 0.0
    assert (left_out._mean_square(np.full((5, 8), np.nan)) == 0.0).all()


def test_a_voyage_of_which_nothing_can_be_predicted_changes_nothing_of_what_the_others_scatter_by(
    make, kvlcc2
):
    """Test: two voyages of half an hour, and a third without rudder and shaft. Expected: the tail of the two
    alone."""
    told = [track(make(seconds=1800.0, seed=s), kvlcc2) for s in (1, 2)]
    blind = replace(told[0], whole=np.zeros_like(told[0].whole))
    of_two, of_three = (
        left_out.path_error(Model.of(kvlcc2), tracks, [Model.of(kvlcc2)] * len(tracks))
        for tracks in (told, [*told, blind])
    )
    assert of_three.tail == of_two.tail > 2.0


def test_a_ship_without_one_of_its_voyages_takes_energy_out_of_its_motion_all_the_same(kvlcc2, monkeypatch):
    """Test: the others alone would have a cross-flow drag that pushes, ten prior widths off. Expected: the most
    probable numbers with which the hull is damped whichever way it moves, and the other step as it is."""
    model = Model.of(kvlcc2)
    unknowns = core_unknowns(model)
    away, near = np.zeros((2, len(unknowns)))
    away[[u.name for u in unknowns].index("Y_vv")], near[0] = 10.0, 0.01
    of_others = iter((np.zeros(len(unknowns)), away, near))
    monkeypatch.setattr(left_out, "voyages", lambda *_: ["one", "another"])
    monkeypatch.setattr(left_out, "ship_of", lambda *_: (next(of_others), np.eye(len(unknowns))))
    first, second = left_out.models_without(model, unknowns, None, away, away, 1.0, {})
    u, v, r = (DIRECTIONS * 1.5 * float(kvlcc2.U_0)).T
    assert power(first.ship, u, v, r / float(kvlcc2.L_pp)).min() > 0.0
    assert second == with_values(model, unknowns[:1], [unknowns[0].centre + 0.01 * unknowns[0].sd], {})
