"""The tube of reference voyages keeps its level on new ones, is no wider than it must be, and says what it cannot
promise."""

from dataclasses import replace
from math import hypot

import numpy as np
import pytest

from twin.errors import DataError
from twin.live.observer.predict import usual_error
from twin.live.prediction.calibrated import SECTION, calibrated_of
from twin.live.prediction.circumstances import Regressors
from twin.live.prediction.judge import Foretold, VerifiedPrediction
from twin.physics.ship import load
from twin.recording.voyage import Voyage
from twin.study.reference.tube_calibration import FEWEST_FIT, coefficients, needed, parted, section
from twin.study.reference.tube_doubts import doubts
from twin.study.reference.tube_lines import half_widths, rows

H = 60.0


@pytest.fixture(scope="module")
def ship():
    return load("kvlcc2")


def sailed(rng, count=60, H_s=None, steady=0.3):
    """A voyage: errors grow threefold over the range of waves, are twice as large across as along, and a
    part of them stays the same for the whole voyage."""
    H_s = rng.uniform(0.0, 3.0) if H_s is None else H_s
    size = 5.0 * np.exp(0.4 * H_s) * np.exp(steady * rng.normal())
    sea = "slight" if H_s < 0.5 else "moderate" if H_s < 1.25 else "rough"
    out = []
    for _ in range(count):
        phi = (1.0, abs(rng.normal()), 0.1, 0.0, 100.0 * H_s / 320.0, 0.5, 0.0, 0.0)
        helm = "moving" if rng.random() < 0.5 else "still"
        known = Regressors(phi, phi, helm, sea)
        along, across, heading = size * rng.normal(), 2.0 * size * rng.normal(), 0.002 * size * rng.normal()
        out.append(VerifiedPrediction(Foretold(0.0, 0.0, H, (), known), along, across, heading, True))
    return {H: out}


def made(ship, voyages):
    table = section(ship, "", voyages, "a test")
    return calibrated_of(replace(ship, notes={**ship.notes, SECTION: table})), table


def shares(ship, calibrated, voyage):
    """Inside, place and heading, by the code that runs on board."""
    usual = usual_error(ship, H)
    kept = []
    for j in voyage[H]:
        along, across, heading = calibrated.sigmas(H, j.foretold.known, usual)
        _, cell = calibrated.cell(H, j.foretold.known)
        q, q_psi = (calibrated.quantile(of, calibrated.level) for of in (cell.place, cell.heading))
        kept.append((hypot(j.along / along, j.across / across) <= q, abs(j.heading) <= q_psi * heading))
    return np.mean(kept, axis=0)


@pytest.mark.parametrize("count", (12, 60))
def test_a_new_voyage_is_inside_as_often_as_promised(ship, count):
    """Test: 120 calibrations of so many voyages, a new voyage each. Expected: 90 % inside at least, and no more
    than what the few voyages cost: (V + 1)/V."""
    rng = np.random.default_rng(1)
    found = []
    for _ in range(120 if count < 20 else 30):
        calibrated, _ = made(ship, [sailed(rng, 30) for _ in range(count)])
        found += [shares(ship, calibrated, sailed(rng, 30)) for _ in range(4)]
    for share in np.mean(found, axis=0):
        assert share > 0.9 - 3.0 * 0.12 / len(found) ** 0.5
    if count == 60:
        assert np.mean(found) < 0.95


def test_the_regression_finds_what_the_error_depends_on_and_the_tube_is_narrower_for_it(ship):
    """Test: 60 voyages, errors that grow by exp(0.4 H_s), twice as large across. Expected: the coefficient of
    the waves within a third, the others small; half widths in calm water under half of those in 3 m."""
    rng = np.random.default_rng(2)
    voyages = [sailed(rng, steady=0.1) for _ in range(60)]
    along, across, heading = coefficients([v[H] for v in voyages], usual_error(ship, H))
    per_phi = 0.4 * 3.2  # H_s/(L/100) is 3.2 m here
    for c in (along, across, heading):
        assert c[4] == pytest.approx(per_phi, rel=0.34) and abs(c[1]) < 0.1
    assert across[0] - along[0] == pytest.approx(np.log(2.0), abs=0.15)
    calibrated, _ = made(ship, voyages)
    calm, rough = (
        half_widths(calibrated, H, sailed(rng, 1, H_s)[H][0], usual_error(ship, H))[0] for H_s in (0.2, 2.9)
    )
    assert calm < 0.5 * rough


