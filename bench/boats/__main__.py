"""python -m bench.boats -o boats.jsonl: the four craft of the reference sea, from a builder's sheet to a
calibrated ship and to what is wrong with one of their actuators. A line of JSON a result, written as it
comes; what the file holds already is not done again."""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from bench.boats.actuator_questions import FAULTY, QUESTIONS, calibrated, diagnosed
from bench.reference.boats import CRAFT


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m bench.boats", description=__doc__)
    parser.add_argument("-o", "--output", default="boats.jsonl", metavar="FILE")
    parser.add_argument("--craft", action="append", choices=list(CRAFT), help="only these (repeat)")
    parser.add_argument("--seed", action="append", type=int, help="of the voyages diagnosed (repeat)")
    args = parser.parse_args()
    path, names = Path(args.output), args.craft or list(CRAFT)
    done = _read(path)
    for name in names:
        if (name, "calibrate", 0) not in done:
            row, text = calibrated(name)
            ship_file(path, name).write_text(text)
            _add(path, row)
    for seed in args.seed or FAULTY:
        for i in range(max(len(a) for a in QUESTIONS.values())):
            for name in names:
                asked = QUESTIONS[name][i : i + 1]
                if asked and (name, asked[0][0], seed) not in done:
                    _add(path, diagnosed(name, asked[0], ship_file(path, name), seed))
    return 0


def ship_file(path: Path, name: str) -> Path:
    return path.with_name(f"{path.stem}-{name}.toml")


def _read(path: Path) -> set[tuple[str, str, int]]:
    lines = path.read_text().splitlines() if path.is_file() else []
    return {(row["craft"], row["what"], row.get("seed", 0)) for row in map(json.loads, lines)}


def _add(path: Path, row: dict[str, Any]) -> None:
    with open(path, "a") as out:
        out.write(json.dumps(row) + "\n")
    print(
        row["craft"],
        row["what"],
        row.get("seed", ""),
        row.get("verdict", row.get("errors")),
        file=sys.stderr,
        flush=True,
    )


if __name__ == "__main__":
    raise SystemExit(main())
