"""`twin.fleet`: many ships and their voyages, ranked by what is wrong."""

from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

from twin.api.result import PathLike, Progress, Result, quietly
from twin.errors import DataError, TwinError, UsageError
from twin.recording.jsonable import plain
from twin.study.fleet.fleet_lines import months, terminal_lines
from twin.study.fleet.fleet_run import run
from twin.study.fleet.listing import read_fleet
from twin.study.fleet.ranking import ranked
from twin.study.fleet.row_store import Store


@dataclass(frozen=True, repr=False)
class Fleet(Result):
    """The ships of a fleet, the one with most wrong first. Its rows are the ships; a row a cause and a voyage
    with all facts is in `rows.parquet`."""

    @property
    def ships(self) -> list[str]:
        """Their names, most wrong first."""
        return [str(s["ship"]) for s in self.data["ships"]]

    @property
    def alarms(self) -> list[str]:
        """Ships whose voyages together are no chance: of these at most the share `level` is in health, in
        the mean."""
        return list(self.data["over_months"]["alarms"])

    def causes(self, ship: str) -> list[str]:
        """What is named on a ship's latest voyage, by its share of the error; KeyError for no such ship."""
        of = {s["ship"]: s["causes"] for s in self.data["ships"]}
        return [str(c["effect"]) for c in of[ship]]

    def text(self) -> list[str]:
        """The lines of `twin fleet`."""
        return terminal_lines(self.data)

    def _rows(self) -> Any:
        keys = ("rank", "ship", "file", "state", "verdict", "sentence", "over_months")
        return [
            {k: s[k] for k in keys} | {"causes": self.causes(s["ship"]), "voyages": len(s["voyages"])}
            for s in self.data["ships"]
        ]

    def __repr__(self) -> str:
        first = self.data["ships"][0]
        wrong = ", ".join(self.causes(first["ship"])) or first["state"].replace("_", " ")
        count = sum(bool(s["causes"]) for s in self.data["ships"])
        return (
            f"<Fleet of {len(self.ships)} ships, a cause is named on {count}; first {first['ship']!r}: "
            f"{wrong}>"
        )

    def page(self) -> str:
        """The page of `twin fleet --report`."""
        from twin.report.page import FLEET, html

        result = self.to_dict() | {"months": months(self.data)}
        return html({"kind": "fleet", "title": "Fleet", "result": result}, FLEET)


def fleet(
    listed: PathLike,
    output: PathLike,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> Fleet:
    """Compare and diagnose every voyage of every ship of a list (docs/fleet.md), or of a folder with a folder
    for each ship.

    `output`: the folder of `rows.parquet`; what stands there and still holds is not asked again. `workers`:
    processes of this computer, 1: this one; `scheduler`: address of a dask scheduler in their place, whose
    workers see the same files. UsageError: `workers` is less than 1; TwinError: more processes need the extra
    `fleet`; SettingsError: the list is not valid, a ship was never calibrated, a name
    stands twice; DataError: no voyage could be used. What is wrong with one voyage stands in its row. Some
    twenty seconds a voyage and processor.
    """
    if workers < 1:
        raise UsageError(f"workers = {workers}: at least 1 is needed.")
    if (scheduler or workers > 1) and find_spec("distributed") is None:
        raise TwinError(
            "more than one worker needs the package distributed. Run: pip install 'shiptwin[fleet]'"
        )
    ships = read_fleet(listed)
    asked = run(ships, Store(output), workers, scheduler, quietly(progress))
    made = Fleet(data=plain(ranked(asked.answers) | {"asked_now": asked.fresh}))
    if all(v["failed"] for s in made.data["ships"] for v in s["voyages"]):
        first = made.data["ships"][0]["voyages"][0]["failed"]
        raise DataError(f"{listed}: not one voyage could be used; the first: {first}")
    return made
