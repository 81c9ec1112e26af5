"""AIS: a position, a speed, a course and a heading of a ship, now and then; no rudder and no shaft.

Source: ITU-R M.1371-5, tables 48 (types 1 to 3) and 64 (type 18).
"""

import re
from pathlib import Path

from twin.recording.formats.lines import numbered
from twin.recording.formats.nmea0183 import TAG_TIME, checksum
from twin.recording.formats.recorder_stamps import Stamp
from twin.recording.formats.signals import Signals

SAYS = "an AIS log (it holds no rudder and no shaft)"
PLAIN = re.compile(rb"!([A-Z]{2})VD([MO]),1,1,[^,]*,[^,]*,([^,]+),\d\*([0-9A-Fa-f]{2})")
KNOT = 1852.0 / 3600.0


def looks(lines: list[str], start: bytes) -> bool:
    """Only AIS sentences, none of the ship's own instruments."""
    ais = sum("!AIVD" in s or "!ABVD" in s or "!BSVD" in s for s in lines[:200])
    return ais >= 1 and ais >= 0.9 * len(lines[:200])


def read(path: Path) -> Signals:
    """Series named ship and part (`219012345.sog`), its source the ship's number; the own ship's (VDO) come
    first."""
    out, stamp = Signals(path, SAYS), Stamp()
    for number, line in numbered(path):
        found = PLAIN.search(line)
        if not found or int(found.group(4), 16) != checksum(found.group(0)[1:-3]):
            out.skipped["sentences that are no single message, or damaged"] += 1
            continue
        front = line[: found.start()].decode("latin-1")
        tag = TAG_TIME.search(front)
        t = stamp(tag.group(1) if tag else front)
        if t is None:
            out.skipped["messages without a time stamp in front"] += 1
            continue
        out.clock(t, number)
        take(out, found.group(3), found.group(2) == b"O", t)
    return out.finish()


def take(out: Signals, payload: bytes, own: bool, t: float) -> None:
    """One AIS message's position, course, speed and heading, where its type has them and it is whole; what
    is not used is counted in `out.skipped`."""
    bits = unarmoured(payload)
    kind = bits >> (len(payload) * 6 - 6) if payload else 0
    at = {1: 50, 2: 50, 3: 50, 18: 46}.get(kind)
    if at is None or len(payload) < 28:
        out.skipped["messages of other types"] += 1
        return
    size = len(payload) * 6

    def field(start: int, length: int, signed: bool = False) -> int:
        raw = (bits >> (size - start - length)) & ((1 << length) - 1)
        return raw - (1 << length) if signed and raw >> (length - 1) else raw

    ship = str(field(8, 30))
    longitude, latitude = field(at + 11, 28, True) / 6e5, field(at + 39, 27, True) / 6e5
    sog, cog, heading = field(at, 10), field(at + 66, 12), field(at + 78, 9)
    rank = 0 if own else 1
    if abs(latitude) <= 90.0 and abs(longitude) <= 180.0:
        out.put(f"{ship}.latitude", ship, "latitude_deg", t, latitude, rank)
        out.put(f"{ship}.longitude", ship, "longitude_deg", t, longitude, rank)
    if sog < 1023 and cog < 3600:
        out.put(f"{ship}.sog", ship, "speed_over_ground_mps", t, sog * 0.1 * KNOT, rank)
        out.put(f"{ship}.cog", ship, "course_over_ground_deg", t, cog * 0.1, rank)
    if heading < 360:
        out.put(f"{ship}.heading", ship, "heading_true_north_deg", t, float(heading), rank)


def unarmoured(payload: bytes) -> int:
    """The six bits of each character, as one number."""
    out = 0
    for c in payload:
        six = c - 48
        out = (out << 6) | ((six - 8 if six > 40 else six) & 63)
    return out
