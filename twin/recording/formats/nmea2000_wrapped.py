"""NMEA 2000 inside sentences of NMEA 0183, as gateways write it: SeaSmart's $PCDIN, the MiniPlex's $MXPGN,
iKonvert's !PDGY.

    $PCDIN,01F119,00000000,0F,2AAF00D1067414FF*59   group, time, source, data
    $MXPGN,01F801,2801,C1308AC40C5DE343*19   group, priority, length and source, data last byte first
    !PDGY,129025,2,0,255,12.345,Qwe+...   group, priority, source, to whom, seconds, data in base 64
"""

import re
from base64 import b64decode
from binascii import Error

from twin.recording.formats.recorder_stamps import Stamp

Found = tuple[float | None, int, int, bytes, bool]  # stamp [s], group, source, data, whether it is whole
PCDIN = re.compile(r"^(.*?)\$PCDIN,([0-9A-Fa-f]{6}),([0-9A-Fa-f]{8}),([0-9A-Fa-f]{2}),([0-9A-Fa-f]+)\*")
MXPGN = re.compile(r"^(.*?)\$MXPGN,([0-9A-Fa-f]{6}),([0-9A-Fa-f]{4}),([0-9A-Fa-f]+)\*")
PDGY = re.compile(r"^(.*?)!PDGY,(\d+),(\d*),(\d+),(\d*),(\d+(?:\.\d+)?),([A-Za-z0-9+/=]+)")
TICKS = 1024.0  # of SeaSmart's clock in a second


def wrapped(line: str, stamp: Stamp) -> Found | None:
    """The message in a sentence of one of these kinds; None: it is none. A stamp in front of it is taken
    before its own clock."""
    if found := PCDIN.match(line):
        at, pgn, ticks, src, data = found.groups()
        own = int(ticks, 16) / TICKS
        return received(at, stamp, own or None), int(pgn, 16), int(src, 16), pairs(data), len(data) > 16
    if found := MXPGN.match(line):
        at, pgn, about, data = found.groups()
        return (
            received(at, stamp, None),
            int(pgn, 16),
            int(about, 16) & 0xFF,
            pairs(data)[::-1],
            len(data) > 16,
        )
    if found := PDGY.match(line):
        at, pgn, _, src, _, seconds, data = found.groups()
        try:
            raw = b64decode(data + "=" * (-len(data) % 4))
        except Error:
            return None
        return received(at, stamp, float(seconds)), int(pgn), int(src), raw, True
    return None


def received(front: str, stamp: Stamp, own: float | None) -> float | None:
    """When the recorder got it, else what its own clock says [s]."""
    known = stamp(front) if front.strip() else None
    return own if known is None else known


def pairs(text: str) -> bytes:
    """Bytes of hexadecimal digits; half of one at the end is left out."""
    return bytes.fromhex(text[: len(text) // 2 * 2])
