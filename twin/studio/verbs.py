"""What can be asked of a worker: one row a verb, its keys, and the command line that does the same."""

import shlex
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from twin.errors import UsageError

Request = Mapping[str, Any]


class StudioVerb(NamedTuple):
    """`needs` and `may`: keys of what is asked (lists end in s); `typed`: the words of its command."""

    needs: tuple[str, ...]
    may: tuple[str, ...]
    typed: Callable[[Request], list[str]]


def _look(a: Request) -> list[str]:
    mapped = ["--map", a["map"]] if a.get("map") else []
    ship = ["--ship", a["ship"]] if a.get("ship") else []
    return ["import", a["file"], *mapped, *ship, "-o", a.get("output") or "VOYAGE.mcap"]


def _import(a: Request) -> list[str]:
    return _look(a) + [word for check in a.get("accept", []) for word in ("--accept", check)]


def _compare(a: Request) -> list[str]:
    return ["compare", *a["voyages"], "--ship", a["ship"]]


def _diagnose(a: Request) -> list[str]:
    return ["diagnose", *a["voyages"], "--ship", a["ship"], *_several("--reference", a.get("references"))]


def _calibrate(a: Request) -> list[str]:
    held = _several("--held-out", a.get("held_outs"))
    return ["calibrate", *a["voyages"], "--ship", a["ship"], *held, "-o", a["output"]]


def _add(a: Request) -> list[str]:
    voyages = _several("--voyage", a["voyages"]) + _several("--held-out", a.get("held_outs"))
    return ["add", *a["effects"], "--ship", a["ship"], *voyages, "-o", a["output"]] + ["--force"] * bool(
        a.get("force")
    )


def _several(option: str, names: Any) -> list[str]:
    return [option, *names] if names else []


VERBS: dict[str, StudioVerb] = {
    "look": StudioVerb(("file",), ("map", "ship"), _look),
    "import": StudioVerb(("file", "output"), ("map", "ship", "accept"), _import),
    "compare": StudioVerb(("ship", "voyages"), (), _compare),
    "diagnose": StudioVerb(("ship", "voyages"), ("references",), _diagnose),
    "calibrate": StudioVerb(("ship", "voyages", "output"), ("held_outs",), _calibrate),
    "add": StudioVerb(("ship", "voyages", "effects", "output"), ("held_outs", "force"), _add),
}
LISTS = ("voyages", "held_outs", "references", "effects", "accept")
READ = ("file", "map", "ship", "voyages", "held_outs", "references")  # names of files that must be there
MAX_NAMES = 200  # names in a list


def checked(asked: Any) -> dict[str, Any]:
    """What is asked, with nothing that its verb does not know; UsageError says what is wrong with it."""
    name = asked.get("verb") if isinstance(asked, Mapping) else None
    verb = VERBS.get(name) if isinstance(name, str) else None
    if verb is None:
        raise UsageError(f"a job names its verb: one of {', '.join(VERBS)}.")
    for key, value in asked.items():
        if key != "verb" and key not in (*verb.needs, *verb.may):
            raise UsageError(f"{asked['verb']}: {key!r} is nothing that it knows.")
        names = value if key in LISTS else [value]
        if key == "force":
            good = isinstance(value, bool)
        else:
            good = (
                isinstance(names, list) and len(names) <= MAX_NAMES and all(isinstance(n, str) for n in names)
            )
        if not good:
            raise UsageError(
                f"{asked['verb']}: {key} must be {'a list of names' if key in LISTS else 'a name'}."
            )
    for key in verb.needs:
        if not asked.get(key):
            raise UsageError(f"{asked['verb']} needs {key.replace('_', ' ')}: choose at least one.")
    return {key: value for key, value in asked.items() if value not in (None, "", [])}


def files_of(asked: Request) -> list[str]:
    """Names of the files that a job reads."""
    return [n for key in READ if key in asked for n in (asked[key] if key in LISTS else [asked[key]])]


def command_of(asked: Request) -> str:
    """The command line that does the same in the project's folder."""
    return shlex.join(["twin", *VERBS[asked["verb"]].typed(asked)])
