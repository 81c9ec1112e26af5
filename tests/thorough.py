"""Tests that take long and tell more of what a shorter one tells already: `make thorough` runs them."""

from collections.abc import Iterable
from typing import Any

import pytest

thorough = pytest.mark.thorough


def one_of(values: Iterable[Any], often: int = 1) -> list[Any]:
    """The first `often` of these as they are; the others for `make thorough` alone."""
    values = list(values)
    return [*values[:often], *(pytest.param(value, marks=thorough) for value in values[often:])]
