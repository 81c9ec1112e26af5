"""The proposed map of a log: what its format names, and what the names of its other series may mean."""

from typing import Any

from twin.recording.formats.choose import Sources, chosen, unused
from twin.recording.formats.guess import Guess
from twin.recording.formats.signals import PLACE, Signals
from twin.recording.map_toml import lacking, quoted, toml
from twin.recording.place import CHART
from twin.recording.suggest_actuators import CONTROLS, actuator_columns, several
from twin.recording.suggest_entries import ENGINES, Entry, best_guesses, proposed
from twin.recording.suggest_series import CLOCK, OWN, by_settings, known_series, topics_seen


def of_signals(signals: Signals, sources: Sources) -> str:
    """What the log's own map takes, and its unnamed series as they may be meant."""
    choice = chosen(signals, sources)
    topics = topics_seen(signals)
    own = {
        c: (seen, name, Guess(c, "", OWN)) for c, seen, name in known_series(signals, choice.columns, topics)
    }
    taken = {
        c: w for c, w in best_guesses(topics).items() if c not in own and not signals.series[w[1]].quantity
    }
    parts = {
        c: w
        for c, w in actuator_columns(topics).items()
        if c not in choice.columns and signals.series[w[0][1]].quantity in ("", *CONTROLS)
    }
    set_up = by_settings(signals)
    parts = {} if set_up or (not several(parts) and has_both(choice.columns)) else parts
    more = proposed(topics, own | taken, parts, {"column": CLOCK, "unit": "s"}, own)
    more |= {c: Entry(keys, [why]) for c, (keys, why) in set_up.items()}
    more |= engine_entry(signals, choice.columns | more)
    added = {c: e for c, e in more.items() if c not in choice.columns and not clashes(c, choice.columns)}
    entries = choice.columns | {c: e.keys for c, e in added.items()}
    taken_too = "What stands under [columns] first is taken without a map too; change what is wrong."
    lines = [f"# {signals.path.name}: {signals.says}. {taken_too}", ""]
    lines += [f"# {note}" for note in (*choice.notes, *unused(signals, entries, series_of(entries)))]
    lines += ["", "[columns]", *(f"{quoted(channel)} = {toml(c)}" for channel, c in choice.columns.items())]
    lines += ["# by their names; read these with care"] * bool(added)
    lines += [f"{quoted(channel)} = {toml(e.keys)}  # {'; '.join(e.why)}" for channel, e in added.items()]
    return "\n".join(lines + lacking(choice.columns | added)) + "\n"


def series_of(entries: dict[str, Any]) -> set[str]:
    """The series that entries of a map name."""
    names = [e["column"] if isinstance(e, dict) else e for e in entries.values()]
    return {n for name in names for n in (name if isinstance(name, list) else [name])}


def engine_entry(signals: Signals, columns: Any) -> dict[str, Entry]:
    """An engine's rate for the shaft's, where no shaft's was recorded."""
    engine = next((s.name for s in signals.series.values() if s.quantity == "engine_rate_rpm"), None)
    if engine is None or CONTROLS[1] in columns or any("." in c for c in columns):
        return {}
    return {CONTROLS[1]: Entry({"column": engine, "factor": 1.0}, [ENGINES])}


def has_both(columns: Any) -> bool:
    """Whether one rudder and one shaft are there."""
    return all(c in columns for c in CONTROLS[:2])


def clashes(channel: str, columns: Any) -> bool:
    """Whether a position stands there already as another pair, or a velocity as one."""
    return (channel in CHART and PLACE[0] in columns) or (channel in PLACE and CHART[0] in columns)
