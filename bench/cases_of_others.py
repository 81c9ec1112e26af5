"""Ships of others with a known truth: what diagnose says of each, and whether add accepts the right name.

A folder of folders, each with ship.json (particulars for `twin init`), reference_*.csv, voyage_*.csv,
heldout_*.csv and truth.json ({"effects":
[{"effect": NAME or "outside"}], "acceptable": [[name]], "expected_verdict": [...]}). Every step is a verb of
    the command line, and what it wrote is
kept: a run that was cut off goes on where it was, and cases of one ship share its calibration.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from twin.errors import DataError

ENV = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", help="where the cases lie")
    parser.add_argument("--work", default=".cases", help="where ship files and answers are kept")
    parser.add_argument("--only", metavar="CASE", nargs="+", help="some of them")
    parser.add_argument("--no-diagnose", action="store_true", help="only calibrate, and add the right name")
    parser.add_argument("--json", metavar="FILE", help="the table as JSON ('-': standard output)")
    parser.add_argument("--page", metavar="FILE.md", help="the table as a page")


def run(args: argparse.Namespace) -> int:
    folder, work = Path(args.folder), Path(args.work)
    work.mkdir(parents=True, exist_ok=True)
    cases = [
        p.parent for p in sorted(folder.glob("*/truth.json")) if not args.only or p.parent.name in args.only
    ]
    if not cases:
        raise DataError(f"{folder}: no folder with a truth.json in it. Give the folder that holds the cases.")
    rows = [_row(case, work, not args.no_diagnose) for case in cases]
    page = sys.stderr if args.json == "-" else sys.stdout
    print(table(rows), file=page)
    if args.page:
        Path(args.page).write_text(table(rows))
    if args.json:
        text = json.dumps({"schema_version": 1, "cases": rows}, indent=1)
        sys.stdout.write(text) if args.json == "-" else Path(args.json).write_text(text)
    return 0


def _row(case: Path, work: Path, diagnosed: bool) -> dict[str, Any]:
    """One case: the verdict, and what add made of what is really missing."""
    truth = json.loads((case / "truth.json").read_text())
    hidden = [e["effect"] for e in truth["effects"] if e["effect"] != "outside"]
    row: dict[str, Any] = {
        "case": case.name,
        "hidden": hidden or ["something else" if truth["effects"] else "nothing"],
    }
    ship = _calibrated(case, work)
    if diagnosed:
        said = _kept(
            work / f"{case.name}.diagnose.json", ["diagnose", *_files(case, "voyage"), "--ship", str(ship)]
        )
        row |= {"verdict": said.get("verdict", "failed"), "missing": said.get("missing", [])}
    lasting = [n for n in hidden if n not in ("Current", "VaryingCurrent", "ExternalForce", "TowForce")]
    if lasting:
        words = [
            "add",
            *lasting,
            "--ship",
            str(ship),
            "--voyage",
            *_files(case, "voyage"),
            "--held-out",
            *_files(case, "heldout"),
        ]
        made = _kept(work / f"{case.name}.add.json", [*words, "-o", str(work / f"{case.name}.toml")])
        row["added"] = lasting
        if "proof" in made:
            last = made["horizons"][-1]
            row |= {
                "accepted": made["accepted"],
                "ratio": [made["proof"][k] for k in ("log_likelihood_ratio", "low95", "high95")],
                "before": last["before"],
                "after": last["after"],
                "usual": last["noise_floor"],
                "horizon_s": last["horizon_s"],
            }
        else:
            row |= {
                "accepted": made.get("accepted", False),
                "why": made.get("failed", made.get("verdict", "")),
            }
    return row


def _files(case: Path, kind: str) -> list[str]:
    return [str(p) for p in sorted(case.glob(f"{kind}_*.csv"))]


def _calibrated(case: Path, work: Path) -> Path:
    """The ship's file, made once for all cases with these particulars and reference voyages."""
    facts, references = json.loads((case / "ship.json").read_text()), _files(case, "reference")
    seen = hashlib.sha256(json.dumps(facts, sort_keys=True).encode())
    for path in references:
        seen.update(Path(path).read_bytes())
    out = work / f"{seen.hexdigest()[:12]}.toml"
    if not out.exists():
        name, start = facts.pop("name"), out.with_suffix(".init.toml")
        options = [
            word for key, value in facts.items() for word in (f"--{key.replace('_', '-')}", str(value))
        ]
        _twin(["init", name, *options, "-o", str(start)])
        code, said = _twin(["calibrate", *references, "--ship", str(start), "-o", str(out)])
        if code:
            raise DataError(f"{case.name}: not calibrated: {said.splitlines()[-1] if said else code}")
    return out


def _kept(path: Path, words: list[str]) -> dict[str, Any]:
    """The JSON of a verb, from the last run if there was one."""
    if not path.exists():
        code, said = _twin([*words, "--json", str(path)])
        if not path.exists():
            path.write_text(
                json.dumps({"failed": said.strip().splitlines()[-1] if said.strip() else f"exit code {code}"})
            )
    found: dict[str, Any] = json.loads(path.read_text())
    return found


def _twin(words: list[str]) -> tuple[int, str]:
    """A verb of the command line: its exit code and what it said on standard error."""
    print(f"twin {' '.join(words)[:140]}", file=sys.stderr, flush=True)
    done = subprocess.run(
        [sys.executable, "-m", "twin.cli", *words], env=os.environ | ENV, text=True, capture_output=True
    )
    return done.returncode, done.stderr


def table(rows: list[dict[str, Any]]) -> str:
    """The cases as a table, and how many right names were accepted."""
    head = [
        "case",
        "hidden",
        "diagnose",
        "add accepts",
        "log likelihood ratio (95 %)",
        "position [m]",
        "heading [deg]",
        "usual",
    ]
    out = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    for r in rows:
        said = f"{r['verdict']} {', '.join(r['missing'])}".strip() if "verdict" in r else ""
        yes = "" if "added" not in r else "yes" if r["accepted"] else "no"
        cells = [r["case"], ", ".join(r["hidden"]), said, yes]
        if "ratio" in r:
            b, a, u, ratio = r["before"], r["after"], r["usual"], r["ratio"]
            cells += [
                f"{ratio[0]:+.3g} ({ratio[1]:.3g} to {ratio[2]:.3g})",
                f"{b['position_mae_m']:.3g} to {a['position_mae_m']:.3g}",
                f"{b['heading_mae_deg']:.2g} to {a['heading_mae_deg']:.2g}",
                f"{u['position_mae_m']:.2g} m, {u['heading_mae_deg']:.2g} deg",
            ]
        else:
            cells += [str(r.get("why", ""))[:60], "", "", ""]
        out.append(f"| {' | '.join(cells)} |")
    asked = [r for r in rows if "added" in r]
    out += ["", f"right names accepted: {sum(bool(r['accepted']) for r in asked)} of {len(asked)}"]
    return "\n".join(out) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    add_arguments(parser)
    sys.exit(run(parser.parse_args()))


if __name__ == "__main__":
    main()
