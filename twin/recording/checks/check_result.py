"""The answer of a check."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Check:
    """`name` of the check, whether the data passes, and a sentence; `unusable`: the mistake is proved."""

    name: str
    ok: bool
    text: str
    unusable: bool = False
    informative: bool = True  # whether the data could tell at all

    def as_json(self) -> dict[str, Any]:
        """The entry of `data_checks`."""
        return {
            "check": self.name,
            "ok": self.ok,
            "text": self.text,
            "proved": self.unusable,
            "told": self.informative,
        }


def good(name: str, text: str) -> Check:
    """The check passed."""
    return Check(name, True, text)


def cannot_tell(name: str, why: str) -> Check:
    """The check had too little to go by, and says why; it passes."""
    return Check(name, True, f"cannot tell: {why}", informative=False)


def doubtful(name: str, text: str) -> Check:
    """Something is odd: the check does not pass, and the voyage may still be used."""
    return Check(name, False, text)


def wrong(name: str, text: str) -> Check:
    """Proved: the voyage must not be used as it is."""
    return Check(name, False, text, unusable=True)
