"""twin.toml as it is delivered: it is valid, and it shows every key with its meaning."""

from pathlib import Path

import pytest

from twin.live.signals.config import load
from twin.live.signals.keys import KEYS

DEPLOY = Path(__file__).parents[2] / "deploy"
TOML = DEPLOY / "twin.toml"


def test_the_delivered_settings_are_valid():
    settings = load(TOML)
    assert settings["bus.listen"] == "tcp/127.0.0.1:7447"


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.name)
def test_every_key_is_there_with_its_meaning(key):
    section, _, name = key.name.partition(".")
    lines = TOML.read_text().split(f"[{section}]\n")[1].split("\n[")[0].splitlines()
    line = next(line for line in lines if line.startswith(f"{name} = "))
    assert key.doc in line


def test_only_folders_differ_from_the_defaults():
    settings = load(TOML)
    changed = {key.name: settings[key.name] for key in KEYS if settings[key.name] != key.default}
    assert changed == {"log.folder": "/var/log/shiptwin", "state.folder": "/var/lib/shiptwin"}


def test_the_service_may_write_where_the_settings_say():
    unit = (DEPLOY / "shiptwin.service").read_text()
    assert "LogsDirectory=shiptwin" in unit and "StateDirectory=shiptwin" in unit
