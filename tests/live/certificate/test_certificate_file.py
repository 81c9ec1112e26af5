"""The certificate's own file, damaged on purpose and by chance: what is none is one of three errors."""

import json

import pytest

from twin.live.certificate.certificate import Certificate, certify, digest
from twin.physics.model import Model


@pytest.fixture(scope="module")
def true(kvlcc2):
    """The table of a true file, without its checksum."""
    table = json.loads(certify(Model.of(kvlcc2), 0.3, 0.1).to_json())
    table.pop("sha256")
    return table


def text_of(table):
    """The file of a table, its checksum made to fit."""
    told = {name: value for name, value in table.items() if name != "version"}
    return json.dumps({"version": table["version"], "sha256": digest(told), **told})


def test_the_true_file_is_read(true):
    assert Certificate.from_json(text_of(true)).ok


@pytest.mark.parametrize("text", ["[" * 100_000, "{}", "7", '{"version": 7, "sha256": ""}', ""])
def test_text_that_is_no_certificate_is_one_of_three_errors(text):
    with pytest.raises((ValueError, KeyError, TypeError)):
        Certificate.from_json(text)


@pytest.mark.parametrize("value", [10**400, 1e200, [], "x", None, 0, -1.0, float("nan"), float("inf"), {}])
@pytest.mark.parametrize("place", ["inertia", "lo", "h", "K", "calm", "operating"])
def test_a_number_that_is_none_is_refused_though_its_checksum_fits(true, place, value):
    """Test: one entry of a true file replaced, its checksum made anew. Expected: no other error than the
    three that a start expects, and no certificate."""
    table = json.loads(json.dumps(true))
    holder = next(x for x in (table, table["plant"], table["disturbance"]) if place in x)
    if isinstance(holder[place], list) and isinstance(holder[place][0], list):
        holder[place][0][0] = value
    elif isinstance(holder[place], list):
        holder[place][0] = value
    else:
        holder[place] = value
    with pytest.raises((ValueError, KeyError, TypeError)):
        Certificate.from_json(text_of(table))


@pytest.mark.parametrize("axis", ["u", "v", "r", "wind_speed"])
@pytest.mark.parametrize(
    "value", [0, "x", [], [1.0], [2.0, 1.0], [float("nan"), 1.0], [0.0, float("inf")], None]
)
def test_a_range_of_the_operating_set_that_is_none_is_refused(true, axis, value):
    """Expected: the same; what is not looked at by the theorem would end the service at its first tick (found
    by the fuzzer)."""
    table = json.loads(json.dumps(true))
    table["plant"]["operating"]["ranges"][axis] = value
    with pytest.raises((ValueError, KeyError, TypeError)):
        Certificate.from_json(text_of(table))


@pytest.mark.parametrize("place", [("disturbance", "motion"), ("disturbance", "per_metre"), ("saturation",)])
@pytest.mark.parametrize("value", ["x", None, [], -1e-6, float("nan"), float("inf")])
def test_what_only_a_sea_or_a_learned_force_asks_for_is_looked_at_too(true, place, value):
    """Expected: the same of a bound that no theorem in calm water meets; a negative one would promise less
    than is there."""
    table = json.loads(json.dumps(true))
    holder = table
    for name in place:
        holder = holder[name]
    holder[1] = value
    with pytest.raises((ValueError, KeyError, TypeError)):
        Certificate.from_json(text_of(table))
    del holder[1]
    with pytest.raises((ValueError, KeyError, TypeError)):
        Certificate.from_json(text_of(table))


def test_an_operating_set_without_a_motion_is_refused(true):
    table = json.loads(json.dumps(true))
    del table["plant"]["operating"]["ranges"]["v"]
    with pytest.raises((ValueError, KeyError, TypeError)):
        Certificate.from_json(text_of(table))
