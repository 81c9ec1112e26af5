"""The fleet asked: what is not known yet is spread over processes, and every answer is kept as it comes."""

from collections.abc import Sequence
from dataclasses import dataclass

from twin.recording.progress import Progress
from twin.study.fleet.ask import Job, Row, ask, failed, job_of, key_of
from twin.study.fleet.listing import FleetShip
from twin.study.fleet.row_store import Store, lasting
from twin.study.fleet.spread import spread

Answers = list[tuple[FleetShip, list[list[Row]]]]


@dataclass(frozen=True)
class FleetRows:
    """Rows of each voyage of each ship, and how many of the voyages were asked now."""

    answers: Answers
    fresh: int


def run(
    ships: Sequence[FleetShip],
    store: Store,
    workers: int,
    scheduler: str | None,
    progress: Progress,
) -> FleetRows:
    """Ask what the store does not know, and give the rows of every voyage of the list."""
    jobs = [[job_of(ship, voyage) for voyage in ship.voyages] for ship in ships]
    twice = {job: why for of_ship in jobs for job, why in _twice(of_ship).items()}
    with store.alone():
        known = store.rows()
        once = {key_of(vars(j)): j for of_ship in jobs for j in of_ship if j not in twice}
        todo = [job for key, job in once.items() if not lasting(known.get(key, ()))]
        progress(f"{len(once) - len(todo)} of {len(once)} voyages are known, {len(todo)} are asked")
        for i, one in enumerate(spread(ask, todo, workers, scheduler), 1):
            rows = one.answer or [failed(one.job, one.why, one.kind)]
            store.add(rows)
            progress(f"{i} of {len(todo)}: {one.job.ship}, {rows[0]['voyage']}: {_word(rows)}")
    known = store.rows()
    of = lambda job: twice.get(job) or known.get(key_of(vars(job)), [])  # noqa: E731
    return FleetRows([(s, [of(j) for j in js]) for s, js in zip(ships, jobs, strict=True)], len(todo))


def _twice(jobs: Sequence[Job]) -> dict[Job, list[Row]]:
    """The voyages of a ship that are another one's copy, with the row that says so."""
    first: dict[str, Job] = {}
    found = {}
    for job in jobs:
        same = first.setdefault(job.voyage_sha256 or job.voyage_file, job)
        if same is not job:
            why = f"{job.voyage_file}: is the same voyage as {same.voyage_file}. Give each voyage once."
            found[job] = [failed(job, why, "DataError")]
    return found


def _word(rows: Sequence[Row]) -> str:
    named = ", ".join(r["effect"] for r in rows if r["named"])
    return named or rows[0]["failed"] or str(rows[0]["verdict"]).replace("_", " ")
