"""The fleet as one table: the ship with most wrong first."""

from collections.abc import Mapping, Sequence
from typing import Any

from twin.study.fleet.ask import Row
from twin.study.fleet.listing import FleetShip
from twin.study.fleet.over_months import LEVEL, Martingale, alarms, evidence, of_a_lasting_fault
from twin.study.fleet.trend import causes_of, dated, voyages_of

SCHEMA_VERSION = 1
ORDER = ("missing", "weather", "unknown", "undecided", "nothing_missing", "not_asked")  # most wrong first


def ranked(fleet: Sequence[tuple[FleetShip, Sequence[Sequence[Row]]]]) -> dict[str, Any]:
    """The JSON of `twin fleet`, of ships with the rows of each of their voyages.

    Ships on which a cause of ship or instruments is named stand first, by the share of the error that goes
    with it; then those on which only water and weather are named, unknown, undecided, nothing missing, and
    none that could be judged.
    """
    ships = [_ship(ship, asked) for ship, asked in fleet]
    known = {s["ship"]: s.pop("_evidence") for s in ships}
    tested = {name: e for name, e in known.items() if e.voyages and e.references}
    found = alarms(tested)
    for s in ships:
        s["over_months"] = _over_months(known[s["ship"]], s["ship"] in found)
    ships.sort(key=lambda s: (ORDER.index(s["state"]), -_share(s), s["ship"]))
    return {
        "schema_version": SCHEMA_VERSION,
        "ships": [{"rank": i, **s} for i, s in enumerate(ships, 1)],
        "counts": {state: sum(s["state"] == state for s in ships) for state in ORDER},
        "voyages": {
            "listed": sum(len(s["voyages"]) for s in ships),
            "judged": sum(v["verdict"] not in (None, "reference") for s in ships for v in s["voyages"]),
            "references": sum(v["verdict"] == "reference" for s in ships for v in s["voyages"]),
            "failed": sum(bool(v["failed"]) for s in ships for v in s["voyages"]),
        },
        "over_months": {"level": LEVEL, "ships": len(tested), "needed": len(tested) / LEVEL, "alarms": found},
    }


def _ship(ship: FleetShip, asked: Sequence[Sequence[Row]]) -> dict[str, Any]:
    files = [(str(v.path), v.tags) for v in ship.voyages]
    voyages = voyages_of([(*f, rows) for f, rows in zip(files, asked, strict=True)])
    judged = [v for v in voyages if v["verdict"] not in (None, "reference")]
    causes, latest = causes_of(voyages), judged[-1] if judged else {}
    healthy = ship.ship.notes["structural"].get("left_out_scores", [])
    same = next((i for i, v in enumerate(judged[::-1]) if v["verdict"] != latest["verdict"]), len(judged))
    return {
        "ship": ship.name,
        "file": str(ship.file),
        "state": _state(latest, causes),
        "verdict": latest.get("verdict"),
        "reason": latest.get("reason"),
        "sentence": latest.get("sentence"),
        "latest": dated(latest) if latest else None,
        "since": dated(judged[-same]) if latest else None,
        "causes": sorted(causes, key=lambda c: -(c["share_of_error"] or 0.0)),
        "voyages": voyages,
        "_evidence": evidence(healthy, [v["score"] for v in judged if v["score"] is not None]),
    }


def _state(latest: Mapping[str, Any], causes: Sequence[Mapping[str, Any]]) -> str:
    if not latest:
        return "not_asked"
    if causes and all(c["belongs_to"] == "voyage" for c in causes):
        return "weather"
    return str(latest["verdict"])


def _share(ship: Mapping[str, Any]) -> float:
    return max((c["share_of_error"] or 0.0 for c in ship["causes"]), default=0.0)


def _over_months(e: Martingale, alarm: bool) -> dict[str, Any]:
    return e._asdict() | {
        "alarm": alarm,
        "typical_now": of_a_lasting_fault(e.references, e.voyages),
        "typical_ever": of_a_lasting_fault(e.references, 3 * e.references + 3),
    }
