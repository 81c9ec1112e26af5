"""The end of a process with a Zenoh session: an interpreter that ends with one open may hang for ever."""

import os
import sys
import traceback
from collections.abc import Callable
from typing import NoReturn


def ends_the_process(action: Callable[[], int]) -> NoReturn:
    """Does it and ends the process with its exit code; 1 and a traceback for what nobody foresaw."""
    code = 1
    try:
        code = action()
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
