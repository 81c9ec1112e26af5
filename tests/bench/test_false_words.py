"""`twin-bench false-words`: what counts as one word, what of a file is kept, what the page says of none."""

from bench.false_words import TrueVoyage, cases, kept_voyages, page, without_numbers


def test_the_same_word_with_other_numbers_or_passed_on_is_one_word():
    said = ("certificate: positions, off = 49.2 m", "learned force off: positions, off = 50.1 m")
    assert len({without_numbers(text) for text in said}) == 1
    assert without_numbers("no heading") != without_numbers("no rudder_angle_deg")


def test_a_voyage_whose_line_was_cut_off_is_sailed_again(tmp_path):
    (tmp_path / "v.jsonl").write_text(
        '{"hull": "usv", "sea": "calm", "manoeuvre": "mixed", "seed": 400, "seconds": 1800.0, "without_s": 18.0, '
        '"false": {}, "withdrawn": {"wide": 2}}\n{"hull": "usv", "se'
    )
    (voyage,) = kept_voyages(tmp_path / "v.jsonl")
    assert voyage == TrueVoyage("usv", "calm", "mixed", 400, 1800.0, 18.0, {}, {"wide": 2})
    # by hand: half an hour, none seen: below 3 in half an hour; 18 s of 1800; two in half an hour
    assert "| usv | calm | 1 | 0.50 | 0 | 0 (below 6000) | 1.0 % | 4000 |  |" in page([voyage])


def test_a_round_has_every_hull_in_every_sea():
    """Expected: four hulls calm and in waves; three of them, with seas of their own size, in two seas more."""
    assert len({(hull, sea) for _, hull, sea, *_ in cases(1, 60.0)}) == 14
