"""NMEA 2000 as it is recorded: candump, canboat's text, Actisense's text and bytes, Yacht Devices' text,
sentences of NMEA 0183 around it.

Every form is one function from a line to (stamp, group, source, bytes, whether those are a whole message). A
series is named group, source, part (`127250.52.heading_true`); two sources of a group stay apart.
"""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from twin.recording.formats.lines import head, head_lines, numbered, opened
from twin.recording.formats.nmea2000_pgns import AIS, FAST, GROUPS, FastPackets
from twin.recording.formats.nmea2000_wrapped import wrapped
from twin.recording.formats.recorder_stamps import Stamp
from twin.recording.formats.signals import Signals


class Frame(NamedTuple):
    """One message on the bus; `time_s` None: the line has no stamp that can be read."""

    time_s: float | None
    pgn: int
    source: int
    data: bytes
    whole: bool


CANDUMP = re.compile(
    r"^\s*(?:\((\S+(?: "
    r"\S+)?)\)\s+)?(\w+)\s+([0-9A-Fa-f]{8})(?:#([0-9A-Fa-f]*)|\s+\[\d+\]\s+((?:[0-9A-Fa-f]{2} ?)*))"
)
CANDUMP_OLD = re.compile(r"^\s*<0x([0-9A-Fa-f]{8})>\s+\[\d+\]\s+((?:[0-9A-Fa-f]{2} ?)*)")
CANBOAT = re.compile(
    r"^(\d{4}-\d\d-\d\d[T-]\d\d:\d\d:\d\d[^,]*),(\d+),(\d+),(\d+),(\d+),(\d+),((?:[0-9A-Fa-f]{2},?)+)"
)
YDWG = re.compile(r"^(\S+(?: \S+)?) [RT] ([0-9A-Fa-f]{8}) ((?:[0-9A-Fa-f]{2} ?)*)")
ACTISENSE = re.compile(r"^A(\d{6}(?:\.\d+)?) ([0-9A-Fa-f]{5}) ([0-9A-Fa-f]{5}) ([0-9A-Fa-f]+)")


def of_can_id(can_id: int) -> tuple[int, int]:
    """(group, source) of a 29-bit identifier: a group below 240 is addressed, and its low byte is whom to."""
    pgn = (can_id >> 8) & 0x3FFFF
    return (pgn & 0x3FF00 if (pgn >> 8) & 0xFF < 240 else pgn), can_id & 0xFF


def candump(line: str, stamp: Stamp) -> Frame | None:
    """A frame of candump's text, with a time in brackets or (an old form) without; None: it is none."""
    found = CANDUMP.match(line)
    if not found:
        old = CANDUMP_OLD.match(line)
        return (
            Frame(None, *of_can_id(int(old.group(1), 16)), bytes.fromhex(old.group(2)), False)
            if old
            else None
        )
    at, _, can_id, packed, spaced = found.groups()
    return Frame(stamp(at) if at else None, *of_can_id(int(can_id, 16)), _bytes(packed or spaced), False)


def canboat(line: str, stamp: Stamp) -> Frame | None:
    """A message of canboat's text, put together; None: it is none."""
    found = CANBOAT.match(line)
    if not found:
        return None
    at, _, pgn, source, _, length, data = found.groups()
    return Frame(stamp(at), int(pgn), int(source), bytes.fromhex(data.replace(",", "")), int(length) > 8)


def ydwg(line: str, stamp: Stamp) -> Frame | None:
    """A frame of Yacht Devices' text; None: it is none."""
    found = YDWG.match(line)
    return Frame(stamp(found[1]), *of_can_id(int(found[2], 16)), _bytes(found[3]), False) if found else None


def actisense(line: str, stamp: Stamp) -> Frame | None:
    """A message of Actisense's text, put together; None: it is none."""
    found = ACTISENSE.match(line)
    if not found:
        return None
    t = found[1]
    return Frame(
        stamp(f"{t[:2]}:{t[2:4]}:{t[4:]}"), int(found[3], 16), int(found[2][:2], 16), _bytes(found[4]), True
    )


def in_sentence(line: str, stamp: Stamp) -> Frame | None:
    """A message inside a sentence of NMEA 0183; None: it is none."""
    found = wrapped(line, stamp)
    return Frame(*found) if found else None


