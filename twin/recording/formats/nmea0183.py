"""NMEA 0183 as it is recorded: sentences with or without a stamp, a TAG block or a multiplexer's words in
front.

A stamp in front of a sentence is when it was received, and is used. Without one the clock is the log's own:
RMC, ZDA, GGA or GLL, the best that is there; the k-th of n sentences of one kind between two readings of that
clock stands at k/n between them.
"""

import re
from collections.abc import Callable
from pathlib import Path

from twin.recording.formats.lines import numbered
from twin.recording.formats.nmea_sentences import CLOCKS, SENTENCES, Part
from twin.recording.formats.recorder_stamps import DAY_S, Stamp, days_from_civil
from twin.recording.formats.signals import Signals

SAYS = "an NMEA 0183 log"
SENTENCE = re.compile(r"[$!]([A-Z]{2}[A-Z]{3}|P[A-Z]{3,}),[^$!]*")
TAG_TIME = re.compile(r"c:(\d{9,19})")
LONGEST = 200  # characters of a sentence; the standard's is 82
SLOWEST_S = 5.0  # readings of the log's own clock farther apart leave a hole: nothing is spread over it


def looks(lines: list[str], start: bytes) -> bool:
    """Whether the first lines hold sentences."""
    found = sum(bool(SENTENCE.search(s)) for s in lines[:60])
    return found >= 1 and found >= 0.4 * min(len(lines), 60)


def read(path: Path) -> Signals:
    """The series of a log: named talker and sentence, then part (`HEHDT.heading`)."""
    log = Nmea(Signals(path, SAYS))
    for number, line in numbered(path):
        log.line(number, line)
    return log.done()


def checksum(body: bytes) -> int:
    """Exclusive or of all bytes, folded in halves."""
    size, x = 64 if len(body) <= 64 else 256, int.from_bytes(body, "little")
    while size > 1:
        size //= 2
        x = (x >> (8 * size)) ^ (x & ((1 << (8 * size)) - 1))
    return x


WANTED = frozenset(kind.encode() for kind in (*SENTENCES, *CLOCKS))


