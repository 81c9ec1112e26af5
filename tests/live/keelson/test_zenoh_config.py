"""What may be said to Zenoh: a file of its own is obeyed, the rest stays locked; names that can be part of a key."""

import json
from pathlib import Path

import pytest

from twin.errors import SettingsError
from twin.live.keelson.topics import OF_ACTUATORS, subjects
from twin.live.keelson.zenoh_config import BusSettings, configuration


def test_a_zenoh_file_is_obeyed_and_the_rest_stays_locked(tmp_path: Path) -> None:
    file = tmp_path / "zenoh.json5"
    tls = 'mode: "client", connect: {endpoints: ["tls/bridge:7447"]}'
    file.write_text("{" + tls + ", transport: {link: {tx: {lease: 9000}}}}")
    config = configuration(BusSettings(file=str(file)))
    assert json.loads(config.get_json("transport/link/tx/lease")) == 9000
    assert json.loads(config.get_json("connect/endpoints")) == ["tls/bridge:7447"]
    assert json.loads(config.get_json("mode")) == "client"
    assert json.loads(config.get_json("scouting/multicast/enabled")) is False
    assert json.loads(config.get_json("transport/link/rx/max_message_size")) == 262144


def test_the_size_of_a_sample_is_limited_on_every_subject_that_can_be_subscribed_to() -> None:
    (rule,) = json.loads(configuration(BusSettings()).get_json("low_pass_filter"))
    limited = {key.split("/pubsub/")[1].removesuffix("/**") for key in rule["key_exprs"]}
    assert limited == {*subjects(), *OF_ACTUATORS}


def test_what_a_zenoh_file_sets_to_zenohs_own_default_stays_locked(tmp_path: Path) -> None:
    file = tmp_path / "zenoh.json5"
    file.write_text("{transport: {unicast: {max_sessions: 1000, accept_pending: 50}}}")
    config = configuration(BusSettings(file=str(file)))
    assert json.loads(config.get_json("transport/unicast/max_sessions")) == 32
    assert json.loads(config.get_json("transport/unicast/accept_pending")) == 50


@pytest.mark.parametrize("content", ["", "not json", '{"no_such_key": 1}'])
def test_a_zenoh_file_that_is_none_is_one_clear_line(tmp_path: Path, content: str) -> None:
    file = tmp_path / "zenoh.json5"
    file.write_text(content)
    with pytest.raises(SettingsError) as raised:
        configuration(BusSettings(file=str(file)))
    assert str(file) in str(raised.value) and "\n" not in str(raised.value)


@pytest.mark.parametrize("name", ["a/*", "", "/a", "@v0", "a//b", "a#"])
def test_names_that_cannot_be_part_of_a_key_are_refused(name: str) -> None:
    for settings in (BusSettings(base=name), BusSettings(entity=name)):
        with pytest.raises(SettingsError, match="cannot be part of a key"):
            configuration(settings)
