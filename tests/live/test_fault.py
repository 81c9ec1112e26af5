"""`twin fault`: what it says it does to a channel is what arrives, in a log and on a live bus, and in nothing
else."""

import os
import signal
import subprocess
import sys
import time
from math import isclose

import pytest

from twin import cli, voyages
from twin.live.injection.faulty import SHORT, Faulty, Sample, channels_of
from twin.live.injection.inject import KINDS, InjectedFault, Injector
from twin.live.keelson import messages
from twin.live.keelson.topics import key
from twin.live.log.logfile import LogFile, read, read_rows
from twin.recording.read import read_voyage
from twin.recording.write import write_voyage

VOYAGE = os.path.join(os.path.dirname(voyages.__file__), "monday.mcap")
BY = {"wrong": 7.0, "drift": 0.1, "noise": 2.0}


def said(kind, by=None, n=200, start_s=5.0, seconds=10.0):
    """[(arrival, stamp, values)] of a channel that says its own time, 10 times a second for 20 s."""
    injector = Injector(InjectedFault(kind, KINDS[kind].by if by is None else by, start_s, seconds))
    return [report for i in range(n) for report in injector.feed(0.1 * i, 0.1 * i, (0.1 * i,))]


def inside(reports):
    return [r for r in reports if 5.0 <= r.at_s < 15.0 - 1e-9]


@pytest.mark.parametrize("kind", KINDS)
def test_before_and_after_the_fault_everything_is_as_it_was(kind):
    reports = said(kind, BY.get(kind))
    outside = [r for r in reports if r.at_s < 5.0 or r.at_s >= 18.5]
    assert len(outside) == 50 + 15 and all(r.values == (r.stamp_s,) and r.at_s == r.stamp_s for r in outside)


def test_each_kind_does_what_its_word_says():
    assert inside(said("off")) == []
    assert {r.values for r in inside(said("stuck"))} == {(4.9,)} and all(
        r.stamp_s == r.at_s for r in inside(said("stuck"))
    )
    assert all(r.values is None for r in inside(said("garbage"))) and len(inside(said("garbage"))) == 100
    assert all(isclose(r.values[0], r.stamp_s + 7.0) for r in inside(said("wrong", 7.0)))
    assert len(inside(said("slow", 10.0))) == 10
    assert all(isclose(r.at_s, r.stamp_s + 3.0) for r in said("delayed", 3.0) if 8.0 <= r.at_s < 15.0)
    assert 30 < len(inside(said("intermittent", 0.5))) < 70
    assert isclose(inside(said("drift", 0.1))[-1].values[0], 14.9 + 0.1 * 9.9)
    spread = [r.values[0] - r.stamp_s for r in inside(said("noise", 2.0))]
    assert 1.5 < (sum(x * x for x in spread) / len(spread)) ** 0.5 < 2.5


def test_the_same_seed_gives_the_same_fault():
    assert said("intermittent") == said("intermittent") and said("noise", 2.0) == said("noise", 2.0)


@pytest.mark.parametrize("word", SHORT)
def test_every_short_word_means_channels_that_exist(word):
    assert channels_of(word)


def scalar(subject, value, at_s=1.7e9):
    return Sample(
        at_s,
        key("twin", "ship", subject, "s"),
        "keelson.TimestampedFloat",
        messages.encode_float(value, round(at_s * 1e9)),
    )


def test_a_fault_of_the_rudder_touches_nothing_but_the_rudder():
    faulty = Faulty("rudder", InjectedFault("wrong", 5.0))
    heading = scalar("heading_true_north_deg", 12.0)
    assert faulty.feed(heading) == [heading] and faulty.changed == 0
    (rudder,) = faulty.feed(scalar("rudder_angle_deg", 3.0))
    found = messages.Float.FromString(rudder.payload)
    assert found.value == 8.0 and found.timestamp.seconds == 1_700_000_000
    own = scalar("rudder_angle_deg", 3.0)._replace(key="twin/@v0/ship/pubsub/rudder_angle_deg/twin/estimate")
    assert faulty.feed(own) == [own]


