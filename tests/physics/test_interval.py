"""Intervals enclose: whatever number is picked inside a box, the result lies inside the result of the box."""

import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from twin.physics import maths
from twin.physics.dual import Dual
from twin.physics.effects import BUILT_IN
from twin.physics.interval import Interval, hull
from twin.physics.model import Model
from twin.physics.state import Situation

ordinary = st.floats(-50.0, 50.0).map(lambda x: round(x, 6))


def box_and_point(ends, share):
    """(lo, hi, a point inside)."""
    lo, hi = min(ends), max(ends)
    return lo, hi, min(max(lo + share * (hi - lo), lo), hi)


boxes = st.builds(box_and_point, st.tuples(ordinary, ordinary), st.floats(0.0, 1.0))
ONE = {
    "sin": maths.sin,
    "cos": maths.cos,
    "tanh": maths.tanh,
    "exp": maths.exp,
    "abs": abs,
    "negative": lambda x: -x,
    "square": lambda x: x * x,
    "cube": lambda x: x**3,
    "fourth": lambda x: x**4,
    "root": lambda x: maths.sqrt(x * x + 0.5),
    "positive": maths.positive,
    "self": lambda x: x * abs(x),
    "inverse": lambda x: 1.0 / (x * x + 0.1),
    "clip": lambda x: maths.clip(x, -1.0, 2.0),
    "switch": lambda x: maths.where(x > 3.0, x * x, -x),
    "both": lambda x: maths.where((x > -1.0) & (x < 2.0), x, 0.5 * x),
}
TWO = {
    "sum": lambda x, y: x + y,
    "difference": lambda x, y: x - y,
    "product": lambda x, y: x * y,
    "quotient": lambda x, y: x / (y * y + 1.0),
    "length": maths.hypot,
    "least": maths.minimum,
    "most": maths.maximum,
    "angle": maths.atan2,
    "modulus": lambda x, y: abs(x) * y,
    "larger": lambda x, y: maths.where(x > y, x * y, x + y),
}


def holds(interval, value):
    return interval.lo <= value <= interval.hi


@pytest.mark.parametrize("name", ONE)
@given(box=boxes)
def test_a_function_of_a_point_lies_in_the_function_of_the_box(name, box):
    lo, hi, x = box
    assert holds(ONE[name](Interval(lo, hi)), ONE[name](x))


@pytest.mark.parametrize("name", TWO)
@given(a=boxes, b=boxes)
def test_a_function_of_two_points_lies_in_the_function_of_the_boxes(name, a, b):
    assert holds(TWO[name](Interval(*a[:2]), Interval(*b[:2])), TWO[name](a[2], b[2]))


@pytest.mark.parametrize("name", [n for n in ONE if n not in ("switch", "both")])
@given(box=boxes)
def test_the_slope_between_two_points_lies_in_the_slopes_of_the_box(name, box):
    lo, hi, x = box
    if hi - lo < 1e-3 or abs(x - lo) < 1e-3:
        return
    slope = ONE[name](Dual(Interval(lo, hi), (1.0,))).slopes[0]
    secant = (ONE[name](x) - ONE[name](lo)) / (x - lo)
    error = 1e-12 * (abs(ONE[name](x)) + abs(ONE[name](lo)) + 1.0) / (x - lo)
    low, high = (slope.lo, slope.hi) if isinstance(slope, Interval) else (slope, slope)
    assert low - error <= secant <= high + error


@given(a=boxes, b=boxes)
def test_the_slope_of_a_length_is_never_more_than_one(a, b):
    """Also where the box holds the point of rest, where the root's own slope would be infinite."""
    length = maths.hypot(Dual(Interval(*a[:2]), (1.0, 0.0)), Dual(Interval(*b[:2]), (0.0, 1.0)))
    for slope in length.slopes:
        assert slope.lo >= -1.0 - 1e-12 and slope.hi <= 1.0 + 1e-12


def test_forms_that_physics_uses_are_not_taken_apart():
    x = Interval(-2.0, 1.0)
    assert (x * x).lo == 0.0
    assert maths.minimum(Interval(0.0, 10.0), Interval(5.0, 6.0)).hi == 6.0
    thrust = maths.positive(Interval(-1e6, -1e5))
    assert 0.0 <= thrust.hi < 1e-9
    assert maths.sin(Interval(0.0, math.pi)).hi == 1.0


