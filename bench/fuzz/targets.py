"""What is fuzzed, each with true inputs to begin from."""

import gzip
import io
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple, Protocol

from mcap.writer import CompressionType, Writer

from bench.fuzz.aboard import LoopTarget, MessageTarget
from bench.fuzz.ashore import CertificateTarget, LogTarget, ShipTarget, TableTarget
from bench.fuzz.stepped_voyage import CHANNELS, STEP_S, SteppedVoyage
from twin.live.keelson import messages, topics
from twin.live.log.logfile import LogFile
from twin.physics.ship import bundled, load
from twin.recording.formats.nmea0183 import checksum

SHIPS = Path(__file__).parents[2] / "twin" / "ships"


class Target(Protocol):
    """Takes one input; raises when a promise is broken."""

    def one(self, data: bytes) -> None: ...


class Fuzzed(NamedTuple):
    """A target, what it begins from, words that its inputs are made of, its longest input."""

    make: Callable[[], Target]
    seeds: Callable[[], Iterator[bytes]]
    words: tuple[bytes, ...] = ()
    longest: int = 4096


def loop_seeds() -> Iterator[bytes]:
    yield b""
    yield bytes((0, 19, 2, 10, 0, 19))  # sail, a pause of 4 s, sail
    yield bytes((3, 8, 0, 19, 6, 0, 9, 6, 0, 19))  # the clock is set, everybody is silent for a second
    yield bytes((7, 3, 0, 64, 0, 19, 5, 2, 2, 14, 0, 19))  # a lie, a channel lost, half an hour asleep
    yield bytes((8, 1, 0, 0, 2, 0, 128, 0, 19))  # a made-up sample


def message_seeds() -> Iterator[bytes]:
    for i, topic in enumerate(topics.INPUTS):
        stamp_ns = 1_750_000_000_000_000_000
        is_fix = topic.type_name == topics.FIX
        payload = (
            messages.encode_fix(57.7, 11.9, stamp_ns) if is_fix else messages.encode_float(1.5, stamp_ns)
        )
        yield bytes((1, i, len(payload))) + payload + b"\1"


def ship_seeds() -> Iterator[bytes]:
    for name in bundled():
        yield (SHIPS / f"{name}.toml").read_bytes()
    yield b'name = "x"\nL_pp = 100.0\n[effects.Wind]\n[[actuators]]\nname = "port"\nkind = "fixed"\n'


def certificate_seeds() -> Iterator[bytes]:
    yield b"\0{}"
    yield b'\0{"version": 7, "sha256": ""}'
    for place in range(0, 120, 7):
        yield bytes((1, 0, place, 0, 1, 0, 128))


def log_seeds() -> Iterator[bytes]:
    """Ours, and three of another writer; without checksums a change inside a chunk reaches what reads it."""
    rows = [messages.Row(time_s=0.1 * k, north_m=1.0 * k).SerializeToString() for k in range(4)]
    with tempfile.TemporaryDirectory() as folder:
        with LogFile(Path(folder) / "own.mcap") as log:
            for k, row in enumerate(rows):
                log.add("voyage/row", "shiptwin.Row", row, (k + 1) * 10**8)
        yield (Path(folder) / "own.mcap").read_bytes()
    for compression in (CompressionType.NONE, CompressionType.ZSTD, CompressionType.LZ4):
        out = io.BytesIO()
        writer = Writer(out, compression=compression, enable_crcs=False)
        writer.start()
        schema = writer.register_schema("shiptwin.Row", "protobuf", messages.schema_bytes("shiptwin.Row"))
        channel = writer.register_channel("voyage/row", "protobuf", schema)
        for k, row in enumerate(rows):
            writer.add_message(channel, (k + 1) * 10**8, row, (k + 1) * 10**8)
        writer.finish()
        yield out.getvalue()


def table_seeds() -> Iterator[bytes]:
    sailed = SteppedVoyage(load("kvlcc2"))
    rows = [(STEP_S * k, *(sailed.said(k)[name] for name in CHANNELS)) for k in range(0, 120, 4)]
    names = ("time_s", *CHANNELS)
    table = "\n".join((",".join(names), *(",".join(f"{x:.4f}" for x in row) for row in rows))).encode()
    yield b"\0" + table
    yield b"\0" + table.replace(b",", b";").replace(b".", b",")
    yield b"\7" + gzip.compress(table, mtime=0)
    yield b"\1" + b"".join(sentences(rows))
    yield b"\2$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"
    yield b"\3" + b"2026-11-25T10:00:00.000Z,2,127250,1,255,8,00,10,27,ff,7f,ff,7f,fd\n" * 3
    yield b'\4{"context":"vessels.self","updates":[{"timestamp":"2026-11-25T10:00:00Z","values":[]}]}\n'
    yield b'\5{"Package":{"TimeSeriesData":[{"TabularData":[{"DataChannelID":["a"],"DataSet":[]}]}]}}'


def sentences(rows: list[tuple[float, ...]]) -> Iterator[bytes]:
    """A bridge's NMEA 0183 of the same ship."""
    for i, row in enumerate(rows):
        psi, rudder, rpm = row[3], row[7], row[8]
        for body in (
            f"GPRMC,1000{i % 60:02d}.00,A,5700.{i:04d},N,01100.{i:04d},E,12.1,{psi:.1f},251126,,,A",
            f"HEHDT,{psi:.2f},T",
            f"IIRSA,{rudder:.1f},A,,V",
            f"ERRPM,S,1,{rpm:.1f},,A",
        ):
            yield f"${body}*{checksum(body.encode()):02X}\r\n".encode()


TARGETS: dict[str, Fuzzed] = {
    "loop": Fuzzed(LoopTarget, loop_seeds, longest=200),
    "messages": Fuzzed(MessageTarget, message_seeds, longest=600),
    "ship": Fuzzed(
        ShipTarget,
        ship_seeds,
        (b"[effects.", b"[[actuators]]", b"nan", b"inf", b"1e308", b"-1e-308", b"[seaway]", b"[tube]", b"= "),
        20_000,
    ),
    "certificate": Fuzzed(CertificateTarget, certificate_seeds, (b"NaN", b"Infinity", b"null"), 200),
    "log": Fuzzed(LogTarget, log_seeds, (b"\x89MCAP0\r\n", b"zstd", b"lz4", b"\xff" * 8, b"\0" * 8), 4096),
    "table": Fuzzed(
        TableTarget,
        table_seeds,
        (b"time_s", b"$GPRMC", b"$HEHDT", b"nan", b"1e308", b"\r\n", b";", b"\t", b"127250", b"!AIVDM"),
        6000,
    ),
}
