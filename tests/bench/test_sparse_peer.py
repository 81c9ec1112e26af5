"""The peer's answers beside the twin's, on rows by hand; pysindy itself is asked by `python -m bench.fleet peer`."""

from bench.fleet.sparse_peer import page


def row(key, name, missing, gains=True):
    return {
        "key": key,
        "kind": "single",
        "hidden": {name: 1.0},
        "missing": missing,
        "verdict": "missing" if missing else "undecided",
        "weather": [],
        "candidates": [],
        "oracle": {"without_m": 10.0, "with_m": 5.0 if gains else 9.9},
    }


def test_each_cause_and_all_together_have_a_line_with_both_marks():
    rows = [
        row("a-0-0", "TowForce", ["TowForce"]),
        row("a-0-1", "TowForce", []),
        row("a-0-2", "RudderWear", ["RudderWear"], gains=False),
    ]
    text = "\n".join(page(rows, {r["key"]: {"right": r["key"] == "a-0-1"} for r in rows}))
    tow, all_of_them = (
        next(x for x in text.splitlines() if x.startswith(f"| {n} |")) for n in ("TowForce", "all")
    )
    assert tow.count("1 of 2") == 4
    assert "2 of 3" in all_of_them.split("|")[2] and "1 of 3" in all_of_them.split("|")[3]
    assert "1 of 2" in all_of_them.split("|")[4]
