"""Dates whose day and month may be exchanged: the proposed map says which it took, to be confirmed."""

import pytest

from tests.recording.test_proposed_maps import AMERICAN, stamps, write
from twin.recording.suggest_clock import text_format
from twin.recording.suggest_map import suggestion


@pytest.mark.parametrize(
    ("stamp", "form", "why"),
    [
        ("02/05/2026 07:01:03.2", "%d/%m/%Y %H:%M:%S.%f", "the day first? CONFIRM"),
        ("02-05-2026 07:01:03", "%d-%m-%Y %H:%M:%S", "the day first? CONFIRM"),
        ("02/05/26 07:01:03", "%m/%d/%y %H:%M:%S", "the month first? CONFIRM"),
        ("05/05/2026 07:01:03", "%d/%m/%Y %H:%M:%S", None),
        ("17/05/2026 07:01:03", "%d/%m/%Y %H:%M:%S", None),
        ("05/17/2026 07:01:03", "%m/%d/%Y %H:%M:%S", None),
        ("02.05.2026 07:01:03", "%d.%m.%Y %H:%M:%S", None),
        ("2026/05/02 07:01:03", "%Y/%m/%d %H:%M:%S", None),
    ],
)
def test_a_date_that_may_be_two_is_to_be_confirmed(stamp, form, why):
    found = text_format([stamp])
    assert found == {"format": form} | ({"why": why} if why else {})


def test_a_day_that_may_be_a_month_is_marked_in_the_proposal(tmp_path):
    rest = dict(list(AMERICAN.items())[1:])
    for name, form, asked in (("may", "%d/%m/%Y", False), ("june", "06/%m/%Y", True)):
        path = write(tmp_path / f"{name}.csv", {"Time": stamps(f"{form} %H:%M:%S"), **rest})
        assert ("first? CONFIRM" in suggestion([path], {})) == asked
