"""Names that lead out of a folder (Q7), and secrets that must not leave theirs (Q8)."""

import socket
import subprocess
import sys

from twin import cli
from twin.live.clock import Instant
from twin.live.inbox import Inbox
from twin.live.keelson import messages
from twin.live.keelson.bus import MemoryBus
from twin.live.log.logfile import LogFile
from twin.live.log.mcap_index import ATTACHMENT, DATA_END, record, text
from twin.live.log.record import Recorder

OUT = "../../../escaped"
CANARY = "canary-7f3a9c"


def test_Q7_a_key_that_leads_out_of_the_folder_is_a_name_and_no_path(tmp_path):
    """Test: sources called ../../x on the bus. Expected: logged or refused, and no file outside the log's
    folder."""
    folder = tmp_path / "a" / "b" / "logs"
    with Recorder(folder) as recorder:
        bus = MemoryBus()
        inbox = Inbox(bus, recorder.write)
        for source in (OUT, "/etc/shiptwin", "..", "x\0y", "a/../../b"):
            now = 1_700_000_000_000_000_000
            bus.put(
                f"twin/@v0/ship/pubsub/rudder_angle_deg/{source}",
                messages.wrap(messages.encode_float(1.0, now), now),
            )
            bus.put(
                f"{OUT}/@v0/ship/pubsub/rudder_angle_deg/x",
                messages.wrap(messages.encode_float(1.0, now), now),
            )
        inbox.read(Instant(0, 1.0, 1.7e9))
    assert {p.relative_to(tmp_path).parts[0] for p in tmp_path.rglob("*")} == {"a"}
    assert [p.suffix for p in folder.iterdir()] == [".mcap"]


def test_Q7_an_attachment_whose_name_leads_out_of_the_folder_is_not_unpacked(tmp_path, monkeypatch):
    """Test: a log with an attachment called ../../../escaped, copied and replayed. Expected: one new file,
    the one that was asked for."""
    folder = tmp_path / "a" / "b" / "c"
    folder.mkdir(parents=True)
    monkeypatch.chdir(folder)
    with LogFile("in.mcap") as log:
        for i in range(200):
            ns = 1_700_000_000_000_000_000 + i * 100_000_000
            log.add(
                "twin/@v0/ship/pubsub/heading_true_north_deg/s",
                "keelson.TimestampedFloat",
                messages.encode_float(10.0, ns),
                ns,
            )
    data = (folder / "in.mcap").read_bytes()
    end = data.rindex(record(DATA_END, b"\0\0\0\0"))
    attached = record(
        ATTACHMENT, bytes(16), text(OUT), text("text/plain"), (4).to_bytes(8, "little"), b"evil", bytes(4)
    )
    (folder / "in.mcap").write_bytes(data[:end] + attached + data[end:])
    assert cli.main(["replay", "in.mcap", "--ship", "kvlcc2", "-o", "out.mcap"]) == 0
    assert sorted(p.name for p in tmp_path.rglob("*") if p.is_file()) == ["in.mcap", "out.mcap"]


def test_Q8_a_password_of_the_bus_is_in_no_log_no_message_and_no_health(tmp_path):
    """Test: a Zenoh file with a user's password, also one that is wrong. Expected: it stands nowhere but in
    that file."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    zenoh = tmp_path / "zenoh.json5"
    auth = f'transport: {{auth: {{usrpwd: {{user: "twin", password: "{CANARY}"}}}}}}'
    zenoh.write_text(f'{{mode: "peer", listen: {{endpoints: ["tcp/127.0.0.1:{port}"]}}, {auth}}}')
    (tmp_path / "twin.toml").write_text(
        f'[loop]\npriority = 0\nlock_memory = false\n[bus]\nfile = "{zenoh}"\n[log]\nfolder = '
        f'"{tmp_path}/logs"\n[state]\nfolder = "{tmp_path}/state"\n'
    )
    twin = [sys.executable, "-m", "twin.cli"]
    run = subprocess.Popen(
        [*twin, "run", "--config", tmp_path / "twin.toml", "--duration", "6"],
        stderr=subprocess.PIPE,
        text=True,
    )
    health = subprocess.run(
        [*twin, "health", "--config", tmp_path / "twin.toml", "--timeout", "5"],
        capture_output=True,
        text=True,
        timeout=60,
    )
    said = [run.communicate(timeout=60)[1], health.stdout, health.stderr]
    assert run.returncode == 0 and "KVLCC2" in said[0] and health.stdout, said
    zenoh.write_text(zenoh.read_text().replace("tcp/127", "nonsense/127"))
    bad = subprocess.run(
        [*twin, "run", "--config", tmp_path / "twin.toml"], capture_output=True, text=True, timeout=60
    )
    zenoh.write_text(zenoh.read_text().replace("user:", "no_such_key:"))
    worse = subprocess.run(
        [*twin, "run", "--config", tmp_path / "twin.toml"], capture_output=True, text=True, timeout=60
    )
    assert bad.returncode == worse.returncode == 5
    said += [bad.stderr, worse.stderr]
    assert not [text for text in said if CANARY in text]
    files = [p for p in tmp_path.rglob("*") if p.is_file() and p != zenoh]
    assert files and not [p for p in files if CANARY.encode() in p.read_bytes()]
