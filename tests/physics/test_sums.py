"""Sums whose bits are the same in every Python."""

from fractions import Fraction
from math import fsum

from twin.physics.maths import dot, total


def test_a_sum_goes_from_left_to_right_and_corrects_nothing():
    """Test: numbers of which a correcting sum keeps what a plain one loses. Expected: what rounding after
    each addition leaves."""
    lost = [1e16, 1.0, 1.0, -1e16]
    assert total(lost) == 0.0 != fsum(lost)
    tenths = [0.1] * 10
    assert total(tenths) == 0.9999999999999999 != fsum(tenths)
    assert total(reversed([1e16, -1e16, 1.0])) == 0.0 and total([1e16, -1e16, 1.0]) == 1.0


def test_an_inner_product_goes_the_same_way():
    ones = [1.0, 1.0, 1.0, 1.0]
    assert dot([1e16, 1.0, 1.0, -1e16], ones) == 0.0 and dot([1e16, -1e16, 1.0, 1.0], ones) == 2.0
    assert dot([0.1] * 10, [1.0] * 10) == 0.9999999999999999


def test_whole_numbers_and_fractions_stay_what_they_are():
    assert total([2**60, 1, 2]) == 2**60 + 3 and total([]) == 0 and total([Fraction(1, 3)] * 3) == 1
