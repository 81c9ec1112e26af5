"""The sentence on top of a page, for each verb."""

from typing import Any

from twin.recording.checks import whose


def title(kind: str, result: dict[str, Any]) -> str:
    """What the page is called."""
    ship = result.get("ship", "ship")
    if kind == "add":
        return f"{ship}: adding {' and '.join(result.get('added', []))}"
    return f"{ship}: {'model against measurement' if kind == 'compare' else 'what is missing'}"


def sentence(kind: str, result: dict[str, Any]) -> str:
    """What the verb says of its result; before it, that a voyage may be of another ship."""
    said = str(result.get("sentence" if kind == "diagnose" else "verdict", ""))
    return " ".join([*whose(result.get("data_checks", ())), said])
