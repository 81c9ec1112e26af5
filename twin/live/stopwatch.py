"""What each part of a tick costs: a stop-watch around methods, only while somebody wants to know."""

from array import array
from collections.abc import Callable
from time import perf_counter_ns
from typing import Any


class Parts:
    """Times by part [ns], newest last; `watch` puts a stop-watch around a method of one object."""

    def __init__(self, most: int = 200_000):
        self.most = most
        self.ns: dict[str, array[int]] = {}

    def watch(self, part: str, thing: Any, method: str) -> None:
        """Measure from now on how long each call of a thing's method takes [ns], under the name of the
        part."""
        times = self.ns.setdefault(part, array("q"))
        call: Callable[..., Any] = getattr(thing, method)
        most = self.most

        def timed(*args: Any, **kwargs: Any) -> Any:
            start = perf_counter_ns()
            try:
                return call(*args, **kwargs)
            finally:
                if len(times) < most:
                    times.append(perf_counter_ns() - start)

        setattr(thing, method, timed)
