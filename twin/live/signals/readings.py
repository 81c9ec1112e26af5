"""What came in from one sensor: a number that may be used, or the reason why it may not.

The gates without memory (decoding, range, sentinels) and the gates with memory (jump, frozen, stale ...)
speak with the same codes, so a channel's quality reads the same in the log, on the bus and in the report.
"""

from enum import IntEnum
from typing import NamedTuple

from twin.live.signals.geodesy import MAX_DISTANCE_M, MAX_LATITUDE_DEG


class Quality(IntEnum):
    """One code for each answer to "may this sample be used?"; the number is what the log holds."""

    OK = 0
    NEVER_SEEN = 1
    STALE = 2
    DUPLICATE = 3
    OUT_OF_ORDER = 4
    OLD = 5
    FUTURE = 6
    NO_TIMESTAMP = 7
    NOT_FINITE = 8
    OUT_OF_RANGE = 9
    SENTINEL = 10
    JUMP = 11
    FROZEN = 12
    WRONG_TYPE = 13
    GARBAGE = 14
    CONFLICT = 15
    UNKNOWN_KEY = 16
    OUTSIDE_AREA = 17
    NOT_GIVEN = 18
    UNCONFIRMED = 19


WORDS: dict[Quality, str] = {
    Quality.OK: "good",
    Quality.NEVER_SEEN: "nobody has published it yet",
    Quality.STALE: "the last good sample is too old",
    Quality.DUPLICATE: "the same stamp came before",
    Quality.OUT_OF_ORDER: "stamped earlier than the sample before it",
    Quality.OLD: "stamped long before it arrived",
    Quality.FUTURE: "stamped later than now",
    Quality.NO_TIMESTAMP: "without a time stamp (or stamped 1970)",
    Quality.NOT_FINITE: "not a finite number",
    Quality.OUT_OF_RANGE: "outside what a ship can measure",
    Quality.SENTINEL: "the sender's word for 'not available'",
    Quality.JUMP: "changed faster than a ship can",
    Quality.FROZEN: "stays the same while the ship moves",
    Quality.WRONG_TYPE: "another message type than its key says",
    Quality.GARBAGE: "cannot be decoded",
    Quality.CONFLICT: "two sources publish it",
    Quality.UNKNOWN_KEY: "a key the table of topics does not have",
    Quality.OUTSIDE_AREA: f"more than {MAX_DISTANCE_M / 1e3:.0f} km from the ship's last place (believed "
    f"after an hour without a nearer one), or beyond {MAX_LATITUDE_DEG} deg of latitude",
    Quality.NOT_GIVEN: "this voyage does not have it",
    Quality.UNCONFIRMED: "the first of its kind; a second must agree with it",
}


class Reading(NamedTuple):
    """One sample that passed decoding: `value` in the channel's border unit, finite and in range.

    `time_s` is the source's own stamp (UTC, seconds since 1970), `received_s` the monotonic time of arrival
    [s].
    """

    channel: str
    value: float
    time_s: float
    received_s: float
    source: str


class Rejected(NamedTuple):
    """One sample that may not be used: which channel ("" when not known), which code, and why in words."""

    channel: str
    quality: Quality
    why: str
    received_s: float
    source: str