def test_what_cannot_be_bounded_is_infinite_not_wrong():
    whole = 1.0 / Interval(-1.0, 2.0)
    assert (whole.lo, whole.hi) == (-math.inf, math.inf)


def test_branching_on_an_interval_is_refused():
    with pytest.raises(TypeError, match=r"maths\.where"):
        bool(Interval(0.0, 1.0) > 0.5)


def test_a_third_of_three_is_rounded_outward():
    third = Interval(1.0, 1.0) / 3.0
    assert third.lo < 1.0 / 3.0 < third.hi and third.hi - third.lo < 3e-16


def test_arrays_of_boxes_answer_as_boxes_one_by_one():
    rng = np.random.default_rng(1)
    lo = rng.uniform(-3.0, 3.0, 200)
    hi = lo + rng.uniform(0.0, 2.0, 200)
    for name, f in ONE.items():
        many = f(Interval(lo, hi))
        for i in range(0, 200, 37):
            one = f(Interval(float(lo[i]), float(hi[i])))
            assert (many.lo[i], many.hi[i]) == pytest.approx((one.lo, one.hi), rel=1e-13, abs=1e-13), name


SPREAD = {
    "u": 0.6, "v": 0.8, "r": 0.01, "psi": 1.0, "delta": 0.3, "n": 1.0, "wind_speed": 6.0, "wind_to": 2.0,
    "depth": 3.0, "H_s": 1.0, "T_p": 2.0, "wave_to": 2.0, "draught": 0.3, "bank_port": 20.0,
    "bank_starboard": 20.0, "phi": 0.1, "t": 600.0,
}  # fmt: skip
MOVING = [None, *(kind for kind in BUILT_IN if kind.kind in ("Force", "Flow"))]


@pytest.mark.parametrize("Kind", MOVING, ids=lambda kind: kind.__name__ if kind else "core")
# the moment is only read
@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_every_force_and_flow_is_enclosed_with_its_slopes(Kind, data, ship, moment):
    """Test: random boxes around a busy moment, random points inside. Expected: nu_dot and its slopes lie
    inside, finite.
    """
    draw = data.draw
    model = Model(ship, (Kind.plausible(ship),) if Kind else ())
    middle = {k: moment[k] + draw(st.floats(-1.0, 1.0)) * 0.3 * w for k, w in SPREAD.items()}
    width = {k: draw(st.floats(0.0, 1.0)) * 0.2 * w for k, w in SPREAD.items()}
    point = {k: middle[k] + draw(st.floats(-1.0, 1.0)) * width[k] for k in SPREAD}
    names = ("u", "v", "r", "psi")
    box = Situation(
        **{k: seeded(k, Interval(middle[k] - width[k], middle[k] + width[k]), names) for k in SPREAD}
    )
    exact = Situation(**{k: seeded(k, float(x), names) for k, x in point.items()})
    for sure, here in zip(model.nu_dot(box), model.nu_dot(exact), strict=True):
        for a, b in zip((sure.value, *sure.slopes), (here.value, *here.slopes), strict=True):
            a = hull(a)
            tolerance = 1e-11 * (1.0 + abs(b))
            assert math.isfinite(a.lo) and math.isfinite(a.hi)
            assert a.lo - tolerance <= b <= a.hi + tolerance


def seeded(name, value, names):
    return Dual(value, tuple(1.0 if name == n else 0.0 for n in names))


def test_dual_numbers_on_floats_agree_with_differences(ship, moment):
    model = Model(ship, tuple(kind.plausible(ship) for kind in MOVING if kind and kind.__name__ != "Loading"))
    known = {f.name for f in fields(Situation)}
    values = {k: v for k, v in moment.items() if k in known}
    names = ("u", "v", "r", "psi")
    slopes = model.nu_dot(
        Situation(**{k: seeded(k, v, names) if k in SPREAD else v for k, v in values.items()})
    )
    for j, name in enumerate(names):
        h = 1e-6
        up, down = (model.nu_dot(Situation(**values | {name: values[name] + s * h})) for s in (1.0, -1.0))
        for rate, a, b in zip(slopes, up, down, strict=True):
            assert rate.slopes[j] == pytest.approx((a - b) / (2.0 * h), rel=1e-5, abs=1e-8)
