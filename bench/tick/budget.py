"""`twin-bench --steps 10000`: is the whole loop inside its budget of time and memory, and beside its peers?

Four processes, one after the other: the service as fast as it can, the service on time (each with the
reference sea's instruments in a process beside it), the peers, and valgrind where it is installed.
"""

import argparse
import json
import os
import socket
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from bench import bench_output
from bench.tick import cortex, instructions, instrument_feed, mark, terminal_table
from bench.tick.process import WARM_UP
from twin.errors import TwinError, UsageError
from twin.live.learning.residual import bundled
from twin.physics.ship import Ship, load

SCHEMA_VERSION = 1
PYTHON = (sys.executable, "-P", "-m")  # -P: a folder named twin/ where it is called is no package
PARTS = 2000  # ticks with a stop-watch on each part, after the measured ones
PACED_S = 20.0
COUNTED_FROM = 5000  # steps: a quick look does not wait for valgrind
# what the service imports, compiled beforehand: an installed package comes compiled, and compiling at the
# start leaves 1 MB of holes in memory
IMPORTS = "import bench.tick.process, subprocess, twin.live.keelson.zenoh_bus, zstandard"
# what a peer does too: correct, force, one step on
COMPUTING = ("correct", "known", "learned", "adapt", "step")
MORE = ("sensors", "predict")  # what no peer does: gates, and 120 s ahead


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--steps", type=int, default=10000, help="ticks as fast as possible (default: 10000)")
    parser.add_argument("--rate", type=float, default=50.0, metavar="HZ", help="of the loop (default: 50)")
    parser.add_argument(
        "--paced", type=int, metavar="N", help="ticks on time (default: 20 s of them; 0: none)"
    )
    parser.add_argument("--ship", default="kvlcc2", help="ship file or bundled ship (default: kvlcc2)")
    parser.add_argument(
        "--target", choices=["here", "cortex-a72"], default="here", help="whose budget is checked"
    )
    parser.add_argument("--budget-ms", type=float, default=12.0, help="for a step, p99.9 (default: 12)")
    parser.add_argument("--budget-mb", type=float, default=48.0, help="for the process, peak (default: 48)")
    parser.add_argument("--no-peers", action="store_true", help="leave the peers out")
    parser.add_argument("--no-instructions", action="store_true", help="leave valgrind out")
    parser.add_argument("--json", metavar="FILE", help="write the result here (- for standard output)")
    parser.set_defaults(page=None)


def run(args: argparse.Namespace) -> int:
    """Measure, print, and say by the exit code whether the budgets are kept (3 when not)."""
    if args.steps < 10:
        raise UsageError(f"--steps {args.steps}: at least 10 are needed for a median and a tail.")
    result = measure(args)
    bench_output.give(args, result, terminal_table.text(result))
    return 0 if result["within_budget"] else 3


def measure(args: argparse.Namespace) -> dict[str, Any]:
    """Everything `--json` holds."""
    paced_steps = int(PACED_S * args.rate) if args.paced is None else args.paced
    with tempfile.TemporaryDirectory(prefix="twin-bench-") as folder:
        place = LoopFolder(Path(folder), args)
        bench_output.tell(f"sailing the voyage that is fed ({place.seconds(args.steps):.0f} s at sea) ...")
        place.prepare(max(args.steps, paced_steps))
        bench_output.tell(f"the loop as fast as it can, {args.steps} steps ...")
        fast = place.loop(args.steps, PARTS, "fast")
        if paced_steps:
            bench_output.tell(f"the loop on time, {paced_steps} steps at {args.rate:g} Hz ...")
        paced = place.loop(paced_steps, 0, "paced") if paced_steps else None
        peers = {"hybrid": {}, "peers": {}, "look_ahead": {}}
        if not args.no_peers:
            bench_output.tell("the peers ...")
            peers = _json_of([*PYTHON, "bench.tick.peers"], "the peers")
        counted = {}
        if args.steps >= COUNTED_FROM and not args.no_instructions and instructions.available():
            bench_output.tell("counting instructions with valgrind ...")
            counted = instructions.counts()
        residual = place.residual
    return against_budgets(args, fast, paced, peers, counted, residual)


def against_budgets(
    args: argparse.Namespace, fast: Any, paced: Any, peers: Any, counted: dict[str, int], residual: str
) -> dict[str, Any]:
    """The measurements put together, and held against the budgets."""
    step, memory = fast["step_us"], fast["memory"]
    parts = {name: times for name, times in fast["parts_us"].items() if name != "tick"}
    estimate = cortex.estimate(step["median"], step["p999"]) | {"anchor": cortex.anchor()}
    held_ms = estimate["step_ms_p999"] if args.target == "cortex-a72" else step["p999"] * 1e-3
    computing, more = (
        round(sum(parts[name]["mean"] for name in names if name in parts), 1) for names in (COMPUTING, MORE)
    )
    over = []
    if held_ms > args.budget_ms:
        over.append(f"step {held_ms:.1f} ms (p99.9) is over {args.budget_ms:g} ms")
    if memory["peak_mb"] > args.budget_mb:
        over.append(f"memory {memory['peak_mb']:.1f} MB (peak) is over {args.budget_mb:g} MB")
    return {
        "schema_version": SCHEMA_VERSION,
        "steps": args.steps,
        "rate_hz": args.rate,
        "target": args.target,
        "residual": residual,
        "step_us": step,
        "parts_us": parts,
        "computing_us": computing,
        "more_us": more,
        "missed_deadlines": (paced or fast)["missed_deadlines"],
        "messages_per_step": fast["messages_per_step"],
        "cpu_us_per_step": fast["cpu_us_per_step"],
        "paced": _paced(paced),
        "rss_peak_mb": memory["peak_mb"],
        "rss_anon_mb": memory["anon_mb"],
        "rss_file_mb": memory["file_mb"],
        "rss_growth_mb": fast["growth_mb"],
        "rss_growth_anon_mb": fast["growth_anon_mb"],
        "mode": fast["mode"],
        "modes": fast["modes"],
        "reasons": fast["reasons"],
        "notes": fast["notes"],
        "log": fast["log"],
        **peers,
        "ratios": _ratios(peers),
        "instructions": counted,
        "cortex_a72": estimate,
        "budget": {"step_ms": args.budget_ms, "rss_mb": args.budget_mb},
        "over_budget": over,
        "within_budget": not over,
    }


