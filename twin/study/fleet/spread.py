"""Questions asked in many processes: of this computer, or of a dask cluster. A process that dies costs the
one question that it had."""

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from multiprocessing import resource_tracker
from typing import Any, NamedTuple

from twin.errors import TwinError

QUIET = 50  # logging level above which dask tells of its processes: nothing
DIED = "KilledWorker"
WAIT_S = 5  # for a scheduler


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
    if not jobs:
        return
    import dask
    from distributed import Client, LocalCluster

    # a worker holds the one question that it is asked, so that its death costs no other
    with dask.config.set({"distributed.scheduler.worker-saturation": 1.0}), ExitStack() as stack:
        if scheduler:
            client = _client(scheduler)
        else:
            with _left_alone_by_interrupts():
                cluster = LocalCluster(
                    n_workers=min(workers, len(jobs)), threads_per_worker=1, dashboard_address=None,
                    silence_logs=QUIET, memory_limit=0,
                )  # fmt: skip
                stack.enter_context(cluster)
            client = Client(cluster)
        stack.enter_context(client)
        yield from _asked(client, ask, jobs)


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
    and ends them."""
    resource_tracker.ensure_running()  # which would lift the mask again, were it begun later
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _here(ask: Callable[[Any], Any], job: Any) -> Answered:
    try:
        return Answered(job, ask(job))
    except Exception as error:
        return Answered(job, None, _line(error), type(error).__name__)


def _asked(client: Any, ask: Callable[[Any], Any], jobs: Sequence[Any]) -> Iterator[Answered]:
    from distributed import as_completed

    futures: dict[Any, Any] = dict(zip(client.map(ask, jobs, pure=False, retries=0), jobs, strict=True))
    for future in as_completed(list(futures)):
        job = futures.pop(future)
        error = future.exception()
        if error is None:
            yield Answered(job, future.result())
        elif type(error).__name__ == DIED:
            yield Answered(job, None, "the process that was asked died, each time it was tried", DIED)
        else:
            yield Answered(job, None, _line(error), type(error).__name__)


def _line(error: BaseException) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"[:500]
