"""The fleet on the terminal: a table with most wrong first, what could not be asked, and what so many tests
can show."""

from collections.abc import Mapping, Sequence
from typing import Any

from twin.num import as_given, num, percent, readable
from twin.study.fleet.over_months import of_a_lasting_fault

HEADS = ("", "ship", "verdict", "since", "size (95 %)", "trend (95 %)", "of the error", "over the months")
STATES = {"nothing_missing": "nothing missing", "not_asked": "not judged"}
WIDEST = 44
FAILED = 10  # lines of voyages that could not be asked


def terminal_lines(result: Mapping[str, Any]) -> list[str]:
    """The lines of `twin fleet`."""
    v = result["voyages"]
    count = len(result["ships"])
    head = f"{count} ship{'s' * (count > 1)}, {v['listed']} voyages: {v['judged']} judged"
    head += f", {v['references']} calibrated on" * bool(v["references"])
    head += f", {v['failed']} not" * bool(v["failed"])
    rows = [row for ship in result["ships"] for row in _rows(ship)]
    return [head, "", *table([HEADS, *rows]), *_failed(result), "", *months(result)]


def table(rows: Sequence[Sequence[str]]) -> list[str]:
    """Columns as wide as their longest cell."""
    wide = [max(len(r[i]) for r in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(w) for cell, w in zip(r, wide, strict=True)).rstrip() for r in rows]


def _rows(ship: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """A line a cause, or one line."""
    first = (str(ship["rank"]), ship["ship"])
    shown = chance(ship["over_months"])
    if not ship["causes"]:
        since = day(ship["since"]) if ship["since"] else ""
        return [(*first, STATES.get(ship["state"], ship["state"]), since, "", "", "", shown)]
    return [
        (
            *(first if i == 0 else ("", "")),
            c["effect"] + " (weather)" * (c["belongs_to"] == "voyage"),
            day(c["since"]),
            size(c["number"]),
            slope(c),
            "" if c["share_of_error"] is None else percent(c["share_of_error"]),
            shown if i == 0 else "",
        )
        for i, c in enumerate(ship["causes"])
    ]


def day(voyage: Mapping[str, Any]) -> str:
    """When a voyage began, or its name where its file does not say."""
    stamp = voyage.get("start_time_utc")
    return stamp[:10] if stamp else str(voyage["voyage"])[:WIDEST]


def size(p: Mapping[str, Any] | None) -> str:
    """A number with its interval and unit."""
    if not p:
        return ""
    p = readable(p)
    unit = f" {p['unit']}".rstrip()
    end = ", at the end of its box" * bool(p["at_box_end"])
    return f"{p['name']} {num(p['value'])}{unit} ({num(p['low95'])} to {num(p['high95'])}{end})"


def slope(cause: Mapping[str, Any]) -> str:
    """Where a size goes; the interval says whether it goes anywhere."""
    if not cause["trend"]:
        return "(three voyages make one)" * (len(cause["sizes"]) < 3)
    t = readable(cause["trend"] | {"unit": cause["number"]["unit"]})
    slope, low, high = (num(t[key], sign=True) for key in ("slope", "low95", "high95"))
    return f"{slope} a {t['per']} ({low} to {high})"


def chance(m: Mapping[str, Any]) -> str:
    """A ship's M as the chance of it in health."""
    if not m["references"]:
        return "no scores of references"
    if not m["voyages"]:
        return ""
    return ("ALARM, " if m["alarm"] else "") + f"M {num(m['value'])}"


def months(result: Mapping[str, Any]) -> list[str]:
    """What controls false alarms over many voyages and ships, and what the references can never show."""
    control, ships = result["over_months"], result["ships"]
    if not control["ships"]:
        return [
            "Over the months: not controlled, since no ship file has the scores of its reference voyages. "
            "Calibrate anew."
        ]
    needed, few = control["needed"], dict[int, list[str]]()
    for s in ships:
        if (m := s["over_months"])["references"] and m["typical_ever"] < needed:
            few.setdefault(m["references"], []).append(s["ship"])
    return [
        "Over the months: M is a test martingale of a ship's voyages against its reference voyages (Ville); "
        "on a healthy ship it ever reaches 20 with a chance of 5 % at most. Alarms by e-BH: at most "
        f"{as_given(100.0 * control['level'])} % of them are of healthy ships, in the mean; a ship alone "
        f"among {control['ships']} needs M = {num(needed, 3)}.",
        *(_never(count, names, needed) for count, names in sorted(few.items())),
    ]


def _never(count: int, names: Sequence[str], needed: float) -> str:
    """What so many references can never show."""
    enough = next(n for n in range(count, 10**6) if of_a_lasting_fault(n, 3 * n + 3) >= needed)
    most = of_a_lasting_fault(count, 3 * count + 3)
    return (
        f"  {', '.join(names)}: by {count} reference voyages a fault that stays as it is typically shows M = "
        f"{num(most)}, however many voyages follow, and alone is no alarm ({enough} references would do); "
        "one that grows may be."
    )


def _failed(result: Mapping[str, Any]) -> list[str]:
    lines = [f"{s['ship']}: {v['failed']}" for s in result["ships"] for v in s["voyages"] if v["failed"]]
    more = [f"and {len(lines) - FAILED} more"] if len(lines) > FAILED else []
    return ["", "not judged:", *(f"  {line}" for line in [*lines[:FAILED], *more])] if lines else []
