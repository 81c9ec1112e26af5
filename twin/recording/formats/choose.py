"""Which series stands for which channel: one source each, never two merged; what was not taken is said.

The answer is the table of a map, as a person would write it, so that what is taken by itself, what
`--suggest-map` writes and what a map says are one thing.
"""

from collections.abc import Collection, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from twin.errors import SettingsError, did_you_mean
from twin.live.signals.channels import BY_NAME
from twin.recording.formats.signals import BODY, COURSE, EARTH, EXTRA, PLACE, Series, Signals

SPARSE = 0.2  # a series with fewer samples than this share of the fullest one is a straggler
CHART = ("north_m", "east_m")
HEADING, MAGNETIC, VARIATION = "heading_true_north_deg", "heading_magnetic_deg", "magnetic_variation_deg"
MADE_TRUE = "heading_magnetic_deg + magnetic_variation_deg"
Sources = Mapping[str, str]  # quantity or "" for all: the source to take


class SourceChoice(NamedTuple):
    """`columns` of a map by channel, and sentences: what was taken where there was a choice."""

    columns: dict[str, Any]
    notes: list[str]


def sources_of(given: Iterable[str]) -> dict[str, str]:
    """`--source GP` and `--source heading_true_north_deg=HE` as a table. SettingsError: it names no
    channel."""
    out: dict[str, str] = {}
    for text in given:
        quantity, found, source = text.partition("=")
        if found and quantity not in BY_NAME and quantity not in EXTRA:
            known = (*BY_NAME, *EXTRA)
            raise SettingsError(
                f"--source {text}: no channel is called {quantity!r}.{did_you_mean(quantity, known)}"
            )
        out[quantity if found else ""] = source if found else text
    return out


def best(signals: Signals, quantity: str, sources: Sources, notes: list[str]) -> Series | None:
    """The series taken for a quantity: of the source asked for, of the best kind, first heard.
    SettingsError: the quantity has no such source."""
    there = [s for s in signals.series.values() if s.quantity == quantity]
    most = max((len(s) for s in there), default=0)
    wanted = sources.get(quantity, sources.get("", ""))
    named = [s for s in there if s.source == wanted]
    if quantity in sources and there and not named:
        known = sorted({s.source for s in there})
        raise SettingsError(f"--source {quantity}={wanted}: its sources are {', '.join(known)}.")
    full = named or [s for s in there if len(s) >= SPARSE * most]
    if not full:
        return None
    taken = min(full, key=lambda s: s.rank)  # of one rank the first heard
    others = [s for s in there if s is not taken]
    if others:
        also = ", ".join(f"{s.name}{f' ({len(s)} only)' * (len(s) < SPARSE * most)}" for s in others[:4])
        more = f" and {len(others) - 4} more" * (len(others) > 4)
        rival = next((s.source for s in others if s.source != taken.source), None)
        say = f"; --source {quantity}={rival} takes another" if rival is not None else ""
        notes.append(f"{quantity}: {taken.name} is used, not {also}{more}{say}")
    return taken


def chosen(signals: Signals, sources: Sources) -> SourceChoice:
    """The columns of the log's own map. SettingsError: the log has no such source."""
    known = {s.source for s in signals.series.values()}
    if sources.get("") and sources[""] not in known:
        raise SettingsError(f"--source {sources['']}: the log's sources are {', '.join(sorted(known))}.")
    notes: list[str] = []
    columns: dict[str, Any] = {}
    for name in BY_NAME:
        if name not in (*BODY, *CHART, HEADING) and (found := best(signals, name, sources, notes)):
            columns[name] = found.name
    for name in dict.fromkeys(s.quantity for s in signals.series.values() if "." in s.quantity):
        if found := best(signals, name, sources, notes):
            columns[name] = found.name
    columns |= heading(signals, sources, notes)
    columns |= pair(signals, PLACE, PLACE, sources, notes, {}) or pair(
        signals, CHART, CHART, sources, notes, {}
    )
    for frame, quantities in (("body", BODY), ("course", COURSE), ("earth", EARTH)):
        if columns.keys() & set(BODY):
            break
        columns |= pair(
            signals, BODY, quantities, sources, notes, {"frame": frame} if frame != "body" else {}
        )
    return SourceChoice(columns, notes)


def pair(
    signals: Signals,
    channels: Iterable[str],
    quantities: Iterable[str],
    sources: Sources,
    notes: list[str],
    how: dict[str, Any],
) -> dict[str, Any]:
    """Two quantities that belong together, from one source where one has both."""
    first, second = quantities
    said: list[str] = []
    a = best(signals, first, sources, said)
    if a is None:
        return {}
    partner = {s.source: s for s in signals.series.values() if s.quantity == second and s.rank == a.rank}
    b = partner.get(a.source) or best(signals, second, sources, [])
    if b is None:
        return {}
    notes += said
    return {c: {"column": s.name, **how} if how else s.name for c, s in zip(channels, (a, b), strict=True)}


def heading(signals: Signals, sources: Sources, notes: list[str]) -> dict[str, Any]:
    """The true heading, else the magnetic one with the variation that the log holds."""
    said: list[str] = []
    found = best(signals, HEADING, sources, said)
    magnetic = best(signals, MAGNETIC, sources, [])
    if found is not None and (magnetic is None or not (found.rank >= 2 and magnetic.rank < found.rank)):
        notes += said
        return {HEADING: found.name}
    if magnetic is None:
        return {}
    best(signals, MAGNETIC, sources, notes)
    variation = best(signals, VARIATION, sources, [])
    if variation is None:
        notes.append(
            f"{HEADING}: {magnetic.name} is magnetic, and no variation was recorded: offset = VARIATION in a "
            "map"
        )
        return {HEADING: magnetic.name}
    made = made_true(signals, magnetic, variation)
    notes.append(
        f"{HEADING}: {magnetic.name} and the variation of {variation.name} "
        f"({np.median(variation.values):.1f} deg)"
    )
    return {HEADING: made.name}


def made_true(signals: Signals, magnetic: Series, variation: Series) -> Series:
    """A new series: the magnetic heading and the variation that was last heard (before the first: the
    first)."""
    t, shown = magnetic.arrays()
    at, by = variation.arrays()
    out = signals.of(MADE_TRUE, magnetic.source, "")
    if not len(out):
        last = np.clip(np.searchsorted(at, t, side="right") - 1, 0, None)
        out.times.frombytes(t.tobytes())
        out.values.frombytes(np.mod(shown + by[last], 360.0).tobytes())
    return out


def unused(signals: Signals, channels: Collection[str], taken: Collection[str]) -> list[str]:
    """One sentence for quantities of which nothing was taken, and what would take them. `channels` of the
    voyage, `taken` the series that they came from."""
    used = set(BY_NAME) - {*BODY, HEADING}
    used |= {signals.series[n].quantity for n in taken if n in signals.series} - {""}  # "" is many things
    used |= {MAGNETIC, VARIATION} if HEADING in channels else set()
    left = [s.name for s in signals.series.values() if s.name not in taken and s.quantity not in used]
    out = [f"not used: {', '.join(left[:12])}{f' and {len(left) - 12} more' * (len(left) > 12)}"] * bool(left)
    engine = next((s for s in signals.series.values() if s.quantity == "engine_rate_rpm"), None)
    if engine and engine.name not in taken and "propeller_rate_rpm" not in channels:
        ratio = f'propeller_rate_rpm = {{ column = "{engine.name}", factor = 1 / GEAR RATIO as a number }}'
        out.append(f"{engine.name} is the engine's rate, not the shaft's: in a map, {ratio}")
    return out
