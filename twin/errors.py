"""What can go wrong, and the exit code that says so.

Every message names what, where, which number, and what to do; the command line prints it as one line.
"""

from collections.abc import Iterable


class TwinError(Exception):
    """Something failed; the message is one line a person can act on."""

    exit_code = 1


class UsageError(TwinError):
    """A command that cannot be meant so."""

    exit_code = 2


class ThresholdError(TwinError):
    """A threshold that was asked for is not met (a budget, an error that should have fallen)."""

    exit_code = 3


class DataError(TwinError):
    """Measurements that cannot be used."""

    exit_code = 4


class SettingsError(TwinError):
    """A ship file, a configuration or a map that is not valid."""

    exit_code = 5


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """' Did you mean X? Known: A, B.' for a name that is not in the list."""
    known = sorted(known)
    import difflib  # here and not above: the loop never needs it

    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f" Did you mean {near[0]!r}?" if near else ""
    return f"{hint} Known: {', '.join(known)}."
