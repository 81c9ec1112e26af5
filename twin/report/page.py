"""The page: what a verb found, what it is drawn from, and the scripts that draw it, in one file."""

import json
import os
from collections.abc import Sequence
from importlib import resources
from typing import Any

from twin import whole
from twin.physics.model import Model
from twin.recording.voyage import Voyage
from twin.report.series import shown
from twin.report.words import sentence, title
from twin.study.estimation.start import waves_in_words, waves_on
from twin.study.prediction import locate, score
from twin.study.prediction.expected import with_expected_errors
from twin.study.prediction.openloop import HORIZONS_S
from twin.study.prediction.unexplained import energy
from twin.study.reference.sailed import switched_off
from twin.study.reference.structure import noise_model_of
from twin.study.track.jumps import jumps_in_words, jumps_on
from twin.study.track.track import Track

PLOTS = ("number.js", "dom.js", "plot.js", "keys.js", "track.js", "sections.js", "voyage.js")
SCRIPTS = (*PLOTS, "diagnosis.js", "main.js")
FLEET = ("number.js", "dom.js", "fleet.js")  # of many ships: a table, and a small plot of each


def write(
    path: str | os.PathLike[str],
    kind: str,
    result: dict[str, Any],
    tracks: Sequence[Track],
    model: Model,
    *,
    before: Model | None = None,
    voyages: Sequence[Voyage] = (),
) -> None:
    """Write the page of a verb (`compare`, `diagnose`, `add`), aside and renamed.

    `before`: the model without what was added. `voyages`: the recordings behind the tracks, in the same
        order; with them the
    page plots every sample instead of the grid's means.
    """
    whole.write(path, html(content(kind, result, tracks, model, before, voyages)), "--report")


def content(
    kind: str,
    result: dict[str, Any],
    tracks: Sequence[Track],
    model: Model,
    before: Model | None = None,
    voyages: Sequence[Voyage] = (),
) -> dict[str, Any]:
    """Everything the page shows, as JSON."""
    from twin.recording.jsonable import plain
    from twin.study.update.adding import ahead

    structural = noise_model_of(model.ship) is not None
    asked = [h["horizon_s"] for h in result.get("horizons", [])] or list(HORIZONS_S)
    windows = ahead(tracks, model, asked)
    result = _whole(dict(result), tracks, model, windows, asked, structural)
    longest = result["horizons"][-1]["horizon_s"] if result["horizons"] else asked[-1]
    models = {"before": before, "after": model} if before is not None else {"model": model}
    drawn = shown(tracks, windows, models, longest, structural, list(voyages) or [None] * len(tracks))
    return plain(
        {
            "kind": kind,
            "title": title(kind, result),
            "verdict": sentence(kind, result),
            "result": result,
            "voyages": drawn,
            "longest_s": longest,
        }
    )


def _whole(
    result: dict[str, Any],
    tracks: Sequence[Track],
    model: Model,
    windows: Sequence[Any],
    asked: Sequence[float],
    structural: bool,
) -> dict[str, Any]:
    """The result, with what the page shows of every verb worked out where it is absent."""
    rows = with_expected_errors(score.horizons(windows, asked, structural), windows, model.ship)
    result.setdefault("horizons", rows)
    if rows:
        longest, nearer = rows[-1]["horizon_s"], rows[max(len(rows) - 2, 0)]["horizon_s"]
        if "where" not in result:
            found = locate.regimes(windows, nearer, model.ship, structural)
            result["where"] = [{k: v for k, v in w.items() if k != "mask"} for w in found]
        result.setdefault("worst_windows", locate.worst(windows, longest))
    result.setdefault("channels", score.channels(windows, structural))
    if "unexplained_force" not in result:
        result["unexplained_force"] = energy(tracks, [model] * len(tracks)).unexplained()
    result.setdefault("switched_off", switched_off(model, tracks))
    result["told_of_waves"] = [*waves_in_words(waves_on(tracks)), *jumps_in_words(jumps_on(tracks))]
    return result


def html(content: dict[str, Any], scripts: Sequence[str] = SCRIPTS) -> str:
    """One file: template, style, scripts and data."""
    here = resources.files(__package__)
    data = (
        json.dumps(content, separators=(",", ":"), allow_nan=False)
        .replace("</", "<\\/")
        .replace("<!--", "<\\u0021--")
    )
    page = (here / "page.html").read_text(encoding="utf-8")
    script = "\n".join((here / name).read_text(encoding="utf-8") for name in scripts)
    for mark, text in (
        ("/*STYLE*/", (here / "page.css").read_text(encoding="utf-8")),
        ("/*SCRIPT*/", script),
        ("/*DATA*/", data),
    ):
        page = page.replace(mark, text, 1)
    return page
