"""The `twin-bench` command: a thin shell over one module for each benchmark, loaded only when it is used."""

import argparse
import importlib
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

from twin import whole
from twin.cli import guarded
from twin.errors import TwinError

FIRST = "tick"  # what `twin-bench --steps 10000` runs


class Bench(NamedTuple):
    """Where a benchmark lives (`add_arguments(parser)`, `run(args)`), what it shows, how it is typed."""

    module: str
    help: str
    example: str


BENCHES: dict[str, Bench] = {
    "tick": Bench(
        "bench.tick.budget",
        "the budget: time and memory of the loop, part by part",
        "twin-bench --steps 10000",
    ),
    "arm64": Bench(
        "bench.arm64.run",
        "the same log on an emulated Cortex-A72: are the numbers the same?",
        "twin-bench arm64 --root .arm64",
    ),
    "sea": Bench(
        "bench.sea_process", "the reference sea, speaking Keelson in real time", "twin-bench sea --hull usv"
    ),
    "paper": Bench(
        "bench.paper.reproduce", "the paper's tables beside the paper's numbers", "twin-bench paper --quick"
    ),
    "adaptation": Bench(
        "bench.adaptation.laws_compared",
        "laws of adaptation on ships that changed",
        "twin-bench adaptation --work .paper",
    ),
    "gap": Bench(
        "bench.paper.again", "the gap from validation to test, on more runs", "twin-bench gap --work .paper"
    ),
    "stability": Bench(
        "bench.stability.adversaries",
        "ten thousand runs against the certificate",
        "twin-bench stability --runs 1000",
    ),
    "assumptions": Bench(
        "bench.assumptions",
        "is the promise kept where its assumptions are not?",
        "twin-bench assumptions --seconds 300",
    ),
    "promise": Bench(
        "bench.promise_returns",
        "is the promise given while all is well, and does it come back?",
        "twin-bench promise --hull kvlcc2",
    ),
    "false-words": Bench(
        "bench.false_words",
        "how often is something said of a healthy ship?",
        "twin-bench false-words FOLDER --rounds 2",
    ),
    "seaway": Bench(
        "bench.sea_disturbance",
        "what a seaway costs the promise, and is it kept there?",
        "twin-bench seaway --ship kvlcc2",
    ),
    "tube": Bench(
        "bench.tube.run",
        "the tube around the predictions: is it kept on voyages and hulls that it has not seen?",
        "twin-bench tube --ships kvlcc2=40 --work .tube",
    ),
    "hidden-effects": Bench(
        "bench.league.hidden_effects",
        "the hidden-effect league: is what is missing named?",
        "twin-bench hidden-effects --quick --json -",
    ),
    "lies": Bench(
        "bench.instrument_lies",
        "instruments that lie: how soon it is said, and how often in vain",
        "twin-bench lies --hull usv",
    ),
    "instruments": Bench(
        "bench.instrument_faults",
        "faults of known size in the instruments, by kinematics alone",
        "twin-bench instruments --seeds 2",
    ),
    "import-mistakes": Bench(
        "bench.import_mistakes",
        "mistakes of a recording: named, and never proved where there are none",
        "twin-bench import-mistakes --seeds 2",
    ),
    "whose": Bench(
        "bench.whose_voyage",
        "is a voyage of another ship noticed, and one of its own left in peace?",
        "twin-bench whose FOLDER --seeds 5",
    ),
    "import-speed": Bench(
        "bench.import_speed",
        "how fast logs and tables are read, in how much memory",
        "twin-bench import-speed",
    ),
    "calibrate-memory": Bench(
        "bench.calibrate_memory",
        "how much memory `twin calibrate` takes at its highest",
        "twin-bench calibrate-memory",
    ),
    "growth": Bench(
        "bench.memory_growth",
        "does the service's memory grow under way, and with each log file?",
        "twin-bench growth --hours 2",
    ),
    "fuzz": Bench(
        "bench.fuzz.run",
        "fuzzing, guided by coverage, of all that reads the outside world",
        "twin-bench fuzz --seconds 600",
    ),
    "mutants": Bench(
        "bench.mutants.run",
        "faults planted in the code that guards: does a test notice?",
        "twin-bench mutants --file recursion",
    ),
    "endurance": Bench(
        "bench.endurance.run",
        "the whole service killed, paused and lied to",
        "twin-bench endurance --kills 20",
    ),
    "fleet": Bench(
        "bench.fleet.run",
        "random ships of many forms: a row of facts and truth for each voyage",
        "twin-bench fleet FOLDER --seeds 0-1 --workers 2",
    ),
    "real": Bench(
        "bench.real.kvlcc2", "measured KVLCC2 manoeuvres (SIMMAN 2008)", "twin-bench real --data DIR"
    ),
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run one benchmark; without a name it is the budget of the loop."""
    argv = sys.argv[1:] if argv is None else list(argv)
    if not argv or (argv[0].startswith("-") and argv[0] not in ("-h", "--help")):
        argv = [FIRST, *argv]
    parser = argparse.ArgumentParser(prog="twin-bench", description="What the twin costs and how good it is.")
    parser.epilog = (
        f"Without a name it is {FIRST}: twin-bench --steps 10000. Its options: twin-bench {FIRST} --help"
    )
    benches = parser.add_subparsers(dest="bench", required=True, metavar="BENCH")
    for name, bench in BENCHES.items():
        sub = benches.add_parser(
            name, help=bench.help, description=bench.help, epilog=f"example: {bench.example}"
        )
        if name == argv[0]:
            code = guarded(lambda sub=sub, bench=bench: load(bench).add_arguments(sub))  # type: ignore[misc]
            if code:
                return code
    args = parser.parse_args(argv)
    return guarded(lambda: _run(args))


def _run(args: argparse.Namespace) -> int | None:
    whole.promised(args)
    return load(BENCHES[args.bench]).run(args)  # type: ignore[no-any-return]


def load(bench: Bench) -> Any:
    """The benchmark's module; one clear line when this version does not have it."""
    try:
        return importlib.import_module(bench.module)
    except ModuleNotFoundError as error:
        if error.name != bench.module:
            raise TwinError(
                f"`{bench.example}` needs {error.name!r}. Run: pip install {error.name}"
            ) from None
        raise TwinError(f"`{bench.example}` is not in this version. Known: twin-bench {FIRST}.") from None


if __name__ == "__main__":
    sys.exit(main())
