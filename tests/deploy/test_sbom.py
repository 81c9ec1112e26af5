"""The bill of materials against what is really installed: what the twin needs on board, found by following
the installed packages' own requirements."""

import json
import re
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path
from runpy import run_path

from packaging.markers import default_environment
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]
DEPLOY = ROOT / "deploy"
locked = run_path(str(DEPLOY / "sbom.py"))["locked"]


def plain(name):
    """A package's name as registries compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def needed(package, found):
    """Every package that an installation of this one without extras brings along."""
    for text in requires(package) or ():
        wanted = Requirement(text)
        if wanted.marker and not wanted.marker.evaluate(default_environment() | {"extra": ""}):
            continue
        if plain(wanted.name) not in found:
            found.add(plain(wanted.name))
            needed(wanted.name, found)
    return found


def test_the_bill_of_materials_lists_what_is_installed_on_board():
    """Expected: name for name what an installation brings, nothing else, nothing less: with the ONNX Runtime
    that is installed here by one of the locks; what only the other one has, its ONNX Runtime needs."""
    try:
        there = needed("shiptwin", set())
    except PackageNotFoundError as error:
        raise AssertionError(f"{error} is required and not installed here") from None
    assert there > {"numpy", "onnxruntime", "eclipse-zenoh", "mcap", "protobuf"}
    brought = {
        lock: {
            plain(part["name"]): set(map(plain, part["via"])) for part in locked((DEPLOY / lock).read_text())
        }
        for lock in ("requirements.lock", "requirements-3.14.lock")
    }
    assert there in [set(parts) for parts in brought.values()]
    by_runtime = {"onnxruntime"}
    for parts in brought.values():
        for _ in parts:
            by_runtime |= {name for name, via in parts.items() if via and via <= by_runtime}
        assert set(parts) - there <= by_runtime and there - set(parts) <= by_runtime
    bill = json.loads((DEPLOY / "sbom.json").read_text())
    assert {plain(part["name"]) for part in bill["components"]} == set(brought["requirements.lock"])


def test_Q9_every_file_of_the_lock_has_a_hash_and_the_bill_of_materials_names_them_all():
    """Expected: the lock pins what pyproject.toml asks for on board, inside its bounds; sbom.json is what
    sbom.py makes of it."""
    lock = (DEPLOY / "requirements.lock").read_text()
    bill = json.loads((DEPLOY / "sbom.json").read_text())
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    pinned = {c["name"]: c for c in bill["components"]}
    for wanted in map(Requirement, project["dependencies"]):
        assert wanted.specifier.contains(pinned[wanted.name]["version"]), wanted
    assert all(c["hashes"] and f"{c['name']}=={c['version']}" in lock for c in pinned.values())
    made = subprocess.run(
        [sys.executable, DEPLOY / "sbom.py", DEPLOY / "requirements.lock", "/dev/stdout"],
        capture_output=True,
        text=True,
    )
    assert json.loads(made.stdout) == bill
    assert bill["metadata"]["component"]["version"] == project["version"]


def test_the_version_on_board_is_chosen_by_its_memory_where_there_is_one_for_that_python(tmp_path):
    """Expected: ONNX Runtime 1.20 for Python 3.11 to 3.13, for a newer one a lock with a version that has files
    for it; both locks pin what pyproject.toml asks for, with hashes."""
    wanted = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    for newer, name, series in ((1, "requirements.lock", "1.20."), (0, "requirements-3.14.lock", "1.")):
        python = tmp_path / f"python{newer}"
        python.write_text(f"#!/bin/sh\nexit {1 - newer}\n")
        python.chmod(0o755)
        chosen = subprocess.run(
            [DEPLOY / "which-lock.sh", python], capture_output=True, text=True, check=True
        ).stdout.strip()
        assert chosen == str(DEPLOY / name)
        pinned = re.findall(r"^([\w.-]+)==(\S+) \\\n    --hash=sha256:", Path(chosen).read_text(), re.M)
        versions = dict(pinned)
        assert versions["onnxruntime"].startswith(series)
        for requirement in map(Requirement, wanted):
            assert requirement.specifier.contains(versions[requirement.name]), (name, requirement)
    assert not versions["onnxruntime"].startswith("1.20.")
