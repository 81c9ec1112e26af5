"""The index at the end of a log, read by the `mcap` package's own reader, number by number against the messages that
are in it; written as they come, and after a repair."""

from pathlib import Path
from struct import unpack
from zlib import crc32

import pytest
from mcap.reader import make_reader
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    MessageIndex,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.stream_reader import StreamReader, breakup_chunk

from twin.live.log import record
from twin.live.log.mcap_index import FOOTER, IndexSummary
from twin.live.log.recover import recover
from twin.live.log.segment import Segment

FLOAT, TEXT = "keelson.TimestampedFloat", "keelson.TimestampedString"
ROWS = (  # chunk by chunk: topic, type, log time [ns], bytes; times as they come over a clock that was set back
    (("a/x", FLOAT, 500, 30), ("a/y", TEXT, 510, 9000), ("a/x", FLOAT, 505, 1)),
    (("a/y", TEXT, 120, 5), ("a/y", TEXT, 130, 6), ("a/z", FLOAT, 110, 7), ("a/x", FLOAT, 90, 3)),
    (("a/x", FLOAT, 700, 11), ("a/z", FLOAT, 600, 12)),
)


def written(folder: Path, ended=True) -> Path:
    one = Segment(folder, "twin", 0.0, lambda fd: None, record.zstd(), about={"ship": "kvlcc2"})
    for rows in ROWS:
        for topic, type_name, at, size in rows:
            one.add(topic, type_name, bytes(range(256)) * (size // 256) + bytes(size % 256), at, at + 1)
        one.sync()
    if ended:
        one.finish()
    one.close()
    return one.path


def mended(folder: Path) -> Path:
    """A log whose writer was killed after its last whole chunk, and the next start."""
    path = written(folder, ended=False)
    assert recover(path)
    return path


def records(path: Path):
    with path.open("rb") as stream:
        return list(StreamReader(stream, emit_chunks=True, validate_crcs=True).records)


@pytest.fixture(params=(written, mended))
def log(request, tmp_path):
    return request.param(tmp_path)


@pytest.mark.parametrize("made, tables", ((written, 1), (mended, 2)))
def test_the_statistics_count_what_is_there(made, tables, tmp_path):
    with made(tmp_path).open("rb") as stream:
        told = make_reader(stream).get_summary().statistics
    assert told == Statistics(
        attachment_count=0,
        channel_count=3,
        channel_message_counts={1: 4, 2: 3, 3: 2},
        chunk_count=3,
        message_count=9,
        message_start_time=90,
        message_end_time=700,
        metadata_count=tables,
        schema_count=2,
    )


def test_each_chunk_stands_in_the_index_where_it_is_and_each_message_where_its_index_says(log):
    whole, all_records = log.read_bytes(), records(log)
    chunks = [r for r in all_records if isinstance(r, Chunk)]
    told = [r for r in all_records if isinstance(r, ChunkIndex)]
    assert len(chunks) == len(told) == 3
    for chunk, index, rows in zip(chunks, told, ROWS, strict=True):
        times = [at for _, _, at, _ in rows]
        assert (index.message_start_time, index.message_end_time) == (min(times), max(times))
        assert (chunk.message_start_time, chunk.message_end_time) == (min(times), max(times))
        opcode, length = unpack("<BQ", whole[index.chunk_start_offset : index.chunk_start_offset + 9])
        assert (opcode, length + 9) == (6, index.chunk_length) and index.compression == "zstd"
        assert (index.compressed_size, index.uncompressed_size) == (len(chunk.data), chunk.uncompressed_size)
        messages = [r for r in breakup_chunk(chunk, validate_crc=True) if hasattr(r, "log_time")]
        assert [(m.log_time, m.publish_time, len(m.data)) for m in messages] == [
            (at, at + 1, size) for _, _, at, size in rows
        ]
        behind = index.chunk_start_offset + index.chunk_length
        places = sorted(index.message_index_offsets.items(), key=lambda item: item[1])
        assert places[0][1] == behind and {c for c, _ in places} == {m.channel_id for m in messages}
        of_chunk, ends = {}, [*[at for _, at in places[1:]], behind + index.message_index_length]
        for (channel, at), end in zip(places, ends, strict=True):
            opcode, length, named = unpack("<BQH", whole[at : at + 11])
            assert (opcode, named, at + 9 + length) == (7, channel, end)
        following = all_records[all_records.index(chunk) + 1 :][: len(places)]
        for index_of_channel in following:
            assert isinstance(index_of_channel, MessageIndex)
            of_chunk[index_of_channel.channel_id] = [at for at, _ in index_of_channel.records]
        assert of_chunk == {
            c: [m.log_time for m in messages if m.channel_id == c] for c in {m.channel_id for m in messages}
        }


def test_the_summary_repeats_schemas_and_channels_and_says_where_each_kind_begins(log):
    whole, all_records = log.read_bytes(), records(log)
    end = next(i for i, r in enumerate(all_records) if isinstance(r, DataEnd))
    assert all_records[end].data_section_crc == 0  # the format's word for: not computed
    behind = all_records[end + 1 :]
    assert [r.id for r in behind if isinstance(r, Schema)] == [1, 2]
    assert [(r.name, r.encoding) for r in behind if isinstance(r, Schema)] == [
        (FLOAT, "protobuf"),
        (TEXT, "protobuf"),
    ]
    assert [
        (r.id, r.topic, r.schema_id, r.message_encoding, r.metadata) for r in behind if isinstance(r, Channel)
    ] == [
        (1, "a/x", 1, "protobuf", {}),
        (2, "a/y", 2, "protobuf", {}),
        (3, "a/z", 1, "protobuf", {}),
    ]
    footer = all_records[-1]
    assert isinstance(footer, Footer)
    at, groups = footer.summary_start, [r for r in behind if isinstance(r, SummaryOffset)]
    assert [g.group_opcode for g in groups] == [3, 4, 11, 8, 13]
    for group in groups:  # one behind the other, without a gap
        assert group.group_start == at and whole[at] == group.group_opcode
        at += group.group_length
    assert at == footer.summary_offset_start
    assert whole[at] == 14 and footer.summary_crc == crc32(whole[footer.summary_start : -8 - 4])


def test_each_table_of_words_is_found_by_its_index(log):
    with log.open("rb") as stream:
        told = list(make_reader(stream).iter_metadata())
    assert told[0].name == "shiptwin.provenance" and told[0].metadata == {"ship": "kvlcc2"}
    whole = log.read_bytes()
    for index in (r for r in records(log) if isinstance(r, MetadataIndex)):
        assert unpack("<BQ", whole[index.offset : index.offset + 9]) == (12, index.length - 9)
        assert whole[index.offset + 13 :].startswith(index.name.encode())


def test_a_reader_that_seeks_finds_every_message_of_one_topic_in_the_order_of_time(log):
    with log.open("rb") as stream:
        found = [(m.log_time, len(m.data)) for _, _, m in make_reader(stream).iter_messages(topics=["a/x"])]
    with log.open("rb") as stream:
        between = [m.log_time for _, _, m in make_reader(stream).iter_messages(start_time=100, end_time=600)]
    assert found == [(90, 3), (500, 30), (505, 1), (700, 11)]
    assert between == [110, 120, 130, 500, 505, 510]


def test_a_log_in_which_nothing_was_said_has_an_end_of_zeros(tmp_path):
    one = Segment(tmp_path, "twin", 0.0, lambda fd: None, record.zstd())
    one.finish()
    one.close()
    with one.path.open("rb") as stream:
        told = make_reader(stream).get_summary().statistics
    assert told == Statistics(0, 0, {}, 0, 0, 0, 0, 0, 0)
    assert IndexSummary().tail(0)[-37] == FOOTER
