"""The page of `twin train`: how it went, whether the residual is worth having, and what bounds it."""

from collections.abc import Mapping, Sequence
from typing import Any

from twin.num import as_given, num, percent, readable
from twin.report.curves import Curve, Curves
from twin.report.result_page import Bars, PageTable, result_page

Result = Mapping[str, Any]
STAGES = {
    "acceleration": "single moments: acceleration",
    "rollout": "roll-outs over some ship lengths",
    "paper": "the paper's loss",
}
BOTH = {"physics": "physics alone", "with_residual": "with residual"}
PARTS = {"train": "teaches", "validation": "says when to stop", "test": "judges"}


def training_page(result: Result) -> str:
    """One self-contained HTML page of what `twin train` found (its JSON)."""
    held, verdict = result["held_out"], str(result["verdict"])
    said = verdict[:1].upper() + verdict[1:] + "."
    return result_page(
        f"{result['ship']}: what was learned beyond physics",
        said,
        _heed(result),
        (
            *(_bars(held.get("by_horizon", []), *what) for what in ERRORS),
            *(_curves(result["curve"], stage) for stage in dict.fromkeys(row[0] for row in result["curve"])),
            PageTable("What it is bounded by", {"is": "bound", "value": "value"}, _bounds(result)),
            PageTable("Where it is believed", INPUTS, [readable(i) for i in result["bounds"]["inputs"]]),
            PageTable("Voyages", {"part": "part", "name": "stretch"}, _parts(result["parts"])),
            PageTable("Files", {"name": "voyage", "began": "began", "sha256": "sha256"}, _files(result)),
        ),
    )


ERRORS = (
    ("position_m", "Place on held-out free runs, physics alone and with the residual", "m"),
    ("heading_deg", "Heading on the same", "deg"),
)
INPUTS = {"name": "input", "low": "from", "high": "to", "unit": "unit"}


def _heed(result: Result) -> list[str]:
    """What its owner should know before it goes on board."""
    held, seeds = result["held_out"], result["seeds"]
    low, high = held["position_ratio_95"]
    forced = "written by --force although that is no proof" * bool(result["forced"])
    written = "" if result["written"] else "nothing was written"
    out = [
        f"{percent(result['learned_share'])} of all force is learned, the rest is physics.",
        f"The error with it is {num(low, 3)} to {num(high, 3)} times the one without (95 %, whole blocks "
        f"of {held['blocks']} resampled, {held['windows']} free runs).",
        f"{num(result['seconds'], 2)} s of training; "
        + (
            f"the best of {len(seeds)} seeds on validation is {result['seed']}." if seeds[1:] else "one seed."
        ),
    ]
    return out + [f"Careful: {words}." for words in (forced, written) if words]


def _bars(rows: Sequence[Mapping[str, Any]], key: str, caption: str, unit: str) -> Bars:
    """Errors at each lead, with and without."""
    shown = [{"at": f"after {as_given(row['horizon_s'], 3)} s"} | dict(row[key]) for row in rows]
    return Bars(caption, unit, "at", BOTH, shown)


def _curves(curve: Sequence[Sequence[Any]], stage: str) -> Curves:
    """Loss and validation loss of a stage over its epochs."""
    rows = [row for row in curve if row[0] == stage]
    loss = [(float(row[1] + 1), float(row[2])) for row in rows]
    validation = [(float(row[1] + 1), float(row[3])) for row in rows]
    lines = [Curve("training", "--before", loss), Curve("validation", "--model", validation)]
    return Curves(f"Loss: {STAGES.get(stage, stage)}", "epoch", "loss [-]", lines, log=True)


def _bounds(result: Result) -> list[dict[str, Any]]:
    """The most that it can ever add, in newtons."""
    b = result["bounds"]
    scale, most = b["force_scale"], float(b["output_bound"])
    rows = [("its size, in units of the force scale", num(most, 3))]
    for key, words, unit in (("X_N", "ahead", "N"), ("Y_N", "to starboard", "N"), ("N_Nm", "turning", "N m")):
        rows.append((f"force {words}", f"{num(most * scale[key], 3)} {unit}"))
    return [{"is": words, "value": value} for words, value in rows]


def _parts(parts: Mapping[str, Sequence[str]]) -> list[dict[str, str]]:
    return [{"part": PARTS.get(part, part), "name": name} for part, names in parts.items() for name in names]


def _files(result: Result) -> list[dict[str, str]]:
    return [
        {
            "name": str(v.get("name", "")),
            "began": str(v.get("start_time_utc") or ""),
            "sha256": str(v.get("sha256") or "")[:16] or "not recorded",
        }
        for v in result["voyages"]
    ]
