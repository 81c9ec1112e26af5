"""`twin-bench calibrate-memory`: how much memory `twin calibrate` takes at its highest, and for how long.

Six voyages of the reference sea, 20 minutes at 10 Hz each, are sailed and written aside; the verb is run on
them in a process of its own, as an owner types it. Exit code 3 when the peak is above what is wanted."""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from bench.bundled import REFERENCES, recorded
from bench.options import positive
from bench.reference import SeaCase, simulate
from twin import whole
from twin.errors import ThresholdError, TwinError
from twin.recording.write import write_voyage

SCHEMA_VERSION = 1
WANTED_MB = 500.0  # of 1e6 bytes
SEED = 50
# the verb, and then the peak of its own process; what `wait4` tells would count the parent's, too
CHILD = """import sys
from pathlib import Path
from twin.cli import main
code = main(sys.argv[1:])
print(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0])
sys.exit(code)"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--voyages", type=positive, default=6, help="how many (default: 6)")
    parser.add_argument("--minutes", type=float, default=20.0, help="of each (default: 20), at 10 Hz")
    parser.add_argument(
        "--most-mb", type=float, default=WANTED_MB, metavar="MB", help="wanted (default: 500)"
    )
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")


def run(args: argparse.Namespace) -> int:
    with tempfile.TemporaryDirectory() as folder:
        paths = sailed(Path(folder), args.voyages, 60.0 * args.minutes)
        peak_mb, cpu_s = measured(paths, Path(folder) / "calibrated.toml")
    size = {"voyages": args.voyages, "minutes": args.minutes, "rate_hz": 10.0}
    found = {"schema_version": SCHEMA_VERSION, **size, "peak_mb": round(peak_mb, 1), "cpu_s": round(cpu_s, 1)}
    if args.json:
        whole.write_json(found, args.json)
    if args.json != "-":
        print(
            f"{args.voyages} voyages of {args.minutes:g} min at 10 Hz: peak {peak_mb:.0f} MB "
            f"(wanted {args.most_mb:.0f}), {cpu_s:.0f} s of one core"
        )
    if peak_mb > args.most_mb:
        raise ThresholdError(f"twin calibrate took {peak_mb:.0f} MB, wanted: {args.most_mb:.0f} MB.")
    return 0


def sailed(folder: Path, count: int, seconds: float) -> list[Path]:
    """The voyages, every sample of them, as files."""
    manoeuvres = [REFERENCES[i % len(REFERENCES)] for i in range(count)]
    cases = [SeaCase("kvlcc2", m, seed=SEED + i, duration_s=seconds) for i, m in enumerate(manoeuvres)]
    paths = []
    for i, recording in enumerate(simulate(cases)):
        paths.append(folder / f"{i}-{manoeuvres[i]}.mcap")
        write_voyage(recorded(paths[-1].stem, recording.columns), paths[-1])
    return paths


def measured(paths: list[Path], output: Path) -> tuple[float, float]:
    """Highest resident memory [1e6 bytes] and time of the processor [s] of `twin calibrate` on these."""
    words = ["calibrate", *map(str, paths), "--ship", "kvlcc2", "-o", str(output)]
    process = subprocess.Popen(
        [sys.executable, "-c", CHILD, *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    with process:
        said = process.stdout.read() if process.stdout else ""
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, ThresholdError.exit_code):
        raise TwinError(f"twin calibrate ended with exit code {process.returncode}. Run it by hand.")
    return float(said.split()[-1]) * 1024.0 / 1e6, used.ru_utime + used.ru_stime