def test_a_position_is_wrong_by_metres():
    fix = messages.encode_fix(57.5, 11.75, 1_700_000_000_000_000_000)
    (moved,) = Faulty("gps", InjectedFault("wrong", 100.0)).feed(
        Sample(1.7e9, key("twin", "ship", "location_fix", "s"), "foxglove.LocationFix", fix)
    )
    found = messages.LocationFix.FromString(moved.payload)
    assert (found.latitude - 57.5) * 111_320 == pytest.approx(100.0, abs=0.01)
    assert (found.longitude - 11.75) * 111_320 * 0.5373 == pytest.approx(100.0, abs=0.1)


def test_every_sources_clock_is_off_and_the_bus_is_dead():
    (late,) = Faulty("clock", InjectedFault("wrong", -1.5)).feed(scalar("yaw_rate_degps", 1.0))
    assert messages.Float.FromString(late.payload).timestamp.seconds == 1_699_999_998
    assert Faulty("bus", InjectedFault("off")).feed(scalar("yaw_rate_degps", 1.0)) == []


def fault(*words):
    return cli.main(["fault", *map(str, words)])


@pytest.mark.parametrize("kind", KINDS)
def test_a_voyage_is_copied_with_the_fault_in_one_column_only(kind, tmp_path):
    by = ("--by", BY[kind]) if kind in BY else ()
    assert (
        fault("rudder", kind, *by, "--from", 60, "--for", 60, "--log", VOYAGE, "-o", tmp_path / "out.mcap")
        == 0
    )
    time_s, true = read_rows(VOYAGE)
    again_s, made = read_rows(tmp_path / "out.mcap")
    assert (again_s == time_s).all()
    during = (time_s - time_s[0] >= 60.0) & (time_s - time_s[0] < 120.0)
    same = (made["rudder_angle_deg"] == true["rudder_angle_deg"]) | (
        (made["rudder_angle_deg"] != made["rudder_angle_deg"])
        & (true["rudder_angle_deg"] != true["rudder_angle_deg"])
    )
    assert (
        not same[during].all()
        and same[time_s - time_s[0] < 60.0].all()
        and same[time_s - time_s[0] > 125.0].all()
    )
    assert all(((made[n] == true[n]) | (made[n] != made[n])).all() for n in true if n != "rudder_angle_deg")


def test_replay_of_a_faulty_voyage_names_the_fault(tmp_path, capsys):
    """Test: the compass off for a minute, then replay. Expected: dead reckoning, and the channel named."""
    short, out = tmp_path / "short.mcap", tmp_path / "out.mcap"
    write_voyage(read_voyage(VOYAGE).between(0.0, 240.0), short)
    assert fault("heading", "off", "--from", 100, "--for", 60, "--log", short, "-o", out) == 0
    capsys.readouterr()
    assert cli.main(["replay", str(out), "--ship", "kvlcc2"]) == 0
    told = capsys.readouterr().out
    assert "dead reckoning" in told and "heading_true_north_deg" in told


