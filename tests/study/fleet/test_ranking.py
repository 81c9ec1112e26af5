"""One ship over its voyages, and the ships in their order."""

from pathlib import Path

import numpy as np
import pytest

import twin
from twin.commands.story import SHIP
from twin.study.fleet.history import causes_of, trend, voyages_of
from twin.study.fleet.listing import FleetShip, FleetVoyage
from twin.study.fleet.ranking import ranked
from twin.study.fleet.told import told

SHARED = {
    "failed": None, "reason": "", "sentence": "", "duration_s": 600.0, "p_value": None, "p_value_at_best": None,
    "references": 0, "score": None, "horizon_s": 120.0, "position_mae_m": 9.0, "position_expected_m": 5.0,
    "data_checks": [], "lasting": True, "probability": 0.9, "confidence": None, "says": "", "X_N": 0.0,
    "Y_N": 0.0, "N_Nm": 0.0, "cannot_be_told_from": [], "belongs_to": "ship",
}  # fmt: skip


def size(value, half=0.1):
    return {"name": "size", "value": value, "low95": value - half, "high95": value + half, "unit": "-",
            "at_box_end": False, "in_ship_file": None}  # fmt: skip


def named(voyage, day, value=0.3, effect="HullFouling", with_it=4.0, **other):
    return [
        SHARED
        | {"voyage": voyage, "start_time_utc": day, "verdict": "missing", "effect": effect, "named": True}
        | {"parameters": [size(value)], "error_without_m": 10.0, "error_with_m": with_it}
        | other
    ]


def plainly(voyage, day, verdict="nothing_missing", **other):
    return [SHARED | {"voyage": voyage, "start_time_utc": day, "verdict": verdict, "effect": None} | other]


def sailed(*rows):
    return voyages_of([(f"{r[0]['voyage']}.mcap" if r else "none.mcap", {}, r) for r in rows])


@pytest.fixture(scope="module")
def of():
    """A ship of the fleet with these rows, one list a voyage."""
    known = twin.Ship.load(SHIP)

    def made(name, *rows):
        voyages = tuple(FleetVoyage(Path(f"{name}-{i}.mcap")) for i in range(len(rows)))
        return FleetShip(name, Path(f"{name}.toml"), name, known, voyages), list(rows)

    return made


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
    found = trend(sizes)
    assert found["per"] == "month" and found["slope"] == pytest.approx(0.05, rel=0.03)
    assert found["low95"] < 0.05 < found["high95"]
    assert trend(sizes[:2]) is None
    assert trend([s | {"start_time_utc": None} for s in sizes])["per"] == "voyage"


def test_the_interval_of_a_trend_covers_as_often_as_it_says_although_sizes_scatter_more_than_theirs():
    rng, days = np.random.default_rng(2), [f"2026-{m:02d}-01T00:00:00+00:00" for m in range(1, 9)]
    inside = 0
    for _ in range(300):
        values = 0.1 + rng.normal(0.0, 0.1, len(days))  # intervals say 0.05
        found = trend([{"start_time_utc": d, **size(v)} for d, v in zip(days, values, strict=True)])
        inside += found["low95"] <= 0.0 <= found["high95"]
    assert 0.92 <= inside / 300 <= 0.99


def test_ships_stand_by_what_is_wrong(of):
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
    lines = "\n".join(told(result))
    assert "80 %" in lines and "size 0.3 (0.2 to 0.4)" in lines and "lost: gone" in lines


def test_a_voyage_that_the_ship_was_calibrated_on_is_not_judged(of):
    fleet = [of("calm", plainly("ref", "2026-01-01", "reference"))]
    (ship,) = ranked(fleet)["ships"]
    assert ship["state"] == "not_asked" and ranked(fleet)["voyages"]["references"] == 1


def test_what_the_references_can_never_show_is_told(of):
    """Test: two ships whose files have the scores of three and of twelve references."""
    (few, rows), (many, _) = (
        of("few", plainly("a", None, score=9.0)),
        of("many", plainly("a", None, score=9.0)),
    )

    def scored(ship, count):
        notes = {"structural": {**ship.ship.notes["structural"], "left_out_scores": [0.1] * count}}
        return FleetShip(
            ship.name,
            ship.file,
            ship.sha256,
            type(ship.ship)(**{**vars(ship.ship), "notes": notes}),
            ship.voyages,
        )

    result = ranked([(scored(few, 3), rows), (scored(many, 12), rows)])
    lines = "\n".join(told(result))
    assert result["over_months"] == {"level": 0.05, "ships": 2, "needed": 40.0, "alarms": []}
    assert "few: by 3 reference voyages a lasting fault typically shows M = 4.7," in lines
    assert "many:" not in lines
    assert "not controlled" in "\n".join(told(ranked([(few, rows)])))
