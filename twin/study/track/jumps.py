"""Where a receiver jumped, as the verbs tell it (outliers.py finds it)."""

from collections.abc import Sequence
from typing import Any

from twin.num import as_given
from twin.study.track.track import Track


def jumps_on(tracks: Sequence[Track]) -> list[dict[str, Any]]:
    """The stretches of voyages whose readings do not count."""
    return [
        {"voyage": t.name, "start_s": start, "end_s": end, "readings": list(readings)}
        for t in tracks
        for start, end, readings in t.jumps
    ]


def jumps_in_words(jumps: Sequence[dict[str, Any]]) -> list[str]:
    """The same in words, a line for each voyage."""
    out = []
    for name in dict.fromkeys(j["voyage"] for j in jumps):
        when = ", ".join(_when(j) for j in jumps if j["voyage"] == name)
        out.append(
            f"On {name} these readings do not count, for no force that acts on this ship is great enough for "
            f"the motion that they show: {when}."
        )
    return out


def _when(jump: dict[str, Any]) -> str:
    start, end = (as_given(round(jump[key])) for key in ("start_s", "end_s"))
    return f"{start} to {end} s ({' and '.join(jump['readings'])})"
