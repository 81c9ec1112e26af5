"""The log as others read it, and how it fares when all is well."""

import io
import os
import subprocess
import sys
import tracemalloc
from pathlib import Path
from time import monotonic, sleep

import pytest
from mcap.reader import NonSeekingReader, make_reader

from twin.errors import DataError, TwinError
from twin.live.keelson import messages
from twin.live.log.mcap_index import MAGIC
from twin.live.log.mcap_read import McapReader
from twin.live.log.mcap_write import CHUNK_BYTES, McapWriter
from twin.live.log.record import LogFile, LogState, Recorder, read

SCALAR = "keelson.TimestampedFloat"
TICKS = "twin/@v0/ship/pubsub/twin_tick/twin"
TOPIC = "twin/@v0/ship/pubsub/heading_true_north_deg/gyro"


def write_log(path: Path, count: int = 100) -> None:
    with LogFile(path) as log:
        log.describe("voyage", {"ship": "KVLCC2"})
        for i in range(count):
            log.add(TOPIC, SCALAR, messages.encode_float(float(i), i), i)
            log.add(TICKS, "shiptwin.Tick", messages.Tick(index=i).SerializeToString(), i)


def until(true, seconds: float = 5.0) -> None:
    """Waits until something becomes true."""
    end = monotonic() + seconds
    while not true():
        assert monotonic() < end, "it did not happen in time"
        sleep(0.02)


def put(recorder: Recorder, count: int, first: int = 0) -> None:
    for i in range(first, first + count):
        recorder.write(TOPIC, SCALAR, messages.encode_float(float(i), i), i)


