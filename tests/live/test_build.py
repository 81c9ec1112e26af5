"""From settings to a loop: where its certificate comes from, and what is said when there is none."""

import hashlib
import json
from importlib import resources
from pathlib import Path

import pytest

from twin.live.build import certificate_file, loop_of, residual_of, stabilizer_of
from twin.live.certificate.certificate import Certificate
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.physics.ship import load

TANKER = Path(str(resources.files("twin.voyages"))) / "tanker.toml"


@pytest.fixture
def at_home(tmp_path, monkeypatch):
    """A home folder in which nothing is on file."""
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


def ship_file(folder, mass_kg):
    """A file tanker.toml in a folder of its own: KVLCC2 with another mass."""
    text = (resources.files("twin.ships") / "kvlcc2.toml").read_text(encoding="utf-8")
    path = folder / mass_kg / "tanker.toml"
    path.parent.mkdir()
    path.write_text(text.replace("m = { value = 320415000.0", f"m = {{ value = {mass_kg}"), encoding="utf-8")
    return str(path)


def test_two_ships_whose_files_have_one_name_keep_a_certificate_each(at_home):
    """Test: the same file name in two folders, two masses. Expected: two files, each of its own ship, and
    both are found again."""
    files = [ship_file(at_home, mass_kg) for mass_kg in ("320415000.0", "350000000.0")]
    made = [stabilizer_of(Settings({"ship.file": path}), load(path), None).tube.certificate for path in files]
    assert (
        made[0].fingerprint != made[1].fingerprint
        and len(list((at_home / ".cache" / "shiptwin").iterdir())) == 2
    )
    for path, certificate in zip(files, made, strict=True):
        assert stabilizer_of(Settings({"ship.file": path}), load(path), 0.0).tube.certificate == certificate


def test_a_certificate_that_is_not_ready_in_time_is_one_clear_line(at_home):
    """Test: no patience at all. Expected: no tube; the reason is one line with the seconds, not another
    process's command."""
    made = stabilizer_of(Settings({"ship.file": "kvlcc2"}), load("kvlcc2"), 0.0)
    assert made.tube is None and made.why_not == (
        "not worked out (not ready after 0 s. Start again when the machine is less busy)"
    )


def test_where_no_file_can_be_written_there_is_a_certificate_all_the_same(at_home):
    settings = Settings({"ship.file": "kvlcc2", "observer.certificate": "/proc/none/certificate.json"})
    assert stabilizer_of(settings, load("kvlcc2"), None).tube.certificate.ship == "KVLCC2"


def test_settings_name_the_certificates_file_before_the_cache_does(at_home):
    assert (
        certificate_file(Settings({"state.folder": "/var/lib/shiptwin"}), "mark").as_posix()
        == "/var/lib/shiptwin/certificate.json"
    )
    assert (
        certificate_file(Settings({"ship.file": "x/alma.toml"}), "mark").name == "alma-mark.certificate.json"
    )


def test_a_certificate_whose_file_was_changed_is_worked_out_again(at_home):
    """Test: K, the bound and a slope changed by hand, NaN put in, every change with and without a fresh
    checksum. Expected: none is believed, and the file is written anew."""
    settings, ship = (
        Settings({"ship.file": "kvlcc2", "observer.certificate": str(at_home / "c.json")}),
        load("kvlcc2"),
    )
    good = stabilizer_of(settings, ship, None).tube.certificate
    text = (at_home / "c.json").read_text()
    for change in (
        {"K": [5.0] * 3},
        {"bound": [0.0] * 3},
        {"noise": [float("nan")] * 3},
        {"ok": False},
        {"margin": 1.0},
        {"calm": [0.0] * 3},
        {"delays": [0, 0, 0]},
    ):
        for signed in (False, True):
            table = json.loads(text) | change
            body = {k: x for k, x in table.items() if k not in ("version", "sha256")}
            table["sha256"] = (
                hashlib.sha256(json.dumps(body, sort_keys=True).encode()).hexdigest()
                if signed
                else table["sha256"]
            )
            with pytest.raises(ValueError):
                Certificate.from_json(json.dumps(table))
    (at_home / "c.json").write_text(text.replace('"margin": 0.7', '"margin": 0.9'))
    assert (
        stabilizer_of(settings, ship, None).tube.certificate == good
        and (at_home / "c.json").read_text() == text
    )


def test_a_network_of_another_model_is_a_short_alarm_and_its_file_stands_in_the_log_alone():
    """Test: the bundled tanker, calibrated from the ship whose network comes with the twin. Expected: the alarm is
    one short sentence without a path or a hash; the log says which file and what to do."""
    tanker = load(TANKER)
    residual, alarm, logged = residual_of(Settings({"ship.file": str(TANKER)}), tanker)
    assert residual is None and len(alarm) < 70 and not set('/\\()"') & set(alarm) and ".onnx" not in alarm
    assert "kvlcc2.residual.onnx" in logged and "twin train" in logged
    loop = loop_of(Settings({"ship.file": str(TANKER)}), Played([]), Outbox(Publisher(), "twin", "ship"), 0.0)
    said = loop.tick(Instant(0, 0.0, 1.7e9)).reasons
    assert not [text for text in [*said, *loop.notes] if ".onnx" in text]
    assert loop.logged == [logged]


def test_a_ship_without_a_network_says_so_in_a_short_alarm(at_home):
    path = ship_file(at_home, "320415000.0")
    other = Path(path).with_name("other.toml")
    other.write_text(Path(path).read_text().replace("KVLCC2", "Alma"))
    _, alarm, logged = residual_of(Settings({"ship.file": str(other)}), load(other))
    assert alarm == "no network has been trained for this ship" and "twin train" in logged
