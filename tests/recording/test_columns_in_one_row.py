"""Several columns of a table that are one channel."""

import numpy as np

from twin.recording.cells import in_one_row, sum_of

NAN = np.nan


def test_the_mean_of_two_shafts_that_a_log_tells_of_one_after_the_other():
    """Expected: by hand, in each row that has one of them the mean with the other as it was told last; none before
    both were told, nor where one is silent for more than twice its usual rows."""
    port = np.array([90.0, NAN, NAN, 92.0, NAN, NAN, 94.0, NAN, NAN, 96.0, NAN, NAN, 98.0])
    starboard = np.array([NAN, 80.0, NAN, NAN, 82.0, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN])
    mean = sum_of(in_one_row([port, starboard]), (0.5, 0.5))
    expected = [NAN, 85.0, NAN, 86.0, 87.0, NAN, 88.0, NAN, NAN, 89.0, NAN, NAN, NAN]
    assert np.array_equal(mean, expected, equal_nan=True)


def test_columns_that_stand_in_one_row_stay_as_they_are():
    port, starboard = np.array([90.0, NAN, 92.0]), np.array([80.0, 81.0, NAN])
    assert np.array_equal(sum_of(in_one_row([port, starboard]), ()), [170.0, NAN, NAN], equal_nan=True)


def test_a_column_that_says_nothing_is_not_filled():
    silent = np.full(3, NAN)
    assert np.isnan(sum_of(in_one_row([np.array([1.0, 2.0, 3.0]), silent]), ())).all()
