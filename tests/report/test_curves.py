"""The drawings of the pages without a script: their points, and the marks of their axes."""

import re

import numpy as np
import pytest

from twin.report.curves import Curve, Curves, drawn, thinned


def test_a_drawing_keeps_the_peaks_of_what_it_thins():
    t = np.arange(100_000.0)
    y = np.sin(1e-3 * t)
    y[54_321] = 9.0
    y[7] = np.nan
    points = thinned(t, y)
    assert len(points) < 700 and (54_321.0, 9.0) in points
    assert [p[0] for p in points] == sorted(p[0] for p in points)


@pytest.mark.parametrize("values", ([0.0, 0.0], [1e-9, 5e12], [-3.0], [float("nan"), 2.0]))
def test_any_numbers_make_a_drawing_whose_points_are_inside_it(values):
    for log in (False, True):
        curve = Curve("line", "--model", list(enumerate(values)))
        text = drawn(Curves("c", "x", "y", [curve], log=log))
        wide, high = map(float, re.search(r'viewBox="0 0 (\d+) (\d+)"', text).groups())
        points = re.search(r'points="([^"]*)"', text)[1].split()
        assert points
        for x, y in (map(float, p.split(",")) for p in points):
            assert 0.0 <= x <= wide and 0.0 <= y <= high


def test_the_marks_of_a_drawings_axes_are_told_from_each_other():
    """Test: a position that changes by 5 mm in 10 ms, late in a voyage. Expected: no mark stands twice."""
    points = [(36000.0 + 1e-3 * k, 57.690 + 5e-4 * k) for k in range(11)]
    text = drawn(Curves("c", "", "", [Curve("line", "--model", points)]))
    marks = {side: re.findall(rf'anchor="{side}"[^>]*>([^<]+)<', text) for side in ("middle", "end")}
    assert all(len(told) > 2 and len(set(told)) == len(told) for told in marks.values())
    assert "57.692" in marks["end"] and "36000.005" in marks["middle"]
