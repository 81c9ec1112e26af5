"""The viewer's layout: every topic is one the twin speaks on, every field is one of the wide record."""

import json
import re
from pathlib import Path

import pytest

from twin.live.keelson.messages import Tick
from twin.live.keelson.topics import OUTPUTS, address

LAYOUT = json.loads((Path(__file__).parents[2] / "deploy" / "lichtblick-layout.json").read_text())


def values(node):
    """Every string in the layout that is a path or a topic."""
    if isinstance(node, dict):
        for name, value in node.items():
            if name in ("value", "topicPath", "followTopic") and value:
                yield value
            else:
                yield from values(value)
    elif isinstance(node, list):
        for item in node:
            yield from values(item)


def panels(node):
    return [node] if isinstance(node, str) else [*panels(node["first"]), *panels(node["second"])]


def has_field(descriptor, path):
    """Whether a message has the field at `path`; slices and filters, [:]{name=="hull"}, are let through."""
    for part in re.sub(r"\[[^]]*\]|\{[^}]*\}", "", path).split("."):
        if descriptor is None or part not in descriptor.fields_by_name:
            return False
        descriptor = descriptor.fields_by_name[part].message_type
    return True


def test_every_panel_of_the_layout_is_configured_and_used():
    assert sorted(panels(LAYOUT["layout"])) == sorted(LAYOUT["configById"])


@pytest.mark.parametrize("text", sorted(set(values(LAYOUT["configById"]))))
def test_every_path_exists(text):
    topic, _, field = text.strip('"').partition('".')
    place = address(topic)
    assert place is not None
    assert (place.subject, place.source) in {(o.subject, o.source) for o in OUTPUTS}
    assert not field or has_field(Tick.DESCRIPTOR, field)
