"""What a prediction tube cannot promise because of the voyages it rests on: one sentence each."""

import datetime
from collections.abc import Mapping, Sequence
from typing import Any

from twin.live.prediction.circumstances import SEAS
from twin.num import as_given, num
from twin.recording.voyage import Voyage
from twin.study.reference.tube_calibration import needed

SEASON_DAYS = 90


def doubts(
    table: Mapping[str, Any],
    voyages: Sequence[Voyage],
    asked_s: Sequence[float],
    L: float,
    fitted: Sequence[str],
) -> list[str]:
    """Sentences on the table [tube]. `asked_s`: horizons that the settings ask for; L: the ship's length;
    `fitted`: names of those of the voyages that the model was calibrated to."""
    said = [*_few(table), *_sea(table, L), *_season(voyages)]
    left = [h for h in asked_s if h not in table["horizons_s"]]
    if left:
        said.append(
            f"No voyage held helm and engine for {as_given(min(left))} s, so there is no tube for "
            f"{', '.join(as_given(h) for h in left)} s: give voyages with longer steady stretches."
        )
    if fitted:
        said.append(
            f"The model was calibrated to {', '.join(fitted)}: its errors there may be smaller than on a new "
            "voyage, and the tube too narrow. Give voyages that it has not seen."
        )
    return said


def _few(table: Mapping[str, Any]) -> list[str]:
    level, least = table["level"], needed(table["level"])
    counts = {h: table[f"cell_{h:g}s_all"]["voyages"] for h in table["horizons_s"]}
    few = {h: n for h, n in counts.items() if n < least}
    return [
        f"{as_given(h)} s: {n} voyage{'s' * (n > 1)} can promise {100 * n / (n + 1):.0f} % at best, and "
        f"{100 * level:.0f} % takes {least}: the tube is as wide as their greatest error."
        for h, n in few.items()
    ]


def _sea(table: Mapping[str, Any], L: float) -> list[str]:
    seas = table["seas"]
    if seas == [SEAS[0]]:
        return [
            "No voyage knows its wave height: nothing is promised where one is reported, and the tube is "
            "that of the seas that were sailed, whatever they were."
        ]
    known = [s for s in seas if s != SEAS[0]]
    if len(known) > 1:
        return []
    return [
        f"All voyages were sailed in one sea ({known[0]}, up to {num(table['highest'][4] * L / 100.0, 2)} "
        "m): nothing is promised in a higher one."
    ]


def _season(voyages: Sequence[Voyage]) -> list[str]:
    days = [d for v in voyages if (d := _day(v.meta.get("start_time_utc")))]
    if len(days) < len(voyages):
        return []
    span = (max(days) - min(days)).days
    if span >= SEASON_DAYS:
        return []
    return [
        f"All voyages are from within {max(span, 1)} day{'s' * (span > 1)}: of another season, loading or "
        "fouling they show nothing, and the promise is not for these."
    ]


def _day(stamp: Any) -> datetime.date | None:
    try:
        return datetime.date.fromisoformat(str(stamp)[:10])
    except ValueError:
        return None
