"""The routes, asked without a server: what they refuse in one line, and what they write."""

import json

import anyio
import pytest

from tests.live.actuators import PODS, craft
from twin.studio.app import Studio
from twin.studio.project import Project


def asked(folder, path, body=None):
    """(status, what is said) of a request to the workbench of a folder."""
    route, _, query = path.partition("?")
    parts, answers = [json.dumps(body).encode() if body is not None else b""], []
    scope = {
        "type": "http",
        "method": "GET" if body is None else "POST",
        "path": route,
        "headers": [],
        "query_string": query.encode(),
    }

    async def receive():
        return {"type": "http.request", "body": parts.pop(), "more_body": False}

    async def send(message):
        answers.append(message)

    anyio.run(Studio(folder).app(), scope, receive, send)
    return answers[0]["status"], json.loads(answers[1]["body"])


@pytest.fixture
def folder(tmp_path):
    """The tanker with its voyages, and a map in Latin-1."""
    Project(tmp_path).take_demo()
    (tmp_path / "latin-map.toml").write_bytes(b'[columns]\nrudder_angle_deg = "Ruderlage \xb0"\n')
    (tmp_path / "log-map.toml").write_text('[columns]\nrudder_angle_deg = "R"\n')
    return tmp_path


LOG = '[columns]\nrudder_angle_deg = "R"\n'


@pytest.mark.parametrize(
    ("path", "body", "said"),
    [
        (
            "/api/difference?before=latin-map.toml&after=log-map.toml",
            None,
            "latin-map.toml: is no text in UTF-8",
        ),
        ("/api/jobs", {"verb": []}, "a job names its verb"),
        ("/api/remove", {"ship": "tanker.toml", "output": "new", "effects": 5}, "a list of names"),
        ("/api/remove", {"ship": "tanker.toml", "output": "new", "effects": [5]}, "a list of names"),
        ("/api/remedy", {"name": "log-map.toml", "text": LOG, "edit": {"time": 3}}, "does not fit the map"),
        (
            "/api/remedy",
            {"name": "log-map.toml", "text": LOG, "edit": {"rudder_angle_deg": 3}},
            "does not fit the map",
        ),
        ("/api/remedy", {"name": "log-map.toml", "text": LOG, "edit": {"swap": 1}}, "does not fit the map"),
        (
            "/api/remedy",
            {"name": "latin-map.toml", "text": LOG, "edit": {"time": {"unit": "s"}}},
            "latin-map.toml: is no text in UTF-8",
        ),
    ],
)
def test_what_cannot_be_meant_is_one_line_and_no_failure_of_the_server(folder, path, body, said):
    status, answer = asked(folder, path, body)
    assert status == 400 and said in answer["said"] and "\n" not in answer["said"]


def test_a_ship_has_the_effects_of_its_own_actuators(folder):
    """Expected: those of each thruster, and none of a rudder behind a propeller that a boat has not."""
    craft(*PODS).save(folder / "boat.toml")
    _, effects = asked(folder, "/api/effects?ship=boat.toml")
    names = {e["name"] for e in effects}
    assert "ThrusterWear.port" in names and "PropellerWear" not in names
    _, effects = asked(folder, "/api/effects?ship=tanker.toml")
    names = {e["name"] for e in effects}
    assert "PropellerWear" in names and not [n for n in names if "." in n]
    assert names == {e["name"] for e in asked(folder, "/api/effects")[1]}


def test_what_a_person_noted_stays_in_the_ship_file_without_an_effect(folder):
    ship = folder / "tanker.toml"
    late = '[effects.SensorDelay]\ndelay = { value = 0.1, unit = "s" }\n\n[sources]\n'
    ship.write_text("# dry dock in May\n" + ship.read_text().replace("[sources]\n", late))
    body = {"ship": "tanker.toml", "effects": ["SensorDelay"], "output": "without.toml"}
    assert asked(folder, "/api/remove", body) == (200, {"output": "without.toml"})
    written = (folder / "without.toml").read_text()
    assert written.startswith("# dry dock in May\n") and "[effects.SensorDelay]" not in written
