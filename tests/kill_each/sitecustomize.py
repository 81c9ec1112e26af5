"""On the path of a process under test: kills it with SIGKILL at each step of writing a ship file.

KILL_STEM names the ship file. At the first step that touches it or its arrays the process forks; the child is
killed at step 0, and what it left is copied to KILL_STATES/0; the folder is put back, the next child is killed
at step 1, and so on, until a child comes to its end. With KILL_AT the process itself is killed at that step.
A step is just before a file is opened for writing, renamed or removed; the last is at the end of the verb."""

import atexit
import os
import re
import shutil
import signal
import sys

STEM, AT, STATES = (os.environ.get(f"KILL_{k}") for k in ("STEM", "AT", "STATES"))
KINDS = ("open", "os.rename", "os.remove")
OURS = re.compile(rf"\.?{re.escape(STEM or '')}\.")
passed = [0]
limit = [int(AT) if AT else None]


def kept(folder):
    """Bytes of every file of the folder, by name."""
    return {f: open(os.path.join(folder, f), "rb").read() for f in os.listdir(folder) if "." in f}


def put_back(folder, files):
    for name in set(kept(folder)) - set(files):
        os.unlink(os.path.join(folder, name))
    for name, data in files.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(data)


def each(folder):
    """Returns in the children only; ends the process with the exit code of the last of them."""
    before, step = kept(folder), 0
    while True:
        pid = os.fork()
        if not pid:
            limit[0] = step
            return
        status = os.waitpid(pid, 0)[1]
        if os.WIFEXITED(status):
            os._exit(os.WEXITSTATUS(status))
        assert os.WTERMSIG(status) == signal.SIGKILL
        shutil.copytree(folder, os.path.join(STATES, str(step)))
        put_back(folder, before)
        step += 1


def hook(event, args):
    if event not in KINDS or busy[0] or not isinstance(args[0], (str, os.PathLike)):
        return
    path = os.path.abspath(args[0])
    writes = event != "open" or (isinstance(args[2], int) and args[2] & (os.O_WRONLY | os.O_RDWR))
    if not writes or not OURS.match(os.path.basename(path)):
        return
    busy[0] = True
    if limit[0] is None:
        each(os.path.dirname(path))
    step()
    busy[0] = False


def step():
    if passed[0] == limit[0]:
        os.kill(os.getpid(), signal.SIGKILL)
    passed[0] += 1


busy = [False]
if STEM:
    sys.addaudithook(hook)
    atexit.register(step)