def _bytes(text: str | None) -> bytes:
    text = (text or "").replace(" ", "")
    return bytes.fromhex(text[: len(text) // 2 * 2])


FORMS: tuple[tuple[str, Callable[[str, Stamp], Frame | None]], ...] = (
    ("an NMEA 2000 candump", candump),
    ("an NMEA 2000 log as canboat writes it", canboat),
    ("an NMEA 2000 log of a Yacht Devices gateway", ydwg),
    ("an NMEA 2000 log of Actisense", actisense),
    ("an NMEA 2000 log in sentences of NMEA 0183", in_sentence),
)
NGT_SAYS = "an NMEA 2000 recording of an Actisense NGT (bytes)"


def form_of(lines: list[str]) -> tuple[str, Callable[[str, Stamp], Frame | None]] | None:
    """The form most of the first lines have."""
    rows = [s for s in lines[:60] if not s.startswith("#")]
    for says, form in FORMS:
        if rows and sum(form(s, Stamp()) is not None for s in rows) > 0.6 * len(rows):
            return says, form
    return None


def looks(lines: list[str], start: bytes) -> bool:
    """Whether the head is one of the texts or Actisense's bytes."""
    return form_of(lines) is not None or looks_bytes(start)


def looks_bytes(start: bytes) -> bool:
    """Whether there are several framed messages of an NGT among the first bytes."""
    return start[:4096].count(b"\x10\x02\x93") >= 3 and start[:4096].count(b"\x10\x03") >= 3


def read(path: Path) -> Signals:
    """All messages of a log, in whichever of the forms it is."""
    start = head(path)
    form = form_of(head_lines(start))
    if form is None:
        return collect(Signals(path, NGT_SAYS), enumerate(ngt_messages(path), 1))
    out = Signals(path, form[0])
    return collect(out, frames(path, out, form[1]))


def frames(
    path: Path, out: Signals, form: Callable[[str, Stamp], Frame | None]
) -> Iterator[tuple[int, Frame]]:
    """(number of the line, frame) of each line that is one; the others are counted."""
    stamp = Stamp()
    for number, line in numbered(path):
        text = line.decode("latin-1").strip()
        if not text or text.startswith("#"):
            continue
        found = form(text, stamp)
        if found is None:
            out.skipped["lines of another form"] += 1
        else:
            yield number, found


def ngt_messages(path: Path) -> Iterator[Frame]:
    """DLE STX 93 length, priority, group, destination, source, time [ms], length, data, sum, DLE ETX."""
    rest = b""
    with opened(path) as stream:
        while piece := stream.read(1 << 20):
            *parts, rest = (rest + piece).split(b"\x10\x03")
            yield from (found for part in parts if (found := _ngt(part)))
            rest = rest[-4096:]


def _ngt(part: bytes) -> Frame | None:
    at = part.rfind(b"\x10\x02")
    d = part[at + 2 :].replace(b"\x10\x10", b"\x10")
    if at < 0 or len(d) < 14 or d[0] != 0x93 or sum(d) & 0xFF or len(d) < 13 + d[12] + 1:
        return None
    pgn = int.from_bytes(d[3:6], "little")
    return Frame(int.from_bytes(d[8:12], "little") * 1e-3, pgn, d[7], d[13 : 13 + d[12]], True)


def collect(out: Signals, messages: Iterator[tuple[int, Frame]]) -> Signals:
    """Series by group and source; frames of long messages are put together first."""
    packets = FastPackets()
    for number, frame in messages:
        known = GROUPS.get(frame.pgn)
        if known is None:
            out.skipped["AIS messages" if frame.pgn in AIS else "messages of other groups"] += 1
            continue
        data: bytes | None = frame.data
        if frame.pgn in FAST and not (frame.whole or len(frame.data) > 8):
            data = packets.add(frame.pgn, frame.source, frame.data)
        if data is None:
            continue
        if frame.time_s is None:
            out.skipped["messages without a time stamp"] += 1
            continue
        rank, fewest, parts = known
        if len(data) < fewest:
            out.skipped["messages that are too short"] += 1
            continue
        out.clock(frame.time_s, number)
        for part, quantity, value in parts(data):
            name = f"{frame.pgn}.{frame.source}.{part}"
            out.put(
                name,
                str(frame.source),
                quantity,
                frame.time_s,
                value,
                rank + 2 * (part == "yaw") + part[-1:].isdigit(),
            )
    return out.finish()
