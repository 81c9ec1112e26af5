"""The bill of materials against what is really installed: what the twin needs on board, found by following
the installed packages' own requirements."""

import json
import re
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

from packaging.markers import default_environment
from packaging.requirements import Requirement

DEPLOY = Path(__file__).parents[2] / "deploy"


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
