"""How many may speak: for each subject a few sources are heard and logged, whoever invents more names is told
apart.

Without a bound, a sender that takes a new name for every message fills the log's table of channels and the
memory."""

from collections.abc import Collection, Mapping

from twin.live.keelson.topics import address, topic_of
from twin.live.signals.channels import BY_NAME

MAX_SOURCES = 8  # sources heard for a subject, besides the one that the owner named; a ship has two or three
MAX_KEY = 512  # bytes of a key
# a source that is silent for so long, and for as long as its channel keeps, gives its seat up
SILENT_S = 60.0
NOTICE_S = 10.0  # how long it is still said


class Seats:
    """Keys that are heard; `sources` {channel: source} always are."""

    def __init__(self, sources: Mapping[str, str] | None = None):
        self._sources = dict(sources or {})
        self.actuators: Collection[str] = ()  # channels of the ship's own
        self._heard_s: dict[str, dict[str, float]] = {}  # subject: {key: when it was last heard}
        self._subject: dict[str, str] = {}  # key that has a seat: its subject
        self._said, self._until_s = "", 0.0
        self.refused = 0

    def taken(self, key: str, now_s: float) -> bool:
        """Whether this message is heard."""
        subject = self._subject.get(key)
        if subject is None:
            return self._sit(key, now_s)
        self._heard_s[subject][key] = now_s
        return True

    def alarm(self, now_s: float) -> str:
        """Who was not heard lately, in words."""
        return self._said if now_s < self._until_s else ""

    def _sit(self, key: str, now_s: float) -> bool:
        place = address(key) if len(key.encode()) <= MAX_KEY else None
        if place is None:
            return self._refuse("a name", f"a key of {len(key)} characters", now_s)
        topic = topic_of(place, self.actuators)
        if topic is None or any(self._sources.get(channel) == place.source for channel in topic.channels):
            return True
        # of one subject many actuators speak, each with sources of its own
        what = topic.channels[0] if "." in topic.channels[0] else place.subject
        seated = self._heard_s.setdefault(what, {})
        if len(seated) >= MAX_SOURCES:
            self._stand_up(seated, now_s - max(SILENT_S, *(BY_NAME[c].stale_s for c in topic.channels)))
        if len(seated) >= MAX_SOURCES:
            return self._refuse(what, f"{place.source[:40]!r}", now_s)
        seated[key] = now_s
        self._subject[key] = what
        return True

    def _stand_up(self, seated: dict[str, float], before_s: float) -> None:
        for key in [key for key, heard_s in seated.items() if heard_s < before_s]:
            del seated[key], self._subject[key]

    def _refuse(self, subject: str, who: str, now_s: float) -> bool:
        self.refused += 1
        self._until_s = now_s + NOTICE_S
        self._said = (
            f"{subject}: more than {MAX_SOURCES} sources speak for it, {who} is not heard. Name the right "
            "one under [sources], and keep other senders off the bus ([bus] file)"
        )
        return False
