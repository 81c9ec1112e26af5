"""What the errors of all channels are told by."""

import numpy as np

from twin.study.prediction import score


def test_headings_of_two_voyages_on_other_courses_are_explained_no_better_than_on_one():
    """Test: the same scatter of what was measured, and the same errors, about 5 and 355 deg and about 5 deg twice.
    Expected: the same share explained."""
    rng = np.random.default_rng(1)
    seen, error = rng.standard_normal((2, 50)), 0.3 * rng.standard_normal(100)
    told = [
        np.concatenate([score._about_its_mean(s + c) for s, c in zip(seen, courses, strict=True)])
        for courses in ((5, 355), (5, 5))
    ]
    apart, alike = (score._explained(error, t) for t in told)
    assert abs(apart - alike) < 1e-9
    assert 0.8 < alike < 1.0
    assert np.isnan(score._about_its_mean(np.full(3, np.nan))).all()
