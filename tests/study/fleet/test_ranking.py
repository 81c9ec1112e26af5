"""One ship over its voyages, and the ships in their order."""

import numpy as np
import pytest

from tests.study.fleet.rows import named, of, plainly, size
from twin.study.fleet.fleet_lines import terminal_lines
from twin.study.fleet.ranking import ranked
from twin.study.fleet.trend import causes_of, trend, voyages_of


def sailed(*rows):
    return voyages_of([(f"{r[0]['voyage']}.mcap" if r else "none.mcap", {}, r) for r in rows])


def test_voyages_stand_in_the_order_in_which_they_were_sailed():
    june, march = plainly("june", "2026-06-01T00:00:00+00:00"), plainly("march", "2026-03-01T00:00:00+00:00")
    assert [v["voyage"] for v in sailed(june, march)] == ["march", "june"]
    assert [v["voyage"] for v in sailed(june, plainly("x", None))] == ["june", "x"], "a date is not known"


def test_a_cause_is_there_since_the_first_voyage_after_the_last_healthy_one():
    """Test: fouled, cleaned, fouled, undecided, fouled. Expected: since the second time."""
    rows = [
        named("a", "2026-01-01"),
        plainly("b", "2026-02-01"),
        named("c", "2026-03-01"),
        plainly("d", "2026-04-01", "undecided"),
        named("e", "2026-05-01"),
    ]
    (cause,) = causes_of(sailed(*rows))
    assert cause["since"]["voyage"] == "c"
    assert (cause["named_on"], cause["of_voyages"], len(cause["sizes"])) == (3, 5, 3)


def test_a_size_that_grows_by_a_twentieth_a_month_is_a_trend_with_that_slope():
    days = [f"2026-{month:02d}-01T00:00:00+00:00" for month in range(1, 8)]
    sizes = [{"start_time_utc": d, **size(0.1 + 0.05 * i)} for i, d in enumerate(days)]
    found = trend(sizes, range(7))
    assert found["per"] == "month" and found["slope"] == pytest.approx(0.05, rel=0.03)
    assert found["low95"] < 0.05 < found["high95"]
    assert trend(sizes[:2], range(2)) is None


def test_a_trend_without_dates_counts_the_voyages_on_which_the_cause_was_not_weighed_too():
    sizes = [{"start_time_utc": None, **size(value)} for value in (0.0, 0.1, 0.9)]
    found = trend(sizes, [0, 1, 9])
    assert found["per"] == "voyage" and found["slope"] == pytest.approx(0.1)


def test_the_interval_of_a_trend_covers_as_often_as_it_says_although_sizes_scatter_more_than_theirs():
    rng, days = np.random.default_rng(2), [f"2026-{m:02d}-01T00:00:00+00:00" for m in range(1, 9)]
    inside = 0
    for _ in range(300):
        values = 0.1 + rng.normal(0.0, 0.1, len(days))  # intervals say 0.05
        found = trend(
            [{"start_time_utc": d, **size(v)} for d, v in zip(days, values, strict=True)], range(len(days))
        )
        inside += found["low95"] <= 0.0 <= found["high95"]
    assert 0.92 <= inside / 300 <= 0.99


def test_ships_stand_by_what_is_wrong():
    """Expected: causes by their share of the error, weather alone, unknown, undecided, nothing, not judged."""
    day = "2026-01-01T00:00:00+00:00"
    fleet = [
        of("calm", plainly("a", day)),
        of("lost", [{"failed": "gone", "effect": None}]),
        of("small", named("a", day, with_it=8.0)),
        of("odd", plainly("a", day, "unknown")),
        of("open", plainly("a", day, "undecided")),
        of("stream", named("a", day, effect="Current", belongs_to="voyage", with_it=1.0)),
        of("large", named("a", day, with_it=2.0)),
    ]
    result = ranked(fleet)
    order = [s["ship"] for s in result["ships"]]
    assert order == ["large", "small", "stream", "odd", "open", "calm", "lost"]
    assert [s["rank"] for s in result["ships"]] == [1, 2, 3, 4, 5, 6, 7]
    assert result["voyages"] == {"listed": 7, "judged": 6, "references": 0, "failed": 1}
    lines = "\n".join(terminal_lines(result))
    assert "80 %" in lines and "size 0.30 (0.20 to 0.40)" in lines and "lost: gone" in lines


def test_a_voyage_that_the_ship_was_calibrated_on_is_not_judged():
    fleet = [of("calm", plainly("ref", "2026-01-01", "reference"))]
    (ship,) = ranked(fleet)["ships"]
    assert ship["state"] == "not_asked" and ranked(fleet)["voyages"]["references"] == 1


def test_what_the_references_can_never_show_is_told():
    """Test: two ships whose files have the scores of three and of twelve references; one that has none."""
    few = of("few", plainly("a", None, score=9.0), scores=[0.1] * 3)
    result = ranked([few, of("many", plainly("a", None, score=9.0), scores=[0.1] * 12)])
    lines = "\n".join(terminal_lines(result))
    assert result["over_months"] == {"level": 0.05, "ships": 2, "needed": 40.0, "alarms": []}
    assert "few: by 3 reference voyages a fault that stays as it is typically shows M = 4.7," in lines
    assert "7 references would do" in lines and "many:" not in lines
    assert "not controlled" in "\n".join(terminal_lines(ranked([of("old", plainly("a", None, score=9.0))])))


def test_a_lasting_fault_of_a_ship_with_many_references_is_an_alarm():
    """Expected: scores far above twelve references, beside a ship in health."""
    days = [f"2026-0{m}-01T00:00:00+00:00" for m in range(1, 7)]
    worse = [9.0, 9.3, 9.1, 9.5, 9.2, 9.6]
    healthy = [0.1 * i for i in range(12)]
    bad = of("bad", *(named("v", d, score=s) for d, s in zip(days, worse, strict=True)), scores=healthy)
    good = of("good", *(plainly("v", d, score=0.15 * (i + 1)) for i, d in enumerate(days)), scores=healthy)
    result = ranked([good, bad])
    assert result["over_months"]["alarms"] == ["bad"] and result["ships"][0]["over_months"]["alarm"]
    assert any("ALARM, M" in line for line in terminal_lines(result))


def test_a_cause_that_takes_nothing_of_the_error_away_takes_no_less_than_nothing():
    """Test: with the cause the error is 10.02 m in place of 10 m. Expected: 0 % of it, and not -0 %."""
    result = ranked([of("a", named("a", "2026-01-01T00:00:00+00:00", with_it=10.02))])
    assert result["ships"][0]["causes"][0]["share_of_error"] < 0.0
    lines = "\n".join(terminal_lines(result))
    assert " 0 %" in lines and "-0 %" not in lines
