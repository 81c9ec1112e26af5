"""The table between channels and the bus, checked against the keelson package itself."""

import keelson
import pytest

from twin.errors import SettingsError
from twin.live.keelson import topics
from twin.live.signals.channels import BY_NAME, CHANNELS


def test_every_channel_has_a_topic() -> None:
    assert {channel for topic in topics.INPUTS for channel in topic.channels} == set(BY_NAME)


def test_subjects_of_keelson_carry_the_type_that_keelson_says() -> None:
    named = [(t.subject, t.type_name) for t in (*topics.INPUTS, *topics.OUTPUTS)]
    for subject, type_name in named:
        if keelson.is_subject_well_known(subject):
            assert keelson.get_subject_schema(subject) == type_name


def test_a_channel_that_keelson_knows_keeps_keelsons_name() -> None:
    for channel in CHANNELS:
        if keelson.is_subject_well_known(channel.name):
            assert channel.name in topics.BY_SUBJECT


@pytest.mark.parametrize("source", ["gyro", "nmea/0"])
def test_keys_are_keelsons(source: str) -> None:
    key = topics.key("fleet/anna", "hull", "heading_true_north_deg", source)
    assert key == keelson.construct_pubsub_key("fleet/anna", "hull", "heading_true_north_deg", source)
    parsed = keelson.parse_pubsub_key(key)
    place = topics.address(key)
    assert place is not None
    assert (parsed["base_path"], parsed["entity_id"], parsed["subject"], parsed["source_id"]) == place


def test_the_liveliness_key_is_keelsons() -> None:
    assert topics.liveliness_key("a", "b", "twin") == keelson.construct_liveliness_key("a", "b", "twin")


NO_KEYS = ["", "a/b", "a/pubsub/x/y", "a/@v0/b/pubsub/x", "a/@v0//pubsub/x/y", "a/@v1/b/pubsub/x/y"]


@pytest.mark.parametrize("key", NO_KEYS)
def test_what_is_no_keelson_key_has_no_address(key: str) -> None:
    assert topics.address(key) is None


def test_an_unknown_channel_is_named_with_the_nearest() -> None:
    with pytest.raises(SettingsError, match="Did you mean 'rudder_angle_deg'"):
        topics.subjects(["ruder_angle_deg"])


def test_the_twins_own_voice_is_known() -> None:
    assert topics.is_own("twin") and topics.is_own("twin/estimate")
    assert not topics.is_own("twin2") and not topics.is_own("gyro/twin")
