"""`twin-bench import-speed`: how fast logs and tables are read, and in how much memory.

A log of NMEA 0183 of a whole day and a table of the size asked for are written aside, and each is imported in
a process of its own."""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from twin.recording.formats.nmea0183 import checksum

SCHEMA_VERSION = 1
DAY_S = 86400
CHUNK = 20_000
NAMES = (
    "time_s",
    "north_m",
    "east_m",
    "heading_true_north_deg",
    "surge_velocity_mps",
    "sway_velocity_mps",
    "yaw_rate_degps",
    "rudder_angle_deg",
    "propeller_rate_rpm",
    "true_wind_speed_mps",
    "true_wind_direction_deg",
    "water_depth_m",
)
CHILD = """
import json, sys, time
from pathlib import Path
from twin.recording.samples_of import raw_of
from twin.recording.voyage import Voyage
from twin.recording.voyage import Voyage
start = time.process_time()  # seconds of one core, whatever else the machine does
raw = raw_of(Path(sys.argv[1]), None, {})
read_s = time.process_time() - start
samples = sum(x.size for x in raw.columns.values())
voyage = Voyage.of(raw)
print(json.dumps({"read_s": read_s, "voyage_s": time.process_time() - start, "rows": len(voyage), "samples": samples,
                  "peak_mb": int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0]) / 1024.0}))
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--table-mb", type=int, default=200, metavar="MB", help="size of the table")
    parser.add_argument("--hours", type=float, default=24.0, metavar="H", help="length of the NMEA 0183 log")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")


def run(args: argparse.Namespace) -> int:
    with tempfile.TemporaryDirectory() as folder:
        log, table = Path(folder) / "day.nmea", Path(folder) / "table.csv"
        sentences = write_log(log, int(args.hours * 3600))
        write_table(table, args.table_mb << 20)
        found = {"schema_version": SCHEMA_VERSION, "nmea0183": measured(log), "table": measured(table)}
        found["nmea0183"] |= {
            "sentences": sentences,
            "sentences_per_s": sentences / found["nmea0183"]["read_s"],
        }
        found["table"] |= {
            "mb": table.stat().st_size >> 20,
            "samples_per_s": found["table"]["samples"] / found["table"]["read_s"],
        }
    if args.json == "-":
        print(json.dumps(found, indent=2))
        return 0
    if args.json:
        Path(args.json).write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    n, t = found["nmea0183"], found["table"]
    print(
        f"NMEA 0183, {args.hours:g} h: {sentences} sentences, {n['sentences_per_s']:.3g} a second, "
        f"{n['voyage_s']:.1f} s to a voyage, peak {n['peak_mb']:.0f} MB"
    )
    print(
        f"table, {t['mb']} MB: {t['samples']} samples held, {t['samples_per_s']:.3g} a second, "
        f"{t['voyage_s']:.1f} s to a voyage, peak {t['peak_mb']:.0f} MB"
    )
    return 0


def measured(path: Path) -> dict[str, Any]:
    """The import of one file, in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", CHILD, str(path)], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)  # type: ignore[no-any-return]


def sentence(body: str) -> str:
    return f"${body}*{checksum(body.encode()):02X}\r\n"


def write_log(path: Path, seconds: int) -> int:
    """A day of a bridge: position, course, heading five times a second, rate of turn, rudder, shaft, wind,
    depth."""
    count = 0
    with open(path, "w", encoding="ascii", newline="") as out:
        for k in range(seconds):
            hh, mm, ss = k // 3600 % 24, k // 60 % 60, k % 60
            psi = (45.0 + 30.0 * np.sin(k / 200.0)) % 360.0
            lat, lon = 57.0 * 100 + (k * 0.003) % 50, 11.0 * 100 + (k * 0.004) % 50
            rows = [
                f"GPRMC,{hh:02d}{mm:02d}{ss:02d}.00,A,{lat:.4f},N,{lon:09.4f},E,12.1,{psi:.1f},251126,,,A",
                f"GPVTG,{psi:.1f},T,,M,12.1,N,22.4,K,A",
                *(f"HEHDT,{psi + 0.1 * i:.2f},T" for i in range(5)),
                f"TIROT,{9.0 * np.cos(k / 200.0):.1f},A",
                f"IIRSA,{5 * np.sin(k / 30):.1f},A,,V",
                "ERRPM,S,1,84.5,,A",
                f"WIMWV,{(30 - psi) % 360:.1f},R,12.0,N,A",
                "SDDPT,45.2,0.0",
            ]
            out.writelines(map(sentence, rows))
            count += len(rows)
    return count


def write_table(path: Path, size: int) -> None:
    """Rows of twelve columns, ten a second, until the file is that large."""
    rng, at = np.random.default_rng(1), 0
    with open(path, "w", encoding="ascii") as out:
        out.write(",".join(NAMES) + "\n")
        t = np.arange(CHUNK) * 0.1
        tail = [
            7 * t,
            0.1 * rng.normal(size=CHUNK),
            45 + 20 * np.sin(t / 60),
            7 + 0.05 * rng.normal(size=CHUNK),
            0.05 * rng.normal(size=CHUNK),
            0.3 * np.cos(t / 60),
            10 * np.cos(t / 60),
            100 + 0 * t,
            8 + rng.normal(size=CHUNK),
            45 + rng.normal(size=CHUNK),
            30 + 0 * t,
        ]
        cells = [",".join(f"{x:.8g}" for x in row) for row in zip(*tail, strict=True)]
        while out.tell() < size:
            out.write("".join(f"{at + 0.1 * i:.1f},{cell}\n" for i, cell in enumerate(cells)))
            at += CHUNK // 10
