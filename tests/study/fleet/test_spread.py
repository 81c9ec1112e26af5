"""Questions in processes of their own: every answer comes, and a death costs one."""

import os
import signal

import pytest

from twin.study.fleet.spread import spread

pytest.importorskip("distributed")


def root(job):
    """A worker's work; -1 cannot be asked, 0 kills its process."""
    if job == 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return job**0.5 if job > 0 else 1 / 0


@pytest.mark.parametrize("workers", [1, 2])
def test_every_question_is_answered_and_what_goes_wrong_is_told(workers):
    found = {one.job: one for one in spread(root, [4, -1, 9], workers)}
    assert found[4].answer == 2.0 and found[9].answer == 3.0
    assert found[-1].answer is None and found[-1].why == "ZeroDivisionError: division by zero"


def test_a_process_that_dies_costs_its_own_question_alone():
    found = {one.job: one for one in spread(root, [1, 0, 4, 9, 16], 2)}
    assert found[0].kind == "KilledWorker" and "died" in found[0].why
    assert [found[n].answer for n in (1, 4, 9, 16)] == [1.0, 2.0, 3.0, 4.0]


def test_a_scheduler_that_is_given_does_the_work():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(1, processes=False, dashboard_address=None) as cluster:
        assert [one.answer for one in spread(root, [25], 1, cluster.scheduler_address)] == [5.0]


def test_a_scheduler_that_is_not_there_is_one_line():
    from twin.errors import TwinError

    with pytest.raises(TwinError, match=r"tcp://127\.0\.0\.1:9: no dask scheduler answers"):
        list(spread(root, [1], 1, "tcp://127.0.0.1:9"))
