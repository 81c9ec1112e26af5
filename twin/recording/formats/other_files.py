"""Files that are known and not read: each is named, with what to do, instead of being taken for a table."""

from twin.errors import DataError
from twin.recording.formats.lines import head_lines

TABLE = "Export it as CSV, Excel (.xlsx) or Parquet."
# what a file begins with, what it is, what to do
BEGINNINGS: tuple[tuple[bytes, str, str], ...] = (
    (b"MATLAB 5.0", "a MATLAB file", "In MATLAB: writetable(TABLE, 'log.csv')."),
    (b"\x89HDF\r\n", "an HDF5 file (MATLAB 7.3 and netCDF 4 are such)", TABLE),
    (b"CDF\x01", "a netCDF file", TABLE),
    (b"CDF\x02", "a netCDF file", TABLE),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook of before 2007 (.xls)", "Save it as .xlsx or CSV."),
    (
        b"\xd4\xc3\xb2\xa1",
        "a capture of a network (pcap)",
        "Export the payloads as text, one sentence a line.",
    ),
    (
        b"\xa1\xb2\xc3\xd4",
        "a capture of a network (pcap)",
        "Export the payloads as text, one sentence a line.",
    ),
    (
        b"\x0a\x0d\x0d\x0a",
        "a capture of a network (pcapng)",
        "Export the payloads as text, one sentence a line.",
    ),
    (b"%PDF", "a PDF document", TABLE),
    (b"\x93NUMPY", "a NumPy array", TABLE),
    (b"TDSm", "a LabVIEW TDMS file", TABLE),
    (b"MDF ", "an MDF/MF4 measurement file", TABLE),
    (b"\x80\x04\x95", "a Python pickle", TABLE),
    (b"\x80\x05\x95", "a Python pickle", TABLE),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "Unpack it."),
    (b"\x28\xb5\x2f\xfd", "packed by zstd", "Unpack it."),
    (b"Rar!", "a RAR archive", "Unpack it."),
    (b"BZh", "packed by bzip2", "Unpack it, or pack it as .gz."),
    (b"\xfd7zXZ\x00", "packed by xz", "Unpack it, or pack it as .gz."),
)
INSIDE: tuple[tuple[str, str, str], ...] = (
    ("<gpx", "a GPX track", "It holds positions only, no heading, rudder or shaft: give the boat's own log."),
    ("<kml", "a KML map", "It holds positions only, no heading, rudder or shaft: give the boat's own log."),
    (
        "<TrainingCenterDatabase",
        "a TCX track",
        "It holds no heading, rudder or shaft: give the boat's own log.",
    ),
    ("<html", "a web page", "Was the log behind it saved?"),
    ("<?xml", "an XML file", TABLE),
)
SPREADSHEET = b"mimetypeapplication/vnd.oasis.opendocument.spreadsheet"


def refuse_others(path: object, start: bytes) -> None:
    """DataError: a file begins as one of a kind that is known and not read. `start`: its first bytes."""
    for begins, what, do in BEGINNINGS:
        if start.startswith(begins):
            raise DataError(f"{path}: this is {what}, which is not read. {do}")
    if SPREADSHEET in start[:200]:
        raise DataError(
            f"{path}: this is an OpenDocument spreadsheet, which is not read. Save it as .xlsx or CSV."
        )
    if start[8:12] == b".FIT":
        raise DataError(
            f"{path}: this is a FIT activity, which holds no rudder and no shaft, and is not read."
        )
    first = " ".join(head_lines(start)[:3])
    for word, what, do in INSIDE:
        if first.lstrip("\ufeff\xef\xbb\xbf ").startswith("<") and word.lower() in first.lower():
            raise DataError(f"{path}: this is {what}, which is not read. {do}")
