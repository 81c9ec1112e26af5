"""The workbench's server: who may come in, what it reads and writes, and what a hostile request gets."""

import http.client
import json
import subprocess
import sys
import time

import anyio
import pytest

from tests import command_lines
from twin.studio.app import Studio
from twin.studio.project import Project


class Client:
    """A browser's requests, written by hand."""

    def __init__(self, served):
        self.port = served.port
        status, headers, _ = self.ask("/" + served.links[0].rpartition("/")[2], cookie=None)
        assert status == 303
        self.cookie = headers["set-cookie"].partition(";")[0]
        assert "HttpOnly" in headers["set-cookie"] and "samesite=strict" in headers["set-cookie"].lower()

    def ask(self, path, body=None, cookie=True, **more):
        """(status, headers, body); a body makes it a POST of our own page."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        host = f"127.0.0.1:{self.port}"
        headers = {"Host": host} | ({"Cookie": self.cookie} if cookie and cookie is not None else {})
        if body is not None:
            headers["Origin"] = f"http://{host}"
            body = body if isinstance(body, bytes) else json.dumps(body).encode()
        headers |= {name.replace("_", "-"): value for name, value in more.items()}
        method = "GET" if body is None else "POST"
        connection.request(method, path, body, {k: v for k, v in headers.items() if v is not None})
        answer = connection.getresponse()
        said = answer.read()
        connection.close()
        return answer.status, {k.lower(): v for k, v in answer.getheaders()}, said

    def json(self, path, body=None):
        status, _, said = self.ask(path, body)
        return status, json.loads(said)

    def done(self, asked, seconds=120):
        """A job, when it is over."""
        status, said = self.json("/api/jobs", asked)
        assert status == 200, said
        until = time.monotonic() + seconds
        while (job := self.json(f"/api/jobs/{said['job']}")[1])["state"] in ("waiting", "running"):
            assert time.monotonic() < until, job
            time.sleep(0.1)
        return job


@pytest.fixture(scope="module")
def client(served):
    return Client(served)


def test_without_the_cookie_nothing_is_answered(served, client):
    for path in ("/", "/app/main.js", "/api/project", "/api/files/monday.mcap", "/events", "/live"):
        assert client.ask(path, cookie=None)[0] == 403, path
    assert client.ask("/api/demo", {}, cookie=None)[0] == 403


def test_a_link_opens_once(served, client):
    assert client.ask("/" + served.links[0].rpartition("/")[2], cookie=None)[0] == 403


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "evil.example:80"},
        {"Origin": "http://evil.example"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Origin": "null"},
    ],
)
def test_another_name_or_another_page_is_refused(client, headers):
    assert client.ask("/api/demo", {}, **headers)[0] == 403
    assert client.ask("/api/project", **headers)[0] == 403


def test_a_change_without_an_origin_is_refused(client):
    assert client.ask("/api/demo", {}, Origin=None)[0] == 403


def test_every_answer_forbids_inline_script_and_other_places(client):
    for path in ("/", "/api/project", "/app/uplot.js", "/nowhere"):
        policy = client.ask(path)[1]["content-security-policy"]
        assert "script-src 'self'" in policy and "unsafe" not in policy and "default-src 'none'" in policy


@pytest.mark.parametrize(
    "name", ["../outside.csv", "%2e%2e%2foutside.csv", ".hidden", "a%00b", "-rf", "x" * 200, "a%2Fb.csv"]
)
def test_no_name_leads_out_of_the_folder(client, project, name):
    before = sorted(p.name for p in project.folder.iterdir())
    assert client.ask(f"/api/files/{name}", b"time_s\n0\n")[0] in (400, 404)
    assert client.ask(f"/api/files/{name}")[0] == 404
    assert sorted(p.name for p in project.folder.iterdir()) == before
    assert not (project.folder.parent / "outside.csv").exists()


def test_a_link_out_of_the_folder_is_not_followed(client, project, tmp_path_factory):
    secret = tmp_path_factory.mktemp("elsewhere") / "secret.csv"
    secret.write_text("secret")
    (project.folder / "inside.csv").symlink_to(secret)
    assert client.ask("/api/files/inside.csv")[0] == 404
    assert client.json("/api/jobs", {"verb": "look", "file": "inside.csv"})[0] == 400


def test_a_file_is_taken_whole_and_never_over_another(client, project):
    assert client.ask("/api/files/new.csv", b"time_s,rudder_angle_deg\n0,1\n")[0] == 200
    assert (project.folder / "new.csv").read_bytes() == b"time_s,rudder_angle_deg\n0,1\n"
    status, said = client.json("/api/files/new.csv", b"other")
    assert status == 400 and "is there already" in said["said"]
    assert (project.folder / "new.csv").read_bytes().startswith(b"time_s")


def test_a_file_that_is_too_long_leaves_nothing_behind(project):
    app, answers = Studio(project.folder, most_upload=1000).app(), []
    parts = iter([{"type": "http.request", "body": b"x" * 600, "more_body": True}] * 2)
    scope = {
        "type": "http",
        "method": "POST",
        "path": "/api/files/long.csv",
        "headers": [],
        "query_string": b"",
    }

    async def receive():
        return next(parts)

    async def send(message):
        answers.append(message)

    anyio.run(app, scope, receive, send)
    assert answers[0]["status"] == 400 and b"longer than 1000 bytes" in answers[1]["body"]
    assert not [p.name for p in project.folder.iterdir() if "long" in p.name or "upload" in p.name]


def test_what_is_asked_amiss_gets_one_line(client):
    for asked, words in (
        ({"verb": "rm"}, "names its verb"),
        ({"verb": "compare", "ship": "tanker.toml"}, "needs voyages"),
        ({"verb": "compare", "ship": "tanker.toml", "voyages": ["none.mcap"]}, "is not in this project"),
        ({"verb": "compare", "ship": "/etc/passwd", "voyages": ["monday.mcap"]}, "is no name of a file"),
        ({"verb": "compare", "ship": "tanker.toml", "voyages": "monday.mcap"}, "must be a list"),
        ({"verb": "look", "file": "monday.mcap", "shell": "x"}, "nothing that it knows"),
        (
            {
                "verb": "add",
                "ship": "tanker.toml",
                "voyages": ["monday.mcap"],
                "effects": ["HullFouling"],
                "output": "tanker.toml",
            },
            "is there already",
        ),
        ([], "one JSON object"),
    ):
        status, said = client.json("/api/jobs", asked)
        assert status == 400 and words in said["said"] and "\n" not in said["said"]


def test_reading_only_changes_nothing(project, serve):
    served = serve(project.folder, "--read-only")
    try:
        client, before = Client(served), sorted(p.name for p in project.folder.iterdir())
        assert client.json("/api/project")[1]["read_only"]
        for path, body in (
            ("/api/files/x.csv", b"x"),
            ("/api/demo", {}),
            ("/api/tags", {"file": "monday.mcap", "tag": "reference"}),
            ("/api/jobs", {"verb": "look", "file": "monday.mcap"}),
            *((f"/api/{of}", {}) for of in ("ships", "maps", "remove")),
        ):
            assert "reading only" in client.json(path, body)[1]["said"], path
        assert sorted(p.name for p in project.folder.iterdir()) == before
    finally:
        served.stop()


def test_a_job_that_fails_says_the_line_and_code_of_the_command_line(client, project):
    (project.folder / "broken.csv").write_text("time_s,rudder_angle_deg\n0,1\n1,2\n")
    job = client.done({"verb": "import", "file": "broken.csv", "output": "broken.mcap"})
    assert job["state"] == "failed" and job["exit_code"] == 4 and "broken.csv" in job["said"]
    assert not (project.folder / "broken.mcap").exists()


def test_a_cancelled_job_stops_and_can_be_asked_again(client, project):
    _, said = client.json(
        "/api/jobs", {"verb": "diagnose", "ship": "tanker.toml", "voyages": ["monday.mcap"]}
    )
    name = said["job"]
    until = time.monotonic() + 30
    while client.json(f"/api/jobs/{name}")[1]["state"] == "waiting":
        assert time.monotonic() < until
        time.sleep(0.05)
    pid = json.loads((project.folder / "jobs" / name / "worker.json").read_text())["pid"]
    assert client.json(f"/api/jobs/{name}/cancel", {})[0] == 200
    assert client.json(f"/api/jobs/{name}")[1]["state"] == "cancelled"
    from twin.studio.jobs import born

    while born(pid):
        assert time.monotonic() < until
        time.sleep(0.05)
    assert client.json(f"/api/jobs/{name}/forget", {})[0] == 200
    assert not (project.folder / "jobs" / name).exists()


def test_the_tags_are_a_plain_file(client, project):
    assert client.json("/api/tags", {"file": "monday.mcap", "tag": "reference"})[0] == 200
    assert Project(project.folder).tags() == {"monday.mcap": "reference", "tuesday.mcap": "held_out"}
    assert client.json("/api/tags", {"file": "monday.mcap", "tag": "<script>"})[0] == 400


def test_a_first_model_is_tried_and_written_as_twin_init_writes_it(client, project):
    values = {"length-pp-m": 180, "beam-m": 30, "draught-m": 10.5}
    status, tried = client.json(
        "/api/ships/try", {"name": "MV Alma", "values": values, "output": "alma.toml"}
    )
    assert (
        status == 200
        and tried["command"]
        == "twin init 'MV Alma' --length-pp-m 180 --beam-m 30 --draught-m 10.5 -o alma.toml"
    )
    assert client.json("/api/ships", {"name": "MV Alma", "values": values, "output": "alma.toml"})[0] == 200
    from twin.cli import main

    other = project.folder / "other.toml"
    assert main(command_lines.init("MV Alma", "-o", other)) == 0
    assert (project.folder / "alma.toml").read_text() == other.read_text()
    status, said = client.json("/api/ships/try", {"name": "x", "values": values | {"beam-m": 300}})
    assert status == 400 and "--beam-m 300 lies outside" in said["said"]


def test_the_ships_page_gets_numbers_with_sources_and_a_measured_turn(client):
    ship = client.json("/api/ships/tanker.toml")[1]
    assert (
        ship["calibrated"] and len(ship["derivatives"]) == 39 and ship["trial"]["limits"][0]["limit"] == 4.5
    )
    assert {p["name"]: p["source"] for p in ship["particulars"]}["L_pp"] == "YY15"
    turn = client.json("/api/turn?ship=tanker.toml&voyage=monday.mcap")[1]
    assert turn["turned_deg"] > 10 and turn["y"][-1] > 0.5


def test_a_log_of_a_twin_is_shown_on_the_bridges_page(client, project):
    """Test: a minute of Monday through the loop, attached. Expected: the page, its frames, and nothing after leaving."""
    from twin.recording.read import read_voyage
    from twin.recording.write import write_voyage

    write_voyage(
        read_voyage(project.folder / "monday.mcap").between(0.0, 60.0), project.folder / "minute.mcap"
    )
    words = [
        sys.executable,
        "-m",
        "twin",
        "replay",
        "minute.mcap",
        "--ship",
        "tanker.toml",
        "-o",
        "ticks.mcap",
    ]
    subprocess.run(words, cwd=project.folder, check=True, capture_output=True, timeout=120)
    assert client.ask("/events")[0] == 404
    assert client.json("/api/live", {"log": "ticks.mcap"}) == (200, {"name": "ticks.mcap"})
    assert client.json("/api/project")[1]["live"] == "ticks.mcap" and b"chart.js" in client.ask("/main.js")[2]
    connection = http.client.HTTPConnection("127.0.0.1", client.port, timeout=20)
    connection.request(
        "GET", "/events", headers={"Host": f"127.0.0.1:{client.port}", "Cookie": client.cookie}
    )
    answer = connection.getresponse()
    frame = next(line for line in iter(answer.readline, b"") if line.startswith(b"data: {"))
    connection.close()
    assert json.loads(frame[6:])["ship"]["ship"] == "KVLCC2"
    assert (
        client.json("/api/live", {"leave": True})[0] == 200 and client.json("/api/project")[1]["live"] == ""
    )