class LoopFolder:
    """A folder with settings, the voyage and the log, and a free port on loopback."""

    def __init__(self, folder: Path, args: argparse.Namespace):
        self.folder, self.rate = folder, args.rate
        self.ship = load(args.ship)
        self.environment = os.environ | {"PYTHONPYCACHEPREFIX": str(folder / "compiled")}
        self.environment.pop("PYTHONDONTWRITEBYTECODE", None)
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.endpoint = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
        found = None if self.ship.actuators else bundled(self.ship)
        self.residual = found.name if found else "stand-in with drawn weights (this ship has none)"
        if self.ship.actuators:
            self.residual = "none: a network looks at one rudder and one shaft"
        self._settings(args.ship, "none" if self.ship.actuators else found or self._stand_in())

    def seconds(self, steps: int) -> float:
        """How long the voyage lasts by the loop's clock."""
        return (WARM_UP + steps + PARTS) / self.rate + 2.0

    def prepare(self, steps: int) -> None:
        instrument_feed.prepare(self.folder / "rows", self.seconds(steps), _hull(self.ship))
        subprocess.run([sys.executable, "-P", "-c", IMPORTS], env=self.environment, check=True)

    def loop(self, steps: int, parts: int, pace: str) -> dict[str, Any]:
        """One run of the service, fed by a process beside it."""
        rows, settings = self.folder / "rows", str(self.folder / "twin.toml")
        measured = ["bench.tick.process", settings, str(mark.new(rows)), str(steps), str(parts), pace]
        feeder = subprocess.Popen(
            [*PYTHON, "bench.tick.instrument_feed", str(rows), self.endpoint, "twin", "ship"]
        )
        try:
            return _json_of([*PYTHON, *measured], "the loop", self.environment)
        finally:
            feeder.terminate()
            feeder.wait(10)

    def _stand_in(self) -> Path:
        from bench.tick import stand_in

        return stand_in.write(self.folder / "stand-in.onnx", self.ship)

    def _settings(self, ship: str, residual: Path | str) -> None:
        # the limit of 200 messages a second is meant for time that passes
        zenoh = self.folder / "zenoh.json5"
        zenoh.write_text(
            '{downsampling: [{messages: ["put"], flows: ["ingress"], rules: [{key_expr: "x", freq: 1.0}]}]}'
        )
        settings = {
            "ship": {"file": ship},
            "loop": {"rate_hz": self.rate},
            "log": {"folder": self.folder / "logs"},
            "bus": {"listen": self.endpoint, "file": zenoh},
            "state": {"folder": self.folder / "state"},
            "residual": {"file": residual, "required": residual != "none"},
        }
        sections = [
            [f"[{name}]", *(f"{key} = {json.dumps(x, default=str)}" for key, x in keys.items())]
            for name, keys in settings.items()
        ]
        (self.folder / "twin.toml").write_text("\n".join(line for section in sections for line in section))


def _hull(ship: Ship) -> str:
    """The reference sea's hull for a bundled ship; KVLCC2 for any other: the cost does not depend on it. A
    ship of actuators must be one of the sea's own, that speaks of each."""
    from bench.reference.boats import CRAFT
    from bench.ships import NAMES

    if not ship.actuators:
        return next((hull for hull, name in NAMES.items() if name == ship.name), "kvlcc2")
    own = {c.name: {f"{d.name}.{r}" for d in c.drives for r in d.records} for c in CRAFT.values()}
    wanted = {channel for a in ship.actuators for channel in a.columns()}
    for name, said in own.items():
        if wanted == said:
            return name
    raise UsageError(
        f"--ship: no hull of the reference sea has the actuators of {ship.name!r}. Take one that has: "
        f"twin-bench sea --hull {next(iter(own))} --sheet FILE.toml, then twin init."
    )


def _json_of(command: list[str], who: str, environment: dict[str, str] | None = None) -> dict[str, Any]:
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    if done.returncode != 0:
        said = done.stderr.strip().splitlines()[-1:] or ["nothing was said"]
        raise TwinError(f"{who} could not be measured: {said[0]}")
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def _paced(paced: Any) -> dict[str, Any] | None:
    names = ("step_us", "wake_up_us", "missed_deadlines", "cpu_us_per_step", "messages_per_step", "memory")
    return {name: paced[name] for name in names} if paced else None


def _ratios(found: dict[str, Any]) -> dict[str, float]:
    """The twin's step over each peer's, all hot: below 1 the twin is quicker."""
    return {
        f"hybrid_over_{name}": round(found["hybrid"]["mean_us"] / p["median_us"], 2)
        for name, p in found["peers"].items()
    }
