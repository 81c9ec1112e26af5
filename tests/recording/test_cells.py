"""Cells become numbers of a channel: degrees as people write them, with their sign."""

import pytest

from twin.recording.cells import degrees_of


@pytest.mark.parametrize(
    ("text", "deg"),
    [
        ("57°30.6'N", 57.51),
        ("57 30.6S", -57.51),
        ("57 deg 30.6 min S", -57.51),
        ("57 degrees 30.6 minutes North", 57.51),
        ("11 06 36 West", -11.11),
        ("South 11 06 36", -11.11),
        ("11d06m36sW", -11.11),
        ("11d06m36s", 11.11),
        ("11 deg 6 min 36 sec E", 11.11),
        ("-57 30.6", -57.51),
    ],
)
def test_only_a_letter_or_word_of_its_own_is_a_hemisphere(text, deg):
    assert degrees_of(text) == pytest.approx(deg)


@pytest.mark.parametrize("text", ["57 30.6 Sud", "57 30 lost", "57 30 N S", "57 30.6 SE"])
def test_letters_that_are_no_hemisphere_are_refused_and_not_guessed_at(text):
    with pytest.raises(ValueError):
        degrees_of(text)
