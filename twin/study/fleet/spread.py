"""Questions asked in many processes: of this computer, or of a dask cluster. A process that dies costs the
one question that it had."""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from multiprocessing import resource_tracker
from typing import Any, NamedTuple

from twin.errors import TwinError

QUIET = 50  # logging level above which dask tells of its processes: nothing
DIED = "KilledWorker"
WAIT_S = 5  # for a scheduler
POLL_S = 0.1
WITHOUT_S = 60.0  # an own cluster without a process is begun anew
# a worker holds the one question that it is asked, so that its death costs no other; which is tried once more
HELD = {"distributed.scheduler.worker-saturation": 1.0, "distributed.scheduler.allowed-failures": 1}


class Answered(NamedTuple):
    """A question with its answer, or with why there is none."""

    job: Any
    answer: Any
    why: str = ""
    kind: str = ""


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def spread(
    ask: Callable[[Any], Any], jobs: Sequence[Any], workers: int, scheduler: str | None = None
) -> Iterator[Answered]:
    """Every answer as it comes. One worker and no scheduler: in this process, in order, without dask."""
    if not scheduler and workers <= 1:
        yield from (_here(ask, job) for job in jobs)
        return
    left = {id(job): job for job in jobs}
    before = 0
    while left and len(left) != before:
        before = len(left)
        for one in _cluster(ask, list(left.values()), workers, scheduler):
            del left[id(one.job)]
            yield one
    yield from (Answered(job, None, "no process stayed alive to ask it", DIED) for job in left.values())


def _cluster(
    ask: Callable[[Any], Any], jobs: Sequence[Any], workers: int, scheduler: str | None
) -> Iterator[Answered]:
    import dask
    from distributed import Client, LocalCluster

    with dask.config.set(HELD), ExitStack() as stack:
        if scheduler:
            client = _client(scheduler)
        else:
            with _left_alone_by_interrupts():
                cluster = LocalCluster(
                    n_workers=min(workers, len(jobs)), threads_per_worker=1, dashboard_address="127.0.0.1:0",
                    silence_logs=QUIET, memory_limit=0,
                )  # fmt: skip
                stack.enter_context(cluster)
            client = Client(cluster)
        stack.enter_context(client)
        yield from _answers(client, ask, jobs, own=not scheduler)


def _client(scheduler: str) -> Any:
    from distributed import Client

    try:
        return Client(scheduler, timeout=WAIT_S)
    except (OSError, ValueError, TimeoutError) as error:
        raise TwinError(
            f"{scheduler}: no dask scheduler answers there within {WAIT_S} s ({_line(error)}). Start one "
            "with `dask scheduler`, or leave --scheduler out."
        ) from None


@contextmanager
def _left_alone_by_interrupts() -> Iterator[None]:
    """Processes that begin meanwhile do not hear Ctrl-C, which a terminal sends to all: this process does,
    once they have begun, and ends them."""
    resource_tracker.ensure_running()  # which would lift the mask again, were it begun later
    heard: list[int] = []
    ours = threading.current_thread() is threading.main_thread()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    handler = signal.signal(signal.SIGINT, lambda number, _: heard.append(number)) if ours else None
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if ours:
            signal.signal(signal.SIGINT, handler or signal.SIG_DFL)
    if heard:
        raise KeyboardInterrupt


def _here(ask: Callable[[Any], Any], job: Any) -> Answered:
    try:
        return Answered(job, ask(job))
    except Exception as error:
        return Answered(job, None, _line(error), type(error).__name__)


def _answers(client: Any, ask: Callable[[Any], Any], jobs: Sequence[Any], own: bool) -> Iterator[Answered]:
    """The answers of a cluster, until all are there, or until an own one has had no process for a minute (one
    that dies while it begins is not always begun again)."""
    from distributed import as_completed

    futures: dict[Any, Any] = dict(zip(client.map(ask, jobs, pure=False, retries=0), jobs, strict=True))
    done, alive = as_completed(list(futures)), time.monotonic()
    while futures:
        if not done.has_ready():
            time.sleep(POLL_S)
            alive = time.monotonic() if not own or client.nthreads() else alive
            if time.monotonic() - alive > WITHOUT_S:
                return
            continue
        future = next(done)
        job, error = futures.pop(future), future.exception()
        if error is None:
            yield Answered(job, future.result())
        elif type(error).__name__ == DIED:
            yield Answered(job, None, "the process that was asked died, each time it was tried", DIED)
        else:
            yield Answered(job, None, _line(error), type(error).__name__)


def _line(error: BaseException) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"[:500]
