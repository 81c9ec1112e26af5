"""One self-contained page for compare, diagnose and add: opens from a stick, asks nothing of any network.

    report.write("diagnose.html", "diagnose", result, tracks, model)

`result` is the verb's JSON as docs/json.md has it; its sentence stands on top. Further keys are shown when
they are there: `command` (what was typed), `files` {ship, voyages} (for the commands beside suggestions),
`voyages` (provenance), `data_checks`, `notes`, `history`. What the page needs and `result` lacks (horizons,
channels, where, worst_windows, unexplained_force, switched_off) is computed from tracks and model."""

from typing import Any

__all__ = ["write"]


def __getattr__(name: str) -> Any:
    """The function that writes a page, imported when it is asked for: who wants a table needs no study."""
    if name != "write":
        raise AttributeError(f"module 'twin.report' has no attribute {name!r}. It has: write.")
    from twin.report.page import write

    return write
