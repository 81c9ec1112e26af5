"""The bill of materials against what is really installed: what the twin needs on board, found by following
the installed packages' own requirements."""

import json
import re
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

from packaging.markers import default_environment
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]
DEPLOY = ROOT / "deploy"


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
    """Expected: name for name what an installation brings, nothing else, nothing less."""
    try:
        there = needed("shiptwin", set())
    except PackageNotFoundError as error:
        raise AssertionError(f"{error} is required and not installed here") from None
    bill = json.loads((DEPLOY / "sbom.json").read_text())
    assert there > {"numpy", "onnxruntime", "eclipse-zenoh", "mcap", "protobuf"}
    assert {plain(part["name"]) for part in bill["components"]} == there


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
