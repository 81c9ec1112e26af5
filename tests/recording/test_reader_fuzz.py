"""Damaged logs of every format: a voyage or one line, never a traceback, never an endless read."""

import json
import random
import time
from functools import partial

import pytest

from tests.recording.conftest import motion, nmea_lines
from tests.recording.test_nmea2000 import FORMS, frames
from tests.recording.test_ros_and_autopilots import dataflash
from tests.recording.test_signalk_ais_iso import deltas
from twin.errors import TwinError
from twin.recording.read import read_voyage

LONGEST_S = 20.0
SHORT = motion(30)


def packed(kind):
    import io

    import pyarrow as pa
    from pyarrow import feather, parquet

    table = pa.table(
        {
            "time_s": SHORT["t"],
            "north_m": SHORT["t"],
            "heading_true_north_deg": SHORT["psi"],
            "rudder_angle_deg": SHORT["rudder"],
            "east_m": SHORT["t"],
            "propeller_rate_rpm": SHORT["rpm"],
        }
    )
    out = io.BytesIO()
    parquet.write_table(table, out) if kind == "parquet" else feather.write_feather(table, out)
    return out.getvalue()


def bus(form):
    return "\n".join(form(*f) for f in frames(SHORT)).encode()


SEEDS = {
    "bridge.log": lambda: "\r\n".join(s for i in range(30) for s in nmea_lines(SHORT, i)).encode(),
    **{f"{name.replace(' ', '_')}.txt": partial(bus, form) for name, form in FORMS.items()},
    "deltas.jsonl": lambda: "\n".join(json.dumps(d) for d in deltas(SHORT)).encode(),
    "flash.BIN": lambda: dataflash(SHORT),
    "v.parquet": lambda: packed("parquet"),
    "v.feather": lambda: packed("feather"),
}


def damaged(data, rng):
    """Bytes flipped, cut out, doubled, or the end cut off."""
    out = bytearray(data)
    for _ in range(rng.randint(1, 12)):
        at = rng.randrange(len(out))
        what = rng.randrange(4)
        if what == 0:
            out[at] = rng.randrange(256)
        elif what == 1:
            del out[at : at + rng.randrange(40)]
        elif what == 2:
            out[at:at] = out[at : at + rng.randrange(200)]
        else:
            out[at : at + 8] = rng.choice(
                (b"\xff" * 8, b"\0" * 8, b"9" * 8, b"-1e308,,", b'{"a":[[[', b"$$$*FF\r\n")
            )
        if not out:
            return b"\n"
    return bytes(out[: rng.randrange(1, len(out) + 1)]) if rng.random() < 0.2 else bytes(out)


@pytest.mark.parametrize("name", SEEDS)
def test_a_damaged_file_is_a_voyage_or_one_line(tmp_path, name):
    data, rng = SEEDS[name](), random.Random(7)
    for k in range(25):
        path = tmp_path / f"{k}_{name}"
        path.write_bytes(damaged(data, rng))
        start = time.monotonic()
        try:
            read_voyage(path, controls=False)
        except TwinError as error:
            assert "\n" not in str(error), str(error)
        assert time.monotonic() - start < LONGEST_S
