"""The `twin` command: a thin shell over one module for each verb, loaded only when the verb is used."""

import argparse
import importlib
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from twin import __version__, whole
from twin.errors import DataError, TwinError


class Verb(NamedTuple):
    """Where a verb lives (a module with `add_arguments(parser)` and `run(args) -> int`), what it does, and
    how it is typed."""

    module: str
    help: str
    example: str


VERBS: dict[str, Verb] = {
    "run": Verb(
        "twin.commands.run",
        "the service: Zenoh in, Zenoh out, MCAP log",
        "twin run --config /etc/shiptwin/twin.toml",
    ),
    "replay": Verb(
        "twin.commands.replay",
        "a recorded voyage through the same loop",
        "twin replay logs/voyage.mcap -o again.mcap",
    ),
    "view": Verb(
        "twin.commands.view",
        "the twin for the bridge, in a browser or in the terminal",
        "twin view --connect tcp/127.0.0.1:7447",
    ),
    "studio": Verb(
        "twin.commands.studio",
        "the workbench in a browser: data, compare, diagnose, add",
        "twin studio voyages --demo",
    ),
    "init": Verb(
        "twin.commands.init",
        "a first model of my ship from what its owner knows",
        "twin init 'MV Alma' --length-pp-m 180 --beam-m 30 --draught-m 10.5 -o alma.toml",
    ),
    "import": Verb(
        "twin.commands.import_",
        "measurements in, checked",
        "twin import log.csv --map log-map.toml -o voyage.mcap",
    ),
    "instruments": Verb(
        "twin.commands.instruments",
        "what is wrong with the instruments, by how their readings go together",
        "twin instruments circle.mcap --ship alma.toml -o alma2.toml",
    ),
    "calibrate": Verb(
        "twin.commands.calibrate",
        "fits the core to reference voyages",
        "twin calibrate calm.mcap --ship alma.toml -o alma2.toml",
    ),
    "tube": Verb(
        "twin.commands.tube",
        "how far predictions on board may be off, from voyages that the model has not seen",
        "twin tube june*.mcap --ship alma2.toml -o alma3.toml",
    ),
    "compare": Verb(
        "twin.commands.compare",
        "model against measurement: how wrong, and where",
        "twin compare v.mcap --ship alma2.toml",
    ),
    "diagnose": Verb(
        "twin.commands.diagnose",
        "which physical effect is missing",
        "twin diagnose v.mcap --ship alma2.toml --reference calm.mcap",
    ),
    "fleet": Verb(
        "twin.commands.fleet",
        "many ships and voyages, one table ranked by what is wrong",
        "twin fleet fleet.toml -o results/",
    ),
    "add": Verb(
        "twin.commands.add",
        "adds an effect, fits it, proves the fall on held-out voyages",
        "twin add Wind --ship alma2.toml --voyage v.mcap --held-out w.mcap -o alma3.toml",
    ),
    "remove": Verb(
        "twin.commands.remove",
        "takes an effect out again",
        "twin remove Wind --ship alma3.toml -o alma4.toml",
    ),
    "history": Verb(
        "twin.commands.history",
        "the ladder of what was added and how far the error fell",
        "twin history alma3.toml",
    ),
    "effects": Verb(
        "twin.commands.effects",
        "the catalogue: formula, inputs, parameters, units, source",
        "twin effects Wind",
    ),
    "train": Verb(
        "export.train",
        "trains and exports the residual",
        "twin train v*.mcap --ship alma3.toml -o residual.onnx",
    ),
    "demo": Verb(
        "twin.commands.demo", "the whole story on a bundled voyage, in a minute or two", "twin demo"
    ),
    "fault": Verb(
        "twin.commands.fault",
        "makes a fault on purpose, in a log or on a live bus",
        "twin fault rudder stuck --log voyage.mcap -o faulty.mcap",
    ),
    "health": Verb("twin.commands.health", "is the twin on this machine alive and well?", "twin health"),
}


# package -> the extra that brings it
EXTRAS = {"scipy": "study", "torch": "train", "onnx": "train", "pyarrow": "fleet"}
ASIDE = ("export", "bench")  # packages of the source folder that an installation may lack


def main(argv: Sequence[str] | None = None) -> int:
    """Run one verb; a problem is one line on standard error and an exit code (see twin/errors.py)."""
    # before numpy loads: on matrices of a hundred rows threads wait for each other
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    return guarded(lambda: _verb(sys.argv[1:] if argv is None else list(argv)))


def _verb(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="twin", description="A digital twin of a ship's motion that its owner can correct."
    )
    parser.add_argument("--version", action="version", version=f"shiptwin {__version__}")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    for name, verb in VERBS.items():
        sub = verbs.add_parser(
            name,
            help=verb.help,
            description=verb.help,
            epilog=f"example: {verb.example}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name in argv[:1]:
            _module(name).add_arguments(sub)
    args = parser.parse_args(argv)
    args.typed = argv
    whole.promised(args)
    return _module(args.verb).run(args)  # type: ignore[no-any-return]


def _module(verb: str) -> Any:
    """The verb's module, or a word on what must be installed."""
    try:
        return importlib.import_module(VERBS[verb].module)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package in EXTRAS:
            raise TwinError(
                f"`twin {verb}` needs the package {package}. Run: pip install 'shiptwin[{EXTRAS[package]}]'"
            ) from None
        if package in ASIDE or error.name == VERBS[verb].module:
            raise TwinError(
                f"`twin {verb}` is not in this installation ({error.name}). Run it in the source folder."
            ) from None
        raise


def guarded(action: Callable[[], int | None]) -> int:
    """Call it, and turn what went wrong into one line and an exit code."""
    try:
        return action() or 0
    except TwinError as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        if error.filename is None:
            raise
        said = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
        print(f"{DataError.__name__}: {error.filename}: {said}. Check the path.", file=sys.stderr)
        return DataError.exit_code


if __name__ == "__main__":
    sys.exit(main())