def test_the_level_is_finite_from_nine_voyages_on_and_fewer_promise_what_they_can(ship):
    rng = np.random.default_rng(3)
    assert needed(0.9) == 9
    for count, promised in ((3, 0.75), (8, 8 / 9), (9, 0.9)):
        voyages = [sailed(rng, 10) for _ in range(count)]
        calibrated, _ = made(ship, voyages)
        cell = calibrated.horizons[H].cells["all"]
        assert calibrated.promise(cell) == pytest.approx(promised) and cell.voyages == count
        if count < 9:
            assert all(shares(ship, calibrated, v).min() == 1.0 for v in voyages)  # the greatest error of all


def test_the_regression_takes_a_third_and_never_so_many_that_the_level_is_lost():
    for count in range(1, 100):
        fit = sum(parted(count))
        assert fit == 0 or FEWEST_FIT <= fit <= count // 3
        assert count - fit >= min(needed(0.9), count)
    assert sum(parted(60)) == 12 and sum(parted(12)) == 0


def test_a_regime_has_a_tube_of_its_own_only_where_its_quantile_costs_no_more_than_two_per_cent(ship):
    """Test: 60 voyages in slight seas, 12 in rough ones. Expected: cells for both helms and the slight sea."""
    rng = np.random.default_rng(4)
    voyages = [sailed(rng, 12, 0.3) for _ in range(60)] + [sailed(rng, 12, 2.5) for _ in range(12)]
    calibrated, _ = made(ship, voyages)
    cells = calibrated.horizons[H].cells
    assert {"all", "still", "moving", "still_slight", "moving_slight"} == set(cells)
    row = rows(ship, calibrated, voyages)[0]
    assert row["level"] == 0.9 and {r["regime"] for r in row["regimes"]} == set(cells) - {"all"}


def test_voyages_that_show_nothing_are_refused_in_one_line(ship):
    with pytest.raises(DataError, match="helm and engine held") as error:
        section(ship, "", [{H: []}, {H: []}], "")
    assert "\n" not in str(error.value)


def voyage(name, day):
    return Voyage(name, np.arange(3.0), {}, {"start_time_utc": f"{day}T08:00:00Z"})


def test_what_the_voyages_cannot_promise_is_said_in_a_sentence_each(ship):
    """Test: five voyages of one sea, one week, one of them used for the fit, and a horizon that none shows."""
    rng = np.random.default_rng(5)
    _, table = made(ship, [sailed(rng, 10, 0.3) for _ in range(5)])
    voyages = [voyage(f"v{k}.mcap", f"2026-06-0{k + 1}") for k in range(5)]
    few, sea, season, left, fitted = doubts(table, voyages, [H, 120.0], 320.0, {"v2.mcap", "other.mcap"})
    assert "83 % at best" in few and "takes 9" in few
    assert "one sea (slight" in sea and "within 4 days" in season and "120 s" in left and "v2.mcap" in fitted
    assert not any("\n" in text for text in (few, sea, season, left, fitted))


def test_many_voyages_of_all_seas_and_seasons_leave_no_doubt(ship):
    rng = np.random.default_rng(6)
    _, table = made(ship, [sailed(rng, 10) for _ in range(30)])
    voyages = [voyage(f"v{k}.mcap", f"2026-{1 + k // 3:02d}-01") for k in range(30)]
    assert doubts(table, voyages, [H], 320.0, set()) == []