class Nmea:
    """A log being read: what stands between two readings of its clock waits for the second."""

    def __init__(self, out: Signals):
        self.out = out
        self._series: dict[tuple[str, str], tuple[Callable[[float], None], Callable[[float], None]]] = {}
        self._stamp, self._received = Stamp(), False
        self._clock = (99, "")  # rank and address of the sentence that sets the clock
        self._day: int | None = None
        self._dated = False
        self._of_day = Stamp()
        self._now: float | None = None
        self._waiting: list[tuple[str, int, list[Part]]] = []
        self._count: dict[str, int] = {}

    def line(self, number: int, line: bytes) -> None:
        """Read one line: find its sentence, hold it against its checksum, take its stamp; what is wrong is
        counted."""
        at = line.rfind(b"$")
        if at < 0:
            at = line.rfind(b"!")
            if at >= 0:
                kind = (
                    "AIS sentences"
                    if line[at + 1 : at + 3] in (b"AI", b"AB", b"BS")
                    else "encapsulated sentences"
                )
                self.out.skipped[kind] += 1
            elif line.strip():
                self.out.skipped["lines without a sentence"] += 1
            return
        if line[at + 6 : at + 7] != b"," or line[at + 3 : at + 6] not in WANTED:
            self.out.skipped["sentences of other kinds"] += 1
            return
        body = line[at + 1 : at + LONGEST]
        star = body.find(b"*")
        if star >= 0:
            body, given = body[:star], body[star + 1 : star + 3]
            try:
                good = int(given, 16) == checksum(body)
            except ValueError:
                good = False
            if not good:
                self.out.skipped["sentences with a wrong checksum"] += 1
                return
        elif body[-1:] in b"\r\n\\ ":
            body = body.rstrip(b"\r\n\\ ")
        fields = body.decode("latin-1").split(",")
        self.sentence(number, fields, line[:at] if at else b"")

    def sentence(self, number: int, fields: list[str], front: bytes) -> None:
        """Read one whole sentence: set the clock by it, and hold its values until the clock has a time for
        them."""
        address = fields[0]
        kind = address[-3:]
        if kind in CLOCKS and not self._received:
            self.set_clock(number, address, kind, fields)
        known = SENTENCES.get(kind)
        if known is None:
            return  # it only set the clock
        try:
            parts = list(known[1](fields))
        except ValueError:
            self.out.skipped["sentences that hold no numbers where numbers belong"] += 1
            return
        received = self.when(number, front) if front else None
        if received is not None:
            self.keep(address, parts, received)
        elif not self._received:
            self.wait(address, parts)

    def sentence_at(self, text: str, time_s: float) -> None:
        """One sentence that something else stamped."""
        self._received = True
        at = text.find("$")
        fields = text[at + 1 :].partition("*")[0].strip().split(",")
        known = SENTENCES.get(fields[0][-3:]) if at >= 0 and len(fields[0]) == 5 else None
        try:
            self.keep(fields[0], list(known[1](fields)) if known else [], time_s)
        except ValueError:
            self.out.skipped["sentences that hold no numbers where numbers belong"] += 1

    def when(self, number: int, front: bytes) -> float | None:
        """The stamp in front of a sentence; from the first one on, the log's own clock is not asked."""
        text = front.decode("latin-1")
        tag = TAG_TIME.search(text)
        t = self._stamp(tag.group(1) if tag else text)
        if t is None:
            return None
        if not self._received:
            self._received, self._waiting = True, []
        self.out.clock(t, number)
        return t

    def set_clock(self, number: int, address: str, kind: str, fields: list[str]) -> None:
        """Takes the time of a sentence when it is of the best kind so far."""
        rank = CLOCKS[kind]
        if (rank, address) != self._clock and rank >= self._clock[0]:
            return
        t = self.read_clock(kind, fields)
        if t is None:
            return
        if self._now is not None and self._dated and self._now < 1e8 < t:  # the date came later than the time
            self.shift(t - self._of_day.past_midnight(t % DAY_S))
        self._clock = (rank, address)
        if self._now is None or t != self._now:
            self.out.clock(t, number)
            self.spread(t)
            self._now = t

    def shift(self, by: float) -> None:
        """Puts what was read before the first date on the dated clock."""
        for s in self.out.series.values():
            for i, t in enumerate(s.times):
                s.times[i] = t + by
        self._now = (self._now or 0.0) + by

    def read_clock(self, kind: str, f: list[str]) -> float | None:
        """The time that a sentence tells [s since 1970]; None while no sentence has told the date."""
        text = f[{"RMC": 1, "ZDA": 1, "GGA": 1, "GNS": 1, "GLL": 5}[kind]] if len(f) > 5 else ""
        try:
            seconds = int(text[:2]) * 3600.0 + int(text[2:4]) * 60.0 + float(text[4:])
            date = self.date(kind, f)
        except ValueError:
            return None
        if date is not None:
            self._day, self._dated = date, True
        if self._day is None:
            return self._of_day.past_midnight(seconds)
        t = self._day * DAY_S + seconds
        if date is None and self._now is not None and t < self._now - DAY_S / 2:
            self._day += 1
            t += DAY_S
        return t

    def date(self, kind: str, f: list[str]) -> int | None:
        """Days since 1970 of the date in RMC and ZDA; None in other sentences, or where it is empty."""
        if kind == "RMC" and len(f) > 9 and len(f[9]) == 6:
            year = int(f[9][4:])
            return days_from_civil(year + (1900 if year >= 80 else 2000), int(f[9][2:4]), int(f[9][:2]))
        if kind == "ZDA" and len(f) > 4 and f[2] and f[3] and f[4]:
            return days_from_civil(int(f[4]), int(f[3]), int(f[2]))
        return None

    def wait(self, address: str, parts: list[Part]) -> None:
        """Hold values back until the clock tells when they were said."""
        if parts:
            kind = address + parts[0][0]
            k = self._count.get(kind, 0)
            self._count[kind] = k + 1
            self._waiting.append((address, k, parts))

    def spread(self, until: float | None) -> None:
        """Gives what waited its stamps, between the reading before and this one."""
        start = self._now
        if start is None:
            if self._waiting:
                self.out.skipped["sentences before the first time"] += len(self._waiting)
        else:
            length = until - start if until is not None else 1.0
            length = length if 0.0 < length <= SLOWEST_S else 1.0
            for address, k, parts in self._waiting:
                self.keep(address, parts, start + length * k / self._count[address + parts[0][0]])
        self._waiting, self._count = [], {}

    def keep(self, address: str, parts: list[Part], time_s: float) -> None:
        """Add a sentence's values, said at `time_s`, to their series."""
        for part, quantity, value in parts:
            pair = self._series.get((address, part))
            if pair is None:
                rank = SENTENCES[address[-3:]][0] + ("port" in part or part[-1:] in "23456789")
                new = self.out.of(f"{address}.{part}", address[:2], quantity, rank)
                pair = self._series[address, part] = (new.times.append, new.values.append)
            pair[0](time_s)
            pair[1](value)

    def done(self) -> Signals:
        """All series, with what still waited for a time (`spread`)."""
        self.spread(None)
        if self._now is None and not self._received:
            self.out.skipped["and no sentence tells the time (RMC, ZDA, GGA, GLL, or a stamp in front)"] = 1
        return self.out.finish()
