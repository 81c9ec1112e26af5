"""How whoever waits for a study hears how far it is: a line of text, as often as a step begins."""

from collections.abc import Callable

Progress = Callable[[str], None]


def silent(text: str) -> None:
    """Nobody waits."""