@pytest.mark.parametrize(
    "words, code, needed",
    (
        (["ruder", "stuck", "--log", VOYAGE, "-o", "o.mcap"], 2, "Did you mean 'rudder'"),
        (["rudder", "stukc", "--log", VOYAGE, "-o", "o.mcap"], 2, "'stuck'"),
        (["rudder", "--log", VOYAGE, "-o", "o.mcap"], 2, "which fault of 'rudder'?"),
        (["NoSuch"], 2, "no channel is called 'NoSuch'"),
        (["hedding", "stuck"], 2, "Did you mean 'heading'"),
        (["hedding", "no-such"], 2, "no channel is called 'hedding'"),
        (["stuck"], 2, "no channel is called 'stuck'"),
        (["rudder", "wrong", "--log", VOYAGE, "-o", "o.mcap"], 2, "--by"),
        (["rudder", "stuck"], 2, "--listen"),
        (["rudder", "stuck", "--log", VOYAGE], 2, "-o"),
        (["clock", "--log", VOYAGE, "-o", "o.mcap"], 2, "seconds"),
        (["rudder", "wrong", "--by", "nan", "--log", VOYAGE, "-o", "o.mcap"], 2, "finite"),
        (["rudder", "off", "--log", VOYAGE, "-o", VOYAGE], 5, "would be lost"),
        (["depth", "off", "--from", "99999", "--log", VOYAGE, "-o", "o.mcap"], 4, "nothing in it is changed"),
        (["rudder", "off", "--log", "no.mcap", "-o", "o.mcap"], 4, "no.mcap"),
        (["rudder", "off", "--from", "-1", "--log", VOYAGE, "-o", "o.mcap"], 2, "--from"),
        (["pause", "--pid", "1"], 2, "--for"),
        (["pause", "--pid", "99999999", "--for", "1"], 2, "no such process"),
        (["disk", "--pid", "0", "--for", "0.01"], 2, "--pid 0: a process has a number of 1 or more"),
        (["disk", "--pid", "-1", "--for", "0.01"], 2, "--pid -1: a process has a number of 1 or more"),
        (["bus", "stuck", "--log", VOYAGE, "-o", "o.mcap"], 2, "bus takes no kind"),
    ),
)
def test_what_cannot_be_meant_is_one_line_and_leaves_no_file(
    words, code, needed, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert fault(*words) == code
    told = capsys.readouterr().err.strip()
    assert needed in told and "\n" not in told and not list(tmp_path.iterdir())


def test_a_process_is_paused_and_goes_on_and_its_writes_fail_and_succeed_again(tmp_path):
    script = (
        "import os, time\nfd = os.open('x', os.O_CREAT | os.O_WRONLY)\nwhile True:\n    try:\n        "
        "os.write(fd, b'xxxx')\n"
        "        print('good', flush=True)\n    except OSError: print('bad', flush=True)\n    "
        "time.sleep(0.02)\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE, text=True
    )
    try:
        process.stdout.readline()
        began = time.monotonic()
        assert fault("pause", "--pid", process.pid, "--for", 0.3) == 0 and time.monotonic() - began >= 0.3
        assert fault("disk", "--pid", process.pid, "--for", 0.5) == 0
        time.sleep(0.3)
    finally:
        process.send_signal(signal.SIGKILL)
    words = process.stdout.read().split()
    assert "bad" in words and words[-1] == "good"


def test_between_a_sensor_and_a_twin_the_live_bus_has_the_fault(tmp_path):
    """Test: a sensor speaks to the verb, the verb to the twin's bus. Expected: the rudder is off by 5, the
    heading is as it was."""
    from twin.live.demonstration import free_port
    from twin.live.keelson.zenoh_bus import ZenohBus
    from twin.live.keelson.zenoh_config import BusSettings

    there, here = f"tcp/127.0.0.1:{free_port()}", f"tcp/127.0.0.1:{free_port()}"
    rudder, heading = (
        key("twin", "ship", name, "s") for name in ("rudder_angle_deg", "heading_true_north_deg")
    )
    with ZenohBus(BusSettings(listen=there)) as twin:
        command = [
            sys.executable,
            "-m",
            "twin.cli",
            "fault",
            "rudder",
            "wrong",
            "--by",
            "5",
            "--listen",
            here,
            "--connect",
            there,
        ]
        verb = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            assert here in verb.stdout.readline()
            heard = {}
            with ZenohBus(BusSettings(listen="", connect=(here,))) as sensor:
                end = time.monotonic() + 20.0
                while len(heard) < 2 and time.monotonic() < end:
                    now = time.time_ns()
                    for name, value in ((rudder, 3.0), (heading, 40.0)):
                        sensor.publish(name, messages.wrap(messages.encode_float(value, now), now))
                    time.sleep(0.05)
                    heard |= {
                        name: messages.Float.FromString(messages.unwrap(data)[1]).value
                        for name, data, _ in twin.drain(1.0)
                    }
            verb.terminate()
            assert verb.wait(10) == 0
        finally:
            verb.kill()
    assert heard == {rudder: 8.0, heading: 40.0}


def test_a_log_of_keelson_scalars_is_copied_with_what_is_delayed_behind(tmp_path):
    with LogFile(tmp_path / "a.mcap") as log:
        for i in range(100):
            ns = 1_700_000_000_000_000_000 + i * 100_000_000
            for name in ("rudder_angle_deg", "heading_true_north_deg"):
                log.add(
                    key("twin", "ship", name, "s"),
                    "keelson.TimestampedFloat",
                    messages.encode_float(float(i), ns),
                    ns,
                )
    assert fault("rudder", "delayed", "--by", 1, "--log", tmp_path / "a.mcap", "-o", tmp_path / "b.mcap") == 0
    late = [m for m in read(tmp_path / "b.mcap") if "rudder" in m.topic]
    assert len(late) == 90
    assert all(
        m.log_ns - messages.Float.FromString(m.data).timestamp.ToNanoseconds() == pytest.approx(1e9, abs=1e6)
        for m in late
    )
