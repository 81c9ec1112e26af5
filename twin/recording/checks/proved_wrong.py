"""What is done with a voyage of which a check proves a sign, unit or frame wrong: nobody takes it, unless its
owner accepted the check (`meta["accepted"]`); one line says what is wrong and the ways out."""

from collections.abc import Collection, Sequence

from twin.errors import DataError
from twin.recording.checks.check_result import Check
from twin.recording.voyage import Voyage


def proved_wrong(voyage: Voyage, checks: Sequence[Check], accept: Collection[str] = ()) -> list[Check]:
    """The checks that prove a mistake and are accepted neither here nor when the voyage was read."""
    accepted = {*accept, *voyage.meta.get("accepted", ())}
    return [c for c in checks if c.unusable and c.name not in accepted]


def mistakes_in_words(wrong: Sequence[Check]) -> str:
    """What the checks prove, each by its name."""
    return " ".join(f"{c.name}: {c.text}" for c in wrong)


def accepting(wrong: Sequence[Check]) -> str:
    """What takes a file as it is, on the command line of `twin import`."""
    return " ".join(f"--accept {c.name}" for c in wrong)


def refusal(path: str, wrong: Sequence[Check], map_path: str | None = None) -> str:
    """Why `twin import` does not take a file, and the two ways out: one line."""
    mend = (
        f"Correct {map_path}"
        if map_path
        else f"Have a map proposed (twin import {path} --suggest-map -o map.toml), write that into a map "
        "where the proposed one lacks it, and give it with --map"
    )
    said, accept = mistakes_in_words(wrong), accepting(wrong)
    return f"{path}: not imported. {said} {mend}, or import it as it is with {accept}."


def refuse(voyage: Voyage, checks: Sequence[Check]) -> None:
    """DataError: a check proves a mistake of a voyage that is to be judged, and nobody accepted it."""
    wrong = proved_wrong(voyage, checks)
    if wrong:
        raise DataError(f"{voyage.name}: not judged. {mistakes_in_words(wrong)} {_ways_out(voyage, wrong)}")


def _ways_out(voyage: Voyage, wrong: Sequence[Check]) -> str:
    """What to do with a voyage that was read already: its file read by a map, or accepted."""
    source = voyage.meta.get("source")
    if not source or source == voyage.name:
        names = ", ".join(repr(c.name) for c in wrong)
        return f"Correct the column; voyage.with_meta(accepted=[{names}]) takes it as it is."
    return (
        f"Write that into a map and import by it (twin import {source} --map MAP.toml -o VOYAGE.mcap; "
        f"--suggest-map proposes one), or import it as it is with {accepting(wrong)} (in Python: "
        "twin.read_voyage with map, or with accept)."
    )
