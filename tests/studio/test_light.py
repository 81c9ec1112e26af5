"""The workbench costs nobody who does not use it: neither `import twin`, nor a verb, nor the loop loads its server."""

import subprocess
import sys

import pytest

HEAVY = {"starlette", "uvicorn", "anyio"}
LOADS = {
    "the interface": "import twin; twin.__version__; twin.PUBLIC",
    "a verb": "from twin.cli import main\ntry:\n    main(['compare', '--help'])\nexcept SystemExit:\n    pass",
    "the help of the workbench": "from twin.cli import main\ntry:\n    main(['studio', '--help'])\nexcept SystemExit:\n    pass",
    "the loop": "import twin.live.run, twin.live.loop",
    "a worker's own start": "import twin.studio.work",
}


@pytest.mark.parametrize("what", LOADS)
def test_the_server_is_loaded_by_nothing_else(what):
    script = f"{LOADS[what]}\nimport sys; print('LOADED', *sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    loaded = set(done.stdout.partition("LOADED")[2].split())
    assert loaded, done.stderr
    assert not loaded & HEAVY
