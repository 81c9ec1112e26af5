"""The loop on arm64, emulated: the same log, ship by ship, here and there.

    sh bench/arm64/root.sh .arm64                     an arm64 Python beside the emulator, once
    twin-bench arm64 --root .arm64 --out docs/results/arm64.md

An emulated Cortex-A72 computes what the real one does, one instruction like the other, but not as fast: this
is about numbers, not about time. Certificates are worked out here and used in both.
"""

import argparse
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from bench.arm64.states import digest
from twin import whole
from twin.errors import DataError

HOUSE = Path(__file__).resolve().parents[2]
LOG = HOUSE / "twin" / "voyages" / "monday.mcap"
SHIPS = {
    "tanker": str(LOG.with_name("tanker.toml")),
    "kvlcc2": "kvlcc2",
    "container": "container",
    "usv": "usv",
}
OF_STATE = {
    "position [m]": (0, 1),
    "heading [rad]": (2,),
    "speed [m/s]": (3, 4),
    "rate of turn [rad/s]": (5,),
}
INTERPRETER = Path("root/usr/bin/python3.11")


class Compared(NamedTuple):
    """One ship's log on both: the ticks, the SHA-256 of each side, how far apart their numbers ever are."""

    ship: str
    ticks: int
    here: str
    there: str
    apart: dict[str, float]


def emulated(root: Path, *arguments: str) -> str:
    """What the arm64 Python says; DataError with its last line where it ends badly."""
    python = root / INTERPRETER
    if not python.exists():
        raise DataError(f"{root}: no arm64 Python in it. Make it: sh bench/arm64/root.sh {root}")
    where = {"PYTHONPATH": f"{root / 'site'}:{HOUSE}", "PYTHONHOME": str(root / "root" / "usr")}
    qemu = str(root / "qemu/usr/bin/qemu-aarch64-static")
    command = [qemu, "-cpu", "cortex-a72", "-L", str(root / "root"), str(python), *arguments]
    return _said(command, os.environ | where | {"PYTHONDONTWRITEBYTECODE": "1"})


def native(*arguments: str) -> str:
    return _said([sys.executable, *arguments], dict(os.environ))


def _said(command: list[str], environment: dict[str, str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=HOUSE)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise DataError(f"{' '.join(command[-6:])}: exit code {done.returncode}, {last}")
    return done.stdout


def compared(root: Path, seconds: float, ships: dict[str, str]) -> Iterator[Compared]:
    """Ship by ship."""
    with tempfile.TemporaryDirectory() as folder:
        for name, ship in ships.items():
            certificate = str(Path(folder) / f"{name}.json")
            asked = ("-m", "bench.arm64.states", str(LOG), "--ship", ship, "--certificate", certificate)
            asked += ("--seconds", f"{seconds:g}", "--lines")
            here, there = native(*asked).splitlines(), emulated(root, *asked).splitlines()
            yield Compared(name, len(here), digest(here), digest(there), apart(here, there))


def apart(here: list[str], there: list[str]) -> dict[str, float]:
    """The greatest difference of each part of the state over all ticks."""
    rows = [[list(map(float, line.split())) for line in lines] for lines in (here, there)]
    return {
        name: max(abs(one[i] - other[i]) for one, other in zip(*rows, strict=True) for i in columns)
        for name, columns in OF_STATE.items()
    }


def page(rows: list[Compared], seconds: float, versions: str) -> str:
    """The result as Markdown."""
    said = [
        "# The loop on arm64",
        "",
        "```",
        "sh bench/arm64/root.sh .arm64",
        "twin-bench arm64 --root .arm64 --out docs/results/arm64.md",
        "```",
        "",
        f"The first {seconds:g} s of the bundled log `monday`, through the loop that the service builds for",
        "each ship (certificate, and residual and adaptation where the ship has them): on",
        f"{platform.machine()} here and on an emulated Cortex-A72 there ({versions}).",
        "The columns after *same* are the greatest differences of the estimate in any tick.",
        "",
        "| ship | ticks | same to the last digit | " + " | ".join(OF_STATE) + " | SHA-256 |",
        "|---" * (len(OF_STATE) + 4) + "|",
    ]
    for row in rows:
        same = "yes" if row.here == row.there else "no"
        numbers = " | ".join(f"{x:.2g}" if x else "0" for x in row.apart.values())
        said.append(f"| {row.ship} | {row.ticks} | {same} | {numbers} | `{row.there[:16]}` |")
    return "\n".join([*said, "", NOTE])


NOTE = """Physics, observer, gates and certificate are the same to the last digit on both. A residual network
is not: it runs in single precision (32 bit), in loops that ONNX Runtime writes anew for each processor, which
add in another order. Two x86-64 machines, one with AVX2 and one with AVX-512, may differ in the same
way. Debian 12's QEMU (7.2) cannot load ONNX Runtime 1.32: 1.20.1, the oldest that is allowed, stands there.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--root", type=Path, required=True, help="the folder that bench/arm64/root.sh made")
    parser.add_argument(
        "--seconds", type=float, default=60.0, help="how much of the log (default %(default)s)"
    )
    parser.add_argument("--ship", choices=SHIPS, nargs="+", help="only these")
    parser.add_argument("--out", metavar="PAGE.md", type=Path, help="write the page here too")


def run(args: argparse.Namespace) -> int:
    root = args.root.resolve()
    versions = emulated(
        root,
        "-c",
        "import sys, importlib.metadata as m; "
        "print('Python', sys.version.split()[0] + ', ONNX Runtime', m.version('onnxruntime'))",
    ).strip()
    chosen = {name: SHIPS[name] for name in args.ship or SHIPS}
    made = page(list(compared(root, args.seconds, chosen)), args.seconds, versions)
    print(made)
    if args.out:
        whole.write(args.out, made)
    return 0
