"""Install, upgrade and roll back in a folder instead of a computer's root; without systemd nothing starts."""

import os
import shutil
import subprocess
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DEPLOY = ROOT / "deploy"


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """This source as a wheel, so that two installations build only once; they take no dependencies along."""
    folder, source = tmp_path_factory.mktemp("wheel"), tmp_path_factory.mktemp("source")
    for name in ("twin", "export", "bench"):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    command = ["python3", "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder, source]
    done = subprocess.run(command, capture_output=True, text=True, timeout=180)
    if done.returncode != 0:
        pytest.skip(f"no wheel can be built here: {done.stderr.strip().splitlines()[-1:]}")
    return next(folder.glob("shiptwin-*.whl"))


def script(name, root, *arguments):
    env = os.environ | {"ROOT": str(root), "PIP_NO_DEPS": "1"}
    done = subprocess.run([DEPLOY / name, *arguments], env=env, capture_output=True, text=True, timeout=180)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def running(root):
    return os.readlink(root / "opt/shiptwin/current").removeprefix("versions/")


@pytest.fixture(scope="module")
def two_versions(wheel, tmp_path_factory):
    """(root, first, second): installed one after the other, with a setting changed in between."""
    root = tmp_path_factory.mktemp("root")
    script("install.sh", root, wheel)
    first = running(root)
    (root / "etc/shiptwin/twin.toml").write_text("[ship]\nfile = 'mine.toml'\n")
    time.sleep(1.1)  # versions are named by the second
    script("install.sh", root, wheel)
    return root, first, running(root)


def test_versions_stand_side_by_side_and_the_new_one_runs(two_versions):
    root, first, second = two_versions
    assert first != second
    assert {p.name for p in (root / "opt/shiptwin/versions").iterdir()} == {first, second}


def test_the_installed_command_works(two_versions):
    command = [two_versions[0] / "opt/shiptwin/current/bin/twin", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, cwd="/")
    assert done.returncode == 0 and "digital twin" in done.stdout


def test_settings_that_are_there_stay(two_versions):
    assert "mine.toml" in (two_versions[0] / "etc/shiptwin/twin.toml").read_text()


def test_units_and_scripts_are_where_the_units_look_for_them(two_versions):
    root = two_versions[0]
    assert (root / "etc/systemd/system/shiptwin-alarm@.service").exists()
    assert os.access(root / "opt/shiptwin/current/share/shiptwin/alarm.sh", os.X_OK)


def test_roll_back_runs_the_version_before_and_again_the_one_after(two_versions):
    root, first, second = two_versions
    script("rollback.sh", root)
    assert running(root) == first
    assert f"{first} shiptwin" in script("rollback.sh", root, "--list")
    script("rollback.sh", root)
    assert running(root) == second


def test_a_version_that_is_not_there_is_refused(two_versions):
    env = os.environ | {"ROOT": str(two_versions[0])}
    command = [DEPLOY / "rollback.sh", "19990101T000000"]
    done = subprocess.run(command, env=env, capture_output=True, text=True)
    assert done.returncode == 1 and "not installed" in done.stderr
