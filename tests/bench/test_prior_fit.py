"""What the fleet's ships teach of how wide a prior should be, on ships whose terms were drawn by a known width."""

import numpy as np
import pytest

from bench.fleet.__main__ import main
from bench.fleet.prior_fit import STANDING, TERMS, WIDTHS, Likelihood, gains, learned, page
from twin.errors import DataError

TRUE = WIDTHS * np.geomspace(0.1, 2.0, WIDTHS.size)


def ships(count, seed=4):
    """Each term of each ship seen with a scatter of a tenth of its true width."""
    rng, out = np.random.default_rng(seed), []
    for i in range(count):
        information = 100.0 / TRUE**2
        seen = rng.normal(0.0, TRUE) + rng.normal(0.0, 0.1 * TRUE)
        out.append(Likelihood("abc"[i % 3], np.diag(information), information * seen))
    return out


def test_the_width_by_which_terms_were_drawn_is_found():
    """Expected: within four deviations of a scatter that is estimated from 200 ships."""
    found = learned(ships(200), 0.0)
    assert found == pytest.approx(TRUE, rel=4.0 / np.sqrt(400.0))


def test_widths_that_stand_for_all_the_world_are_kept():
    assert learned(ships(3), 1e9) == pytest.approx(WIDTHS, rel=1e-6)


def test_a_family_that_is_left_out_is_not_asked_itself():
    """Test: one family's terms are a hundred times as large. Expected: by what the others show, each of those is
    more probable, and this one less."""
    same = gains(ships(60), 0.0)
    assert len(same) == 60 and min(g for _, g in same) > 0.0
    other = [Likelihood("d", s.A / 1e4, s.b / 1e2) for s in ships(20, seed=5)]
    assert np.mean([g for family, g in gains([*ships(60), *other], 0.0) if family == "d"]) < 0.0


def test_the_page_has_a_line_for_each_term_and_each_weight_of_what_stands():
    text = "\n".join(page(ships(9)))
    assert all(f"| {name} |" in text for name in TERMS)
    assert all(f"\n| {c:g} |" in text for c in STANDING)


def test_a_folder_without_ships_or_answers_is_one_line(tmp_path, monkeypatch, capsys):
    for verb in ("prior", "peer", "table"):
        monkeypatch.setattr("sys.argv", ["bench.fleet", verb, str(tmp_path)])
        assert main() == DataError.exit_code
        assert capsys.readouterr().err.count("\n") == 1
