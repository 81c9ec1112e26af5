"""Sessions over TLS with the settings in deploy/: who may speak, who may look, who does not get in."""

import json
import re
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import pytest

DEPLOY = Path(__file__).parents[2] / "deploy"
SESSIONS = Path(__file__).parent / "sessions.py"

pytestmark = pytest.mark.skipif(not shutil.which("openssl"), reason="openssl is not installed")


@pytest.fixture(scope="module")
def tls(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tls")
    for authority in ("ours", "other"):
        command = [DEPLOY / "make-certificates.sh", folder / authority, "127.0.0.1", "localhost"]
        subprocess.run(command, check=True, capture_output=True)
    return folder


@pytest.fixture
def settings(tls, tmp_path):
    """`settings(who, file, certificates)` writes a session's file with this test's port and certificates."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]

    def write(who, source, folder="ours"):
        text = (DEPLOY / source).read_text().replace("/etc/shiptwin/tls", str(tls / folder))
        text = text.replace(":7447", f":{port}").replace("timeout_ms: -1", "timeout_ms: 2000")
        path = tmp_path / f"{who}-{folder}.json5"
        path.write_text(re.sub(r"/sensors\.(pem|key)", rf"/{who}.\1", text))
        return str(path)

    return write


def said(settings, who, *keys, folder="ours"):
    """What the twin hears and what a viewer sees when `who` puts on `keys` and the twin puts on its own."""
    client = "zenoh-client.json5"
    files = settings("twin", "zenoh.json5"), settings(who, client, folder), settings("viewer", client)
    command = [sys.executable, SESSIONS, *files, *keys]
    done = subprocess.run(command, capture_output=True, text=True, timeout=40)
    assert done.returncode == 0, done.stderr
    lines = dict(line.split(":", 1) for line in done.stdout.splitlines())
    return lines["twin heard"].split(), lines["viewer saw"].split()


HEADING = "twin/@v0/ship/pubsub/heading_true_north_deg/gyro"
FORGED = "twin/@v0/ship/pubsub/yaw_rate_degps/twin/estimate"
OWN = "twin/@v0/ship/pubsub/twin_tick/twin"


def test_sensors_are_heard_and_a_viewer_sees_the_twin(settings):
    heard, seen = said(settings, "sensors", HEADING)
    assert heard == [HEADING]
    assert OWN in seen


def test_nobody_else_speaks_as_the_twin(settings):
    heard, seen = said(settings, "sensors", FORGED, OWN, HEADING)
    assert heard == [HEADING]
    assert FORGED not in seen and seen.count(OWN) == 1


def test_a_viewer_cannot_speak(settings):
    assert said(settings, "viewer", HEADING)[0] == []


def test_a_certificate_of_another_authority_does_not_get_in(settings):
    assert said(settings, "sensors", HEADING, folder="other")[0] == []


def test_health_hears_a_twin_that_speaks_over_tls(settings, tmp_path):
    """Test: the service with the Zenoh file of deploy/. Expected: heard, though nobody measures yet."""
    (tmp_path / "twin.toml").write_text(
        '[loop]\nrate_hz = 20.0\npriority = 0\nlock_memory = false\n[log]\nfolder = ""\n[bus]\nfile = '
        f'"{settings("twin", "zenoh.json5")}"\n'
    )
    twin = [sys.executable, "-m", "twin.cli"]
    process = subprocess.Popen(
        [*twin, "run", "--config", str(tmp_path / "twin.toml")], stderr=subprocess.PIPE, text=True
    )
    try:
        assert "KVLCC2" in process.stderr.readline()
        health = [*twin, "health", "--config", str(tmp_path / "twin.toml"), "--timeout", "10", "--json", "-"]
        done = subprocess.run(health, capture_output=True, text=True, timeout=60)
    finally:
        process.terminate()
        process.wait(10)
    assert json.loads(done.stdout)["mode"] == "starting", done.stdout + done.stderr
