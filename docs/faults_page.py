"""docs/faults.md, made of docs/faults.toml:  python docs/faults_page.py

With --take-in first puts every test that bears a fault's name (test_I5_...) into the table, and takes away
those that are gone."""

import json
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parent
GROUPS = {
    "I": "Inputs",
    "M": "Model",
    "C": "Computer",
    "S": "Storage",
    "N": "Network",
    "F": "Settings",
    "Q": "Security",
    "R": "What broke it in November 2026",
}
HEAD = """# Faults, and what the twin then does

Made of `docs/faults.toml`. Each is injected by the tests beside it (`pytest -k NAME`); in every case the
process lives or is started again, nothing that is not finite is said, and the rate is kept. "Said within"
counts from the fault to the first word of it.

`twin fault` makes them on purpose. In a copy of a log, then replayed:

```
twin fault rudder stuck --from 100 --for 60 --log voyage.mcap -o faulty.mcap
twin replay faulty.mcap
```

On a live bus, between the sensors and a running twin (the sensors connect to `--listen`, the twin listens at
`--connect`), and in the twin's process:

```
twin fault heading off --listen tcp/127.0.0.1:7448 --connect tcp/127.0.0.1:7447
twin fault pause --pid PID --for 4
twin fault disk --pid PID --for 30
```

A channel is `off`, `stuck`, `garbage`, `wrong`, `slow`, `delayed`, `intermittent` (PX4's words), or it drifts
(`drift`) or is noisy (`noise`); `clock` is every source's clock off by `--by` seconds, `bus` is everybody
unheard. `twin fault --help` says what `--by` means.
"""


def table() -> dict[str, dict[str, Any]]:
    """The faults by id, in the file's order."""
    return tomllib.loads((DOCS / "faults.toml").read_text())


def page(faults: dict[str, dict[str, Any]]) -> str:
    """The whole page."""
    lines, group = [HEAD], ""
    for name, fault in faults.items():
        if name[0] != group:
            group = name[0]
            lines += [
                f"\n## {GROUPS[group]}\n",
                "| | fault | answer | said within | tests |",
                "|---|---|---|---|---|",
            ]
        tests = (
            ", ".join(f"`{re.sub('.*::', '', test)}`" for test in fault["tests"]) or f"open: {fault['open']}"
        )
        lines.append(f"| {name} | {fault['what']} | {fault['expected']} | {fault['alarm']} | {tests} |")
    return "\n".join(lines) + "\n"


def taken_in(faults: dict[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """The table with the tests that there are: those of the table that still exist, and those that bear a
    fault's name."""
    found = {}
    for path in sorted((DOCS.parent / "tests").rglob("test_*.py")):
        for test in re.findall(r"^def (test_\w+)\(", path.read_text(), re.M):
            borne = re.match(r"test_((?:[A-Z]\d+_)+)", test)
            found[f"{path.relative_to(DOCS.parent / 'tests')}::{test}"] = (
                borne[1].split("_")[:-1] if borne else []
            )
    for name, fault in faults.items():
        kept = [test for test in fault["tests"] if test in found]
        fault["tests"] = kept + [test for test, names in found.items() if name in names and test not in kept]
        if fault["tests"]:
            fault.pop("open", None)
        else:
            fault.setdefault("open", "no test any more")
    return faults


def text(faults: dict[str, dict[str, Any]]) -> str:
    """The table as it stands in its file, behind the comments at its beginning."""
    comments = [line for line in (DOCS / "faults.toml").read_text().splitlines() if line.startswith("#")]
    lines = [*comments, ""]
    for name, fault in faults.items():
        lines.append(f"[{name}]")
        lines += [
            f"{key} = {json.dumps(fault[key], ensure_ascii=False)}"
            for key in ("what", "expected", "alarm", "open")
            if key in fault
        ]
        lines += (
            ["tests = [", *(f'    "{test}",' for test in fault["tests"]), "]", ""]
            if fault["tests"]
            else ["tests = []", ""]
        )
    return "\n".join(lines)


if __name__ == "__main__":
    if "--take-in" in sys.argv:
        (DOCS / "faults.toml").write_text(text(taken_in(table())))
    (DOCS / "faults.md").write_text(page(table()))