def test_the_mcap_library_reads_our_log_with_all_checksums(tmp_path: Path) -> None:
    write_log(tmp_path / "a.mcap", 5000)
    with open(tmp_path / "a.mcap", "rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None and summary.statistics is not None
        assert summary.statistics.message_count == 10_000 and len(summary.chunk_indexes) > 1
        assert {schema.name for schema in summary.schemas.values()} == {SCALAR, "shiptwin.Tick"}
        assert [m.metadata for m in reader.iter_metadata()] == [{"ship": "KVLCC2"}]
        assert sum(1 for _ in reader.iter_messages(topics=[TOPIC])) == 5000
        assert sum(1 for _ in reader.iter_messages(starting_at=1000, ending_before=1010)) == 20
    with open(tmp_path / "a.mcap", "rb") as stream:
        assert sum(1 for _ in NonSeekingReader(stream, validate_crcs=True).iter_messages()) == 10_000


def test_the_mcap_librarys_decoder_opens_our_wide_record(tmp_path: Path) -> None:
    decoder = pytest.importorskip("mcap_protobuf.decoder")
    write_log(tmp_path / "a.mcap", 3)
    with open(tmp_path / "a.mcap", "rb") as stream:
        reader = make_reader(stream, decoder_factories=[decoder.DecoderFactory()])
        ticks = [d.index for s, _, _, d in reader.iter_decoded_messages() if s and s.name == "shiptwin.Tick"]
    assert ticks == [0, 1, 2]


def test_we_read_what_the_mcap_library_writes(tmp_path: Path) -> None:
    from mcap.writer import CompressionType, Writer

    for compression in CompressionType:
        for chunked in (True, False):
            buffer = io.BytesIO()
            writer = Writer(buffer, compression=compression, use_chunking=chunked)
            writer.start()
            schema = writer.register_schema(SCALAR, "protobuf", messages.schema_bytes(SCALAR))
            channel = writer.register_channel(TOPIC, "protobuf", schema)
            for i in range(50):
                writer.add_message(channel, i, bytes([i]), i)
            writer.finish()
            (tmp_path / "b.mcap").write_bytes(buffer.getvalue())
            reader = McapReader(tmp_path / "b.mcap")
            assert [m.data[0] for m in reader.messages()] == list(range(50))
            assert reader.problems == []


def test_the_same_messages_give_the_same_bytes(tmp_path: Path) -> None:
    write_log(tmp_path / "a.mcap")
    write_log(tmp_path / "b.mcap")
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()


def test_messages_come_back_in_the_order_they_were_written(tmp_path: Path) -> None:
    with LogFile(tmp_path / "a.mcap") as log:
        for ns in (5, 3, 9, 1):
            log.add(TOPIC, SCALAR, b"x", ns, ns + 1)
    assert [(m.log_ns, m.publish_ns) for m in read(tmp_path / "a.mcap")] == [(5, 6), (3, 4), (9, 10), (1, 2)]


def test_an_error_halfway_leaves_no_file(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), LogFile(tmp_path / "a.mcap") as log:
        log.add(TOPIC, SCALAR, b"x", 1)
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(TwinError, match="cannot be written"), LogFile(tmp_path / "no" / "a.mcap"):
        pass


def test_a_recorder_writes_within_half_a_second_and_finishes_its_file(tmp_path: Path) -> None:
    with Recorder(tmp_path, "anna") as recorder:
        put(recorder, 50)
        until(lambda: recorder.state.written == 50, 0.9)
        path = Path(recorder.state.path)
        assert len(list(read(path))) == 50
    assert recorder.state == LogState(True, "", "", 50, 0, 0)
    assert path.name.startswith("anna-000001-") and len(list(read(path))) == 50
    with open(path, "rb") as stream:
        assert make_reader(stream, validate_crcs=True).get_summary() is not None


def test_files_rotate_by_size_and_by_time(tmp_path: Path) -> None:
    for limit in ({"max_bytes": 1000}, {"max_seconds": 0.1}):
        folder = tmp_path / next(iter(limit))
        with Recorder(folder, **limit) as recorder:
            for burst in range(4):
                put(recorder, 20, burst * 20)
                wanted = (burst + 1) * 20
                until(lambda wanted=wanted: recorder.state.written == wanted)
        files = sorted(folder.iterdir())
        assert len(files) >= 3
        assert sum(len(list(read(file))) for file in files) == 80


def test_a_burst_is_written_in_small_chunks() -> None:
    chunks: list[int] = []
    writer = McapWriter(lambda data: chunks.append(len(data)), compress=bytes)
    writer.start()
    channel = writer.channel(TOPIC, SCALAR, messages.schema_bytes)
    for i in range(2000):
        writer.add(channel, bytes(500), i, i)
    assert max(chunks) < CHUNK_BYTES * 1.1


def test_four_chunks_a_second_for_a_quarter_of_an_hour_do_not_fill_the_memory() -> None:
    """Expected: what is remembered for the index is what will be written of it, 200 bytes a chunk and no
    objects."""
    writer = McapWriter(lambda data: None, compress=bytes)
    writer.start()
    channels = [writer.channel(f"{TOPIC}{i}", SCALAR, messages.schema_bytes) for i in range(10)]

    def write(chunks: int) -> None:
        for k in range(chunks):
            for channel in channels:
                writer.add(channel, b"12345678", k, k)
            writer.flush()

    write(100)
    tracemalloc.start()
    write(3600)
    grown, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert writer.summary.chunks == 3700 and grown < 3600 * 300


def test_a_flood_does_not_wait_for_the_next_period(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Test: a thread that would write once an hour, and 300 messages. Expected: it writes as soon as 256
    wait."""
    monkeypatch.setattr("twin.live.log.record.PERIOD_S", 3600.0)
    with Recorder(tmp_path) as recorder:
        put(recorder, 300, 0)
        until(lambda: recorder.state.written >= 256)


def test_a_message_no_log_can_hold_stops_nothing_but_itself(tmp_path: Path) -> None:
    with Recorder(tmp_path) as recorder:
        recorder.write(TOPIC, "no.SuchType", b"", 1)
        until(lambda: not recorder.state.ok)
        assert "no.SuchType" in recorder.state.alarm
        until(lambda: put(recorder, 1) or recorder.state.written > 0)
        assert recorder.state.ok


@pytest.mark.parametrize("content", [b"", b"hello", MAGIC, MAGIC + b"\x01" + b"\xff" * 7 + b"\x7f"])
def test_what_is_no_log_is_one_clear_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(content)
    with pytest.raises(DataError) as raised:
        list(read(path))
    assert str(path) in str(raised.value) and "\n" not in str(raised.value)


def test_a_missing_file_and_a_folder_are_one_clear_line(tmp_path: Path) -> None:
    for path in (tmp_path / "none.mcap", tmp_path):
        with pytest.raises(DataError, match="cannot be"):
            list(read(path))


def test_one_rotten_bit_anywhere_is_never_a_wrong_number(tmp_path: Path) -> None:
    """S6: each message read from a file with one flipped bit is one that was written."""
    import random

    path = tmp_path / "a.mcap"
    write_log(path, 200)
    good = path.read_bytes()
    written = {(m.topic, m.data, m.log_ns) for m in read(path)}
    rng = random.Random(6)
    for _ in range(300):
        raw = bytearray(good)
        raw[rng.randrange(len(raw))] ^= 1 << rng.randrange(8)
        path.write_bytes(raw)
        try:
            assert {(m.topic, m.data, m.log_ns) for m in read(path)} <= written
        except DataError as error:
            assert "\n" not in str(error)


def test_a_rotten_chunk_is_named_and_the_rest_is_read(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    chunks: list[bytes] = []
    writer = McapWriter(chunks.append)
    writer.start()
    channel = writer.channel(TOPIC, SCALAR, messages.schema_bytes)
    for i in range(30):
        writer.add(channel, messages.encode_float(float(i), i), i, i)
        if i % 10 == 9:
            writer.flush()
    writer.finish()
    for rotten in (1, 2, 3):
        parts = [bytearray(part) for part in chunks]
        parts[rotten][90] ^= 1
        path.write_bytes(b"".join(parts))
        notes: list[str] = []
        assert len(list(read(path, notes))) == 20
        assert len(notes) == 1 and "damaged and left out" in notes[0]


def test_a_chunk_that_claims_to_unpack_to_gigabytes_is_refused(tmp_path: Path) -> None:
    """Q6: a zip bomb costs no memory."""
    import zstandard

    bomb = zstandard.compress(bytes(300_000_000))
    path = tmp_path / "a.mcap"
    with LogFile(path) as log:
        log._writer._compress = lambda raw: bomb
        log.add(TOPIC, SCALAR, b"x", 1)
    Path("/proc/self/clear_refs").write_text("5")  # the peak begins anew
    before = peak_kb()
    with pytest.raises(DataError, match="nothing in it can be read"):
        list(read(path))
    assert peak_kb() - before < 20_000


def peak_kb() -> int:
    return int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0])


def test_file_names_count_up_even_when_the_clock_runs_back(tmp_path: Path) -> None:
    """S7: the number decides, not the time; nothing is overwritten."""
    (tmp_path / "twin-000041-20990101T000000Z.mcap").write_bytes(b"precious")
    with Recorder(tmp_path) as recorder:
        put(recorder, 1)
        until(lambda: recorder.state.written == 1)
        assert os.path.basename(recorder.state.path).startswith("twin-000042-")
    assert (tmp_path / "twin-000041-20990101T000000Z.unreadable").read_bytes() == b"precious"


def test_the_bus_and_the_log_load_nothing_heavy() -> None:
    """Memory on board: numpy 16 MB, keelson 4, mcap's writer 8: none is needed to speak or to log."""
    script = (
        "import sys\nfrom twin.live import clock\nfrom twin.live.keelson import bus, decode, zenoh_bus\nfrom twin.live.log import record\n"
        "heavy = ('numpy', 'keelson', 'mcap', 'yaml', 'lz4', 'importlib.metadata')\n"
        "print([name for name in heavy if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
