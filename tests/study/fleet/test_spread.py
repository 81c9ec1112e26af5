"""Questions in processes of their own: every answer comes, and a death costs one."""

import os
import signal
import subprocess
import sys
import time

import pytest

from tests.command_lines import hears_interrupts
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


INTERRUPTED = """
import time
from twin.cli import guarded
from twin.study.fleet.spread import spread
if __name__ == "__main__":
    print("begins", flush=True)
    raise SystemExit(guarded(lambda: list(spread(time.sleep, [600, 600], 2)) and 0))
"""


@pytest.mark.parametrize("after_s", [0.5, 4.0, 12.0])
def test_an_interrupt_ends_all_processes_with_one_word(after_s, tmp_path):
    """Test: Ctrl-C to the whole group, while the processes begin and while they work."""
    (tmp_path / "long.py").write_text(INTERRUPTED)
    begun = subprocess.Popen(
        [sys.executable, str(tmp_path / "long.py")],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        preexec_fn=hears_interrupts,
    )  # fmt: skip
    begun.stdout.readline()
    time.sleep(after_s)
    os.killpg(begun.pid, signal.SIGINT)
    _, said = begun.communicate(timeout=90)  # until the last process that holds the pipe has ended
    assert begun.returncode == 130 and said.strip() == "interrupted"


def test_a_scheduler_that_is_not_there_is_one_line():
    from twin.errors import TwinError

    with pytest.raises(TwinError, match=r"tcp://127\.0\.0\.1:9: no dask scheduler answers"):
        list(spread(root, [1], 1, "tcp://127.0.0.1:9"))
