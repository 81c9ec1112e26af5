"""The sentence on top of a page, for each verb."""

from typing import Any


def title(kind: str, result: dict[str, Any]) -> str:
    """What the page is called."""
    ship = result.get("ship", "ship")
    if kind == "add":
        return f"{ship}: adding {' and '.join(result.get('added', []))}"
    return f"{ship}: {'model against measurement' if kind == 'compare' else 'what is missing'}"


def sentence(kind: str, result: dict[str, Any]) -> str:
    """The verb's own verdict, or one made from the contract."""
    for key in ("verdict_text", "sentence"):
        if result.get(key):
            return str(result[key])
    return _diagnosed(result) if kind == "diagnose" else str(result.get("verdict", ""))


def _diagnosed(result: dict[str, Any]) -> str:
    verdict, candidates = result.get("verdict"), {c["effect"]: c for c in result.get("candidates", [])}
    if verdict == "missing":
        said = [_named(name, candidates.get(name)) for name in result.get("missing", [])]
        return f"{' and '.join(said)} {'is' if len(said) == 1 else 'are'} missing from the model."
    if verdict == "nothing_missing":
        return (
            "Nothing is missing: what the model leaves over is what this ship's calibration and "
            "instruments explain."
        )
    if verdict == "unknown":
        return "Something is missing, but none of the effects in the catalogue explains it."
    manoeuvre = result.get("next_manoeuvre") or {}
    apart = " and ".join(manoeuvre.get("separates", []))
    tail = f" Sail this to tell {apart} apart: {manoeuvre.get('manoeuvre')}." if apart else ""
    return f"These voyages do not decide it.{tail}"


def _named(name: str, candidate: dict[str, Any] | None) -> str:
    probability = (candidate or {}).get("probability")
    return name if probability is None else f"{name} (probability {100.0 * probability:.0f} %)"
