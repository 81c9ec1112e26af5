"""The workbench costs nobody who does not use it: neither `import twin`, nor a verb, nor the loop loads its server."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from twin.studio.replies import page_files

HEAVY = {"starlette", "uvicorn", "anyio"}
LOADS = {
    "the interface": "import twin; twin.__version__; twin.PUBLIC",
    "a verb": "from twin.cli import main\ntry:\n    main(['compare', '--help'])\nexcept SystemExit:\n    pass",
    "the help of the workbench": "from twin.cli import main\ntry:\n    main(['studio', '--help'])\nexcept SystemExit:\n    pass",
    "the loop": "import twin.live.service, twin.live.loop",
    "a worker's own start": "import twin.studio.work",
}


@pytest.mark.parametrize("what", LOADS)
def test_the_server_is_loaded_by_nothing_else(what):
    script = f"{LOADS[what]}\nimport sys; print('LOADED', *sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    loaded = set(done.stdout.partition("LOADED")[2].split())
    assert loaded, done.stderr
    assert not loaded & HEAVY


def test_an_installation_gets_every_file_of_the_page():
    root = Path(__file__).parents[2]
    kept = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"][
        "twin.studio.page"
    ]
    there = {
        f"*{p.suffix}" for p in (root / "twin/studio/page").iterdir() if p.is_file() and p.suffix != ".py"
    }
    assert there <= set(kept) and "/app/uplot-license.txt" in page_files()


def test_without_the_extra_one_line_says_what_to_install(tmp_path):
    script = "import sys; sys.modules['starlette'] = None; from twin.cli import main; sys.exit(main(['studio', sys.argv[1]]))"
    done = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path)], capture_output=True, text=True, timeout=60
    )
    assert (
        done.returncode == 1
        and "pip install 'shiptwin[studio]'" in done.stderr
        and "Traceback" not in done.stderr
    )


@pytest.mark.parametrize("words", [["nowhere"], [".", "--port", "70000"], [".", "--demo", "--read-only"]])
def test_a_start_that_cannot_be_meant_is_one_line_and_exit_code_2(tmp_path, words):
    command = [sys.executable, "-m", "twin", "studio", *words, "--no-browser"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "UsageError" in done.stderr
