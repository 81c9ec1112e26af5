"""What a p-value means, in words."""

import pytest

from twin.study.diagnosis.against_healthy import healthy_in_words, since_in_words


def said(references: int, reach: int, asked: int = 1) -> str:
    """Of voyages of which so many references reach the score."""
    p = min(1.0, asked * (1 + reach) / (references + 1))
    return healthy_in_words(
        {
            "p_value": p,
            "p_value_references": references,
            "voyages": ["a"] * asked,
            "facts": {"reached": reach / references},
        }
    )


def test_a_voyage_like_others_of_the_healthy_ship_is_told_as_that():
    told = said(4, 2)
    assert (
        "2 of this ship's 4 reference voyages, with nothing wrong, were as unusual as this one (p = 0.6"
        in told
    )
    assert "1 of this ship's 4 reference voyages, with nothing wrong, was as unusual" in said(4, 1)
    assert "the most unusual of these 3" in said(4, 1, asked=3)


@pytest.mark.parametrize(
    "references, one_in, more", [(4, 5, "15 more"), (18, 19, "1 more reference voyage ")]
)
def test_few_references_say_how_many_more_would_tell(references, one_in, more):
    """Test: by hand, n references show 1 / (n + 1) at best, and 19 are needed for one in 20."""
    words = said(references, 0)
    assert f"this one is more unusual than each of this ship's {references} reference voyages" in words
    assert f"one healthy voyage in {one_in} is so by chance" in words and more in words


def test_of_several_voyages_more_references_are_needed():
    """Test: by hand, 3 / (4 + 1) at best; 3 / 60 takes 59 references."""
    words = said(4, 0, asked=3)
    assert "in up to 3 of 5 cases" in words and "55 more reference voyages" in words
    assert "in up to 3 of 3 cases" in said(2, 0, asked=3)


def test_enough_references_ask_for_no_more():
    assert said(19, 0).endswith("At most one healthy voyage in 20 is so by chance.")
    assert "more reference" not in said(59, 0, asked=3).split(". ", 1)[1]


def test_a_ship_file_without_scores_says_what_to_do():
    """Test: a ship that was never calibrated, asked alone and, as if calibrated, with reference voyages.
    Expected: neither is told to calibrate a second time."""
    of_references = healthy_in_words({"p_value": None, "calibrated": True})
    assert "no scores of reference voyages: twin calibrate keeps them" in of_references
    assert "again" not in of_references
    assert "never calibrated" in healthy_in_words({"p_value": None, "calibrated": False})


def test_a_ship_file_older_than_a_cause_is_named_with_it_and_one_that_is_not_says_nothing():
    (one,) = since_in_words(["Loading"])
    assert "calibrated when Loading was not known" in one and one.endswith("Calibrate again.")
    assert (
        "Loading, ActuatorLag.port+starboard were"
        in since_in_words(["Loading", "ActuatorLag.port+starboard"])[0]
    )
    assert since_in_words([]) == []
