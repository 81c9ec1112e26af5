"""The table of what kinematics say of the instruments of random ships."""

import pytest

from bench.fleet import kinematic_errors
from bench.fleet.plausibility import build

WAYS = tuple(kinematic_errors.WAYS)


def voyage(way, hidden=(), named=(), **numbers):
    """A row; `numbers`: error, sd and whether it was seen."""
    told = {n: {"error": e, "sd": s, "seen": seen, "true": 0.0} for n, (e, s, seen) in numbers.items()}
    return {
        "voyage": "v", "family": "mmg", "way": way, "hidden": list(hidden),
        "named": [[n] for n in named], "numbers": told,
    }  # fmt: skip


def test_a_number_that_is_seen_where_it_is_not_counts_and_one_whose_interval_holds_the_truth_does_not():
    healthy = [
        voyage(WAYS[0], log_scale=(0.03, 0.02, True)),
        voyage(WAYS[1], log_scale=(0.03, 0.01, True)),
        voyage(WAYS[1], log_scale=(0.03, 0.01, False)),
    ]
    line = kinematic_errors.tables(healthy)[2]
    assert "0 of 1" in line.split("|")[2] and "1 of 2" in line.split("|")[3]


def test_a_hidden_fault_is_right_when_it_is_named_and_others_of_the_ship_do_not_count():
    asked = [
        voyage(WAYS[0], ["SpeedLogScale", "HullFouling"], ["SpeedLogScale"]),
        voyage(WAYS[0], ["SensorDelay"], ["HeadingBias"]),
    ]
    assert "1 of 2" in kinematic_errors.tables(asked)[3].split("|")[2]


def test_by_how_much_a_number_varies_is_asked_of_healthy_voyages_alone():
    """Expected: errors of 2 and 0 standard deviations: 1.41 times as much as believed; that of a fault aside."""
    rows = [voyage(WAYS[0], A=(2.0, 1.0, False)), voyage(WAYS[0], A=(0.0, 1.0, False))]
    rows += [voyage(WAYS[0], ["HeadingBias"], A=(50.0, 1.0, True)), voyage(WAYS[1], A=(0.0, 1.0, False))]
    line = next(line for line in kinematic_errors.tables(rows) if line.startswith("| A |"))
    assert "| 1.41 (" in line and "1 of 2" in line


def test_ages_count_from_the_instrument_that_is_taken_for_prompt():
    ship = build("mmg", 2)
    true = kinematic_errors.truth(ship, "log_delay")
    assert true["log_delay"] == 0.0 and true["heading_delay"] == pytest.approx(-ship.kit.log_late)
