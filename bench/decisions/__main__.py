"""A fixed set of voyages with a known truth, and what `twin diagnose` answers on each: `python -m
bench.decisions FOLDER`.

Ships are calibrated once and kept in FOLDER with the searches, so that a change of the decision alone is
asked again in seconds (`--decide`). Voyages: the reference sea on three hulls, the bundled ones, and folders
of others (`--others`: reference_*.csv, voyage_*.csv, ship.json with particulars, truth.json with
`expected_verdict`, `acceptable`), and a tanker's model in a pond (`--esso`)."""

import argparse
import json
import pickle
import re
import sys
import time
from pathlib import Path
from typing import Any

from bench.decisions.question import KnownCase
from bench.decisions.questions import known_cases
from twin import whole
from twin.study.diagnosis import effect_diagnosis
from twin.study.diagnosis.answer import SearchAnswer
from twin.study.diagnosis.consider import consider
from twin.study.diagnosis.decision import decide
from twin.study.diagnosis.verdict import weights

WEATHER = ("Wind", "WaveDrift", "Current", "VaryingCurrent", "ShallowWater", "Bank")
OUTSIDE = ("IceLike", "PassingShip", "RudderBacklash", "Sloshing", "Squall")


def right(truth: dict[str, Any], answer: dict[str, Any]) -> bool:
    """Whether an answer is what the truth allows: names what is there and nothing else, or says that it
    cannot tell what."""
    named = set(answer["missing"])
    if "hidden" not in truth:
        there = {e["effect"] for e in truth["effects"] if e["effect"] != "outside"}
        return (
            there <= named and named - there <= set(WEATHER)
            if there
            else answer["verdict"] in truth["expected_verdict"]
        )
    hidden = {n for n in truth["hidden"] if n != truth.get("knows")}
    if truth.get("manoeuvre") == "straight":
        return answer["verdict"] == "undecided"
    if hidden & set(OUTSIDE):
        return not named and answer["verdict"] in ("unknown", "undecided")
    wanted = hidden - set(WEATHER)
    if not wanted:
        return named <= hidden and (answer["verdict"] == "nothing_missing" or bool(named))
    return wanted <= named <= hidden


def kept_answer(folder: Path, question: KnownCase, tag: str, again: bool) -> dict[str, Any]:
    """The answer, with what the search found kept beside it for a decision that is asked again."""
    path = folder / tag / _file(question, "json")
    if path.exists() and not again:
        return json.loads(path.read_text())
    store = folder / "searched" / tag / _file(question, "pickle")
    first_answer = effect_diagnosis.answer
    wall, cpu = time.perf_counter(), time.process_time()
    ship, voyages = question.get()
    ready, work = time.perf_counter(), time.process_time()

    def keeping(*asked: Any) -> SearchAnswer:
        out = first_answer(*asked)
        store.parent.mkdir(parents=True, exist_ok=True)
        store.write_bytes(pickle.dumps((out.case, (out.weighed, out.found, out.seen))))
        return out

    effect_diagnosis.answer = keeping
    try:
        answer = effect_diagnosis.diagnose(voyages, ship).result
    finally:
        effect_diagnosis.answer = first_answer
    path.parent.mkdir(parents=True, exist_ok=True)
    answer |= {
        "truth": question.truth,
        "seconds": time.perf_counter() - ready,
        "cpu_s": time.process_time() - work,
    }
    whole.write_json(answer, str(path))
    print(
        f"{question.name}: made ready in {ready - wall:.0f} s ({work - cpu:.0f} s of processor)",
        file=sys.stderr,
        flush=True,
    )
    return answer


def decided(folder: Path, question: KnownCase, tag: str) -> dict[str, Any]:
    """The facts and the decision again, of what a search of this tag found."""
    case, (weighed, found, seen) = pickle.loads(
        (folder / "searched" / tag / _file(question, "pickle")).read_bytes()
    )
    facts = consider(case, weighed, found, seen, weights(case, weighed, found)).facts
    answer = decide(facts)
    return {
        "truth": question.truth,
        "verdict": answer.verdict,
        "reason": answer.reason,
        "missing": answer.missing,
        "facts": facts.as_json(),
    }


def _file(question: KnownCase, kind: str) -> str:
    return re.sub(r"[^A-Za-z0-9.]+", "_", question.name) + "." + kind


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--others", type=Path, metavar="DIR")
    parser.add_argument("--esso", type=Path, metavar="DIR", help="runs of FRT-DS-ESSO")
    parser.add_argument("--tag", default="now", help="where in FOLDER these answers are kept")
    parser.add_argument("--only", default="", help="questions whose names match")
    parser.add_argument("--before", default="old", help="with --decide: the tag of answers to write beside")
    parser.add_argument("--again", action="store_true")
    parser.add_argument(
        "--decide",
        metavar="FILE.json",
        type=Path,
        help="only decide again, from the searches of this tag; write all facts here",
    )
    args = parser.parse_args()
    rows = {}
    for question in known_cases(args.folder, args.others, args.esso):
        if re.search(args.only, question.name):
            if args.decide:
                if (args.folder / "searched" / args.tag / _file(question, "pickle")).exists():
                    rows[question.name] = row = decided(args.folder, question, args.tag)
                    before = args.folder / args.before / _file(question, "json")
                    if before.exists():
                        row["before"] = {
                            k: v
                            for k, v in json.loads(before.read_text()).items()
                            if k in ("verdict", "missing")
                        }
                    print(row["verdict"], row["missing"], row["reason"], question.name, flush=True)
                continue
            try:
                a = kept_answer(args.folder, question, args.tag, args.again)
            except Exception as error:
                print(f"{question.name}: {type(error).__name__}: {error}", flush=True)
                continue
            mark = "right" if right(question.truth, a) else "WRONG"
            print(f"{mark} {question.name}: {a['verdict']} {a['missing']} {a['cpu_s']:.0f} s", flush=True)
    if args.decide:
        whole.write_json(rows, str(args.decide))
    return 0


if __name__ == "__main__":
    sys.exit(main())
