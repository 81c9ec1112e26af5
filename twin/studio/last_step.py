"""The last step of a job, in which it writes into the project: once begun it is finished, so that a job which
is cancelled has written nothing and one that has written is done."""

import signal
from pathlib import Path

from twin.errors import SettingsError


def last_step(output: str) -> None:
    """From here on the worker is not ended by a cancel; SettingsError when the file is there already."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    not_there(output)


def not_there(output: str) -> None:
    """SettingsError when the file is there already: nothing is written over."""
    if Path(output).exists():
        raise SettingsError(f"{output}: is there already and would be lost. Choose another name.")
