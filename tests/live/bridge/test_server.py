"""The bridge's page: who may see it, and what is served at all."""

import http.client
import json
import signal
import socket
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.command_lines import hears_interrupts
from twin.errors import TwinError
from twin.live.bridge.server import MAX_BODY, NAMES, Server


def ask(server, path, method="GET", body=None, **headers):
    """(status, headers, body) of a request as it is written, the path untouched."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
    sent = {"Host": f"127.0.0.1:{server.port}"} | {name.replace("_", "-"): v for name, v in headers.items()}
    connection.putrequest(method, path, skip_host=True)
    for name, value in sent.items():
        connection.putheader(name, value)
    data = b"" if body is None else json.dumps(body).encode()
    if body is not None:
        connection.putheader("Content-Length", str(len(data)))
    connection.endheaders(data or None)
    answer = connection.getresponse()
    said = answer.status, dict(answer.getheaders()), b"" if path == "/events" else answer.read()
    connection.close()
    return said


def let_in(server, links):
    """The cookie that the newest link gives."""
    status, headers, _ = ask(server, "/" + links[-1].rpartition("/")[2])
    assert status == 303 and headers["Location"] == "/"
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(headers["Set-Cookie"].split("; "))
    return headers["Set-Cookie"].partition(";")[0]


def test_an_installation_gets_every_file_of_the_page():
    pyproject = Path(__file__).parents[3] / "pyproject.toml"
    kept = tomllib.loads(pyproject.read_text())["tool"]["setuptools"]["package-data"]["twin.live.bridge"]
    assert {f"*.{name.rpartition('.')[2]}" for name in NAMES} <= set(kept)


def test_it_listens_on_loopback_only(server):
    assert server.server_address[0] == "127.0.0.1"


@pytest.mark.parametrize(
    "path", ["/", "/main.js", "/page.css", "/events", "/?token=", "/?token=wrong", "/none"]
)
def test_without_the_link_nothing_is_served(server, path):
    status, _, body = ask(server, path)
    assert status == 403 and b"<html" not in body
    assert ask(server, path, Cookie=f"{server.cookie}=wrong")[0] == 403


def test_a_link_opens_the_page_once_and_the_next_link_is_said(server, links):
    first = "/" + links[0].rpartition("/")[2]
    cookie = let_in(server, links)
    assert ask(server, first)[0] == 403
    assert len(links) == 2 and links[0] != links[1]
    assert ask(server, "/", Cookie=cookie)[0] == 200
    assert let_in(server, links) == cookie


def test_every_file_of_the_page_is_served_with_a_policy_that_lets_no_other_script_run(server, links):
    cookie = let_in(server, links)
    for name in NAMES:
        status, headers, body = ask(server, "/" if name == "page.html" else f"/{name}", Cookie=cookie)
        assert status == 200 and body
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy and "script-src 'self'" in policy and "unsafe" not in policy
        assert headers["X-Content-Type-Options"] == "nosniff" and headers["Cache-Control"] == "no-store"
    page = ask(server, "/", Cookie=cookie)[2]
    assert b"style=" not in page and b"onclick" not in page and page.count(b"<script") == 1


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1", "", "127.0.0.1:1"])
def test_another_name_is_refused_also_with_the_cookie(server, links, host):
    """Test: a page elsewhere lets its own name point here. Expected: refused."""
    assert ask(server, "/", Cookie=let_in(server, links), Host=host)[0] == 403


@pytest.mark.parametrize("header", [{"Origin": "http://evil.example"}, {"Sec_Fetch_Site": "cross-site"}])
def test_another_page_is_refused_also_with_the_cookie(server, links, header):
    cookie = let_in(server, links)
    for path in ("/", "/events", "/main.js"):
        assert ask(server, path, Cookie=cookie, **header)[0] == 403


PATHS = [
    "/../server.py",
    "/..%2fserver.py",
    "/server.py",
    "//etc/passwd",
    "/etc/passwd",
    "/%2e%2e/%2e%2e/etc/passwd",
    "/page.css/../server.py",
    "/main.js%00.html",
    "\\..\\server.py",
    "/" + "a/" * 3000,
]


@pytest.mark.parametrize("path", PATHS)
def test_a_path_leads_to_no_file(server, links, path):
    status, _, body = ask(server, path, Cookie=let_in(server, links))
    assert status in (400, 404, 414) and b"root:" not in body and b"import" not in body


def test_an_alarm_is_acknowledged_by_our_own_page_only(server, links, watch, feed, ticks):
    ticks[-1].reasons.append("rudder_angle_deg is lost")
    feed.give(ticks[-1])
    watch.step(1.0)
    (alarm,) = [a for a in watch.frame["alarms"] if "rudder" in a["text"]]
    cookie, ours = let_in(server, links), f"http://127.0.0.1:{server.port}"
    body = {"key": alarm["key"]}
    assert ask(server, "/acknowledge", "POST", body, Cookie=cookie)[0] == 403
    assert ask(server, "/acknowledge", "POST", body, Cookie=cookie, Origin="null")[0] == 403
    assert ask(server, "/acknowledge", "POST", body, Origin=ours)[0] == 403
    assert not watch.step(1.1)["alarms"][0]["acknowledged"]
    assert ask(server, "/acknowledge", "POST", body, Cookie=cookie, Origin=ours)[0] == 204
    assert [a["acknowledged"] for a in watch.step(1.2)["alarms"] if "rudder" in a["text"]] == [True]


@pytest.mark.parametrize("body", [[], "x", {"key": 3}, {}, {"key": "x" * (MAX_BODY + 1)}])
def test_what_is_no_alarm_is_refused(server, links, body):
    ours = f"http://127.0.0.1:{server.port}"
    cookie = let_in(server, links)
    assert ask(server, "/acknowledge", "POST", body, Cookie=cookie, Origin=ours)[0] == 400


def test_a_request_that_is_never_finished_holds_up_nobody(server, links):
    with socket.create_connection(("127.0.0.1", server.port)) as slow:
        slow.sendall(b"GET / HT")
        assert ask(server, "/", Cookie=let_in(server, links))[0] == 200


def test_a_port_that_is_taken_is_one_line(server, watch):
    with pytest.raises(TwinError, match=r"--port"):
        Server(watch, server.port, print)


def test_a_view_that_is_interrupted_ends_as_one_that_was():
    command = [sys.executable, "-m", "twin", "view", "--port", "0", "--connect", "tcp/127.0.0.1:1"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=hears_interrupts
    ) as process:
        try:
            assert process.stdout.readline().startswith("open once: ")
            process.send_signal(signal.SIGINT)
            assert process.wait(20) == 130
            assert "interrupted" in process.stderr.read().splitlines()  # the bus may still say something
        finally:
            process.kill()
