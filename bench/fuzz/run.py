"""`twin-bench fuzz`: libFuzzer, guided by which lines of the twin an input reaches, against all that reads
the outside world. Each target has a process of its own; what breaks it is kept as a file and named. What each
target has tried is added up in the folder of its inputs, so that a run goes on where the last one ended."""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

from bench import bench_output
from bench.fuzz.targets import TARGETS
from twin import whole
from twin.errors import TwinError

LONGEST_S, MEMORY_MB = 25, 2048  # of one input
SHARES = {"loop": 5.0}  # of the time; the others have 1
DONE = re.compile(r"#(\d+)\s+\w+\s+cov: (\d+) ft: (\d+)(?: corp: (\d+))?")
BROKE = re.compile(r"Test unit written to (\S+)")


class Fuzzing(NamedTuple):
    """One target: seconds and inputs tried, edges of the code reached, inputs kept, and what broke it."""

    target: str
    seconds: float
    inputs: int
    edges: int
    kept: int
    broken: str
    found: str  # file with the input that broke it


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--target", action="append", choices=TARGETS, help="only this one (repeat)")
    parser.add_argument(
        "--seconds", type=float, default=600.0, metavar="S", help="for all targets together (default: 600)"
    )
    parser.add_argument(
        "--inputs", type=int, metavar="N", help="a target that has tried so many, all runs together, is done"
    )
    parser.add_argument(
        "--corpus", type=Path, default=Path(".fuzz"), metavar="DIR", help="inputs go on from here (.fuzz)"
    )
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    try:
        import atheris  # noqa: F401
    except ImportError:
        raise TwinError("`twin-bench fuzz` needs 'atheris'. Run: pip install atheris") from None
    names = args.target or list(TARGETS)
    whole_share = sum(SHARES.get(name, 1.0) for name in names)
    rows = []
    for name in names:
        seconds = max(round(args.seconds * SHARES.get(name, 1.0) / whole_share), 1)
        tried = known(name, args.corpus)
        if tried is None or not args.inputs or tried.inputs < args.inputs:
            bench_output.tell(f"{name}, {seconds} s")
            left = args.inputs - (tried.inputs if tried else 0) if args.inputs else None
            tried = added(tried, fuzzed(name, seconds, args.corpus, left))
            whole.write_json(tried._asdict(), str(args.corpus / f"{name}.tried.json"))
        rows.append(tried)
    bench_output.rows(args, rows, page(rows))
    return 3 if any(row.broken for row in rows) else 0


def known(name: str, corpus: Path) -> Fuzzing | None:
    """What earlier runs on these inputs made of a target; None: there was none."""
    file = corpus / f"{name}.tried.json"
    return Fuzzing(**json.loads(file.read_text())) if file.exists() else None


def added(before: Fuzzing | None, last: Fuzzing) -> Fuzzing:
    """Both runs together: the seconds and inputs of both, the rest as the last one left it."""
    if before is None:
        return last
    return last._replace(seconds=before.seconds + last.seconds, inputs=before.inputs + last.inputs)


def fuzzed(name: str, seconds: int, corpus: Path, most: int | None = None) -> Fuzzing:
    """One target for so long, until it breaks or, where given, for so many inputs."""
    folder, crashes = corpus / name, corpus / "broke"
    folder.mkdir(parents=True, exist_ok=True)
    crashes.mkdir(exist_ok=True)
    for i, seed in enumerate(TARGETS[name].seeds()):
        (folder / f"seed{i}").write_bytes(seed)
    words = corpus / f"{name}.words"
    lines = ("".join(f"\\x{b:02x}" for b in word) for word in TARGETS[name].words)
    whole.write(words, "".join(f'"{line}"\n' for line in lines), "--corpus")
    options = [
        f"-max_total_time={seconds}",
        *([f"-runs={most}"] if most else []),
        f"-timeout={LONGEST_S}",
        f"-rss_limit_mb={MEMORY_MB}",
        f"-max_len={TARGETS[name].longest}",
        f"-artifact_prefix={crashes}/{name}-",
        "-print_final_stats=1",
        *([f"-dict={words}"] if TARGETS[name].words else []),
    ]
    command = [sys.executable, "-m", "bench.fuzz.one", name, *options, str(folder)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=seconds + 300)
    return read(name, seconds, done.stdout.decode("utf-8", "replace"), done.returncode)


def read(name: str, seconds: float, said: str, code: int) -> Fuzzing:
    """What libFuzzer said."""
    progress = DONE.findall(said)
    if not progress:
        raise TwinError(f"the fuzzer did not start on {name!r}: {' '.join(said.split()[-40:])}")
    inputs, edges, _, kept = progress[-1]
    file = BROKE.search(said)
    broken = ""
    if code:
        raised = re.findall(r"^(?:\w+\.)*\w*(?:Error|Exception|Watched|Unfit)\b.*$", said, re.M)
        broken = (raised or re.findall(r"^==\d+==\s*ERROR: (.*)$", said, re.M) or [f"exit code {code}"])[-1]
    return Fuzzing(
        name, seconds, int(inputs), int(edges), int(kept or 0), broken[:300], file[1] if file else ""
    )


def page(rows: list[Fuzzing]) -> str:
    """The page."""
    lines = bench_output.begun(
        "Fuzzing with coverage", __doc__, "target", "s", "inputs", "edges reached", "kept", "broken"
    )
    for r in rows:
        broken = f"{r.broken} ({Path(r.found).name})" if r.broken else "no"
        lines.append(f"| {r.target} | {r.seconds:.0f} | {r.inputs} | {r.edges} | {r.kept} | {broken} |")
    return "\n".join(lines)


def replayed(name: str, inputs: list[Path]) -> Any:
    """Every input once, without the fuzzer."""
    target = TARGETS[name].make()
    for path in inputs:
        target.one(path.read_bytes())
    return target
