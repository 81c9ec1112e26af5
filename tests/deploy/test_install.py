"""Install, upgrade and roll back in a folder instead of a computer's root; systemd is a script that notes
what it is told."""

import hashlib
import os
import re
import shutil
import subprocess
import time
import zipfile
from pathlib import Path

import pytest

from tests.deploy.copied_environments import copying_python

ROOT = Path(__file__).parents[2]
DEPLOY = ROOT / "deploy"
PYTHON = {}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """This source as a wheel, so that two installations build only once; they take no dependencies along."""
    folder, source = tmp_path_factory.mktemp("wheel"), tmp_path_factory.mktemp("source")
    for name in ("twin", "export", "bench"):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    command = ["python3", "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder, source]
    done = subprocess.run(command, capture_output=True, text=True, timeout=180)
    if done.returncode != 0:
        pytest.skip(f"no wheel can be built here: {done.stderr.strip().splitlines()[-1:]}")
    return next(folder.glob("shiptwin-*.whl"))


@pytest.fixture(scope="module", autouse=True)
def ready(tmp_path_factory):
    """Environments are copied; the first installation (`two_versions`) makes its own as a ship does."""
    PYTHON["PYTHON"] = str(copying_python(tmp_path_factory.mktemp("ready")))
    yield
    PYTHON.clear()


def tried(name, root, *arguments, **env):
    """What a script did for a root whose files are closed to others (umask 077); without a lock, so that
    nothing is fetched."""
    env = os.environ | {"ROOT": str(root), "LOCK": "", "SETTLE_S": "0"} | PYTHON | env
    command = [DEPLOY / name, *arguments]
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=180, umask=0o077)


def script(name, root, *arguments, **env):
    done = tried(name, root, *arguments, **env)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def running(root):
    return os.readlink(root / "opt/shiptwin/current").removeprefix("versions/")


@pytest.fixture(scope="module")
def two_versions(wheel, tmp_path_factory):
    """(root, first, second): installed one after the other, with a setting changed in between."""
    root = tmp_path_factory.mktemp("root")
    script("install.sh", root, wheel, PYTHON="python3")
    first = running(root)
    (root / "etc/shiptwin/twin.toml").write_text("[ship]\nfile = 'mine.toml'\n")
    time.sleep(1.1)  # versions are named by the second
    script("install.sh", root, wheel)
    return root, first, running(root)


def test_versions_stand_side_by_side_and_the_new_one_runs(two_versions):
    root, first, second = two_versions
    assert first != second
    assert {p.name for p in (root / "opt/shiptwin/versions").iterdir()} == {first, second}


def test_the_installed_command_works(two_versions):
    command = [two_versions[0] / "opt/shiptwin/current/bin/twin", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, cwd="/")
    assert done.returncode == 0 and "digital twin" in done.stdout


def test_what_a_root_with_umask_077_installed_is_open_to_the_service(two_versions):
    paths = [path for path in two_versions[0].rglob("*") if not path.is_symlink()]
    closed = [path for path in paths if ~path.stat().st_mode & (0o005 if path.is_dir() else 0o004)]
    assert len(paths) > 100 and not closed


def test_settings_that_are_there_stay(two_versions):
    assert "mine.toml" in (two_versions[0] / "etc/shiptwin/twin.toml").read_text()


def unit(root, name="shiptwin.service"):
    """What systemd would read, inside this trial's root."""
    return root / os.readlink(root / "etc/systemd/system" / name).lstrip("/")


def test_units_and_scripts_are_where_the_units_look_for_them(two_versions):
    root = two_versions[0]
    assert (
        unit(root, "shiptwin-alarm@.service").read_text() == (DEPLOY / "shiptwin-alarm@.service").read_text()
    )
    assert os.access(root / "opt/shiptwin/current/share/shiptwin/alarm.sh", os.X_OK)


def test_roll_back_runs_the_version_before_and_again_the_one_after(two_versions):
    root, first, second = two_versions
    script("rollback.sh", root)
    assert running(root) == first
    assert f"{first} shiptwin" in script("rollback.sh", root, "--list")
    script("rollback.sh", root)
    assert running(root) == second


def test_rolling_back_brings_the_units_of_that_version_back(two_versions):
    """Test: the newer version's unit says something else. Expected: after the roll-back systemd reads the
    older one, and again the newer."""
    root, first, second = two_versions
    newer = root / "opt/shiptwin/versions" / second / "share/shiptwin/shiptwin.service"
    newer.write_text(newer.read_text() + "# the newer one\n")
    assert running(root) == second and "the newer one" in unit(root).read_text()
    script("rollback.sh", root, first)
    assert "the newer one" not in unit(root).read_text()
    script("rollback.sh", root, second)
    assert "the newer one" in unit(root).read_text()


@pytest.mark.parametrize("version, code", [("19990101T000000", 1), ("../../etc", 2), (".", 2)])
def test_a_version_that_is_not_there_is_refused(two_versions, version, code):
    done = tried("rollback.sh", two_versions[0], version)
    assert done.returncode == code and ("not installed" in done.stderr or "no version" in done.stderr)


@pytest.fixture
def systemd(tmp_path):
    """A systemctl that notes what it is told, and fails to restart while the file `broken` is there."""
    program = tmp_path / "systemctl"
    program.write_text(
        f'#!/bin/sh\necho "$@" >> {tmp_path}/told\n'
        f'case "$1" in restart|is-active) [ ! -e {tmp_path}/broken ] ;; show) case "$*" in *NRestarts*) echo '
        "0 ;; *) echo fine ;; esac ;; esac\n"
    )
    program.chmod(0o755)
    (tmp_path / "told").touch()
    return program


def test_a_first_install_that_fails_leaves_nothing_that_would_start(wheel, tmp_path, systemd):
    root = tmp_path / "root"
    (tmp_path / "broken").touch()
    done = tried("install.sh", root, wheel, SYSTEMCTL=str(systemd))
    assert done.returncode == 1 and "does not run" in done.stderr
    assert not (root / "opt/shiptwin/current").is_symlink() and not list(
        (root / "etc/systemd/system").iterdir()
    )
    told = (tmp_path / "told").read_text().splitlines()
    assert "disable --quiet shiptwin" in told and "enable --quiet shiptwin" not in told
    (tmp_path / "broken").unlink()
    kept = next((root / "opt/shiptwin/versions").iterdir()).name
    script("rollback.sh", root, kept, SYSTEMCTL=str(systemd))
    assert (
        running(root) == kept
        and unit(root).exists()
        and "enable --quiet shiptwin" in (tmp_path / "told").read_text()
    )


def test_an_upgrade_that_fails_runs_the_old_version_with_its_old_units(
    two_versions, wheel, tmp_path, systemd
):
    root, _, second = two_versions
    before = unit(root).read_text()
    (tmp_path / "broken").touch()
    time.sleep(1.1)
    done = tried("install.sh", root, wheel, SYSTEMCTL=str(systemd))
    assert done.returncode == 1 and f"running again: {second}" in done.stderr
    assert running(root) == second and unit(root).read_text() == before


def test_what_is_no_wheel_leaves_nothing_behind(tmp_path):
    (tmp_path / "shiptwin-9-py3-none-any.whl").write_bytes(b"no wheel")
    done = tried("install.sh", tmp_path / "root", tmp_path / "shiptwin-9-py3-none-any.whl")
    assert done.returncode != 0
    assert (
        not list((tmp_path / "root/opt/shiptwin/versions").iterdir())
        and not (tmp_path / "root/opt/shiptwin/current").is_symlink()
    )


@pytest.fixture(scope="module")
def wheels(wheel, tmp_path_factory):
    """A folder as deploy/wheels.sh makes it, a space in its name, with a lock of one small package of its own."""
    folder = tmp_path_factory.mktemp("USB DISK")
    small, info = folder / "ballast_of_the_test-1.0-py3-none-any.whl", "ballast_of_the_test-1.0.dist-info"
    with zipfile.ZipFile(small, "w") as file:
        file.writestr("ballast_of_the_test.py", "WEIGHT = 1\n")
        file.writestr(f"{info}/METADATA", "Metadata-Version: 2.1\nName: ballast-of-the-test\nVersion: 1.0\n")
        file.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        file.writestr(f"{info}/RECORD", "")
    shutil.copy(wheel, folder)
    (folder / "requirements.lock").write_text(
        f"ballast-of-the-test==1.0 --hash=sha256:{hashlib.sha256(small.read_bytes()).hexdigest()}\n"
    )
    return folder


def summed(folder):
    subprocess.run("sha256sum *.whl requirements.lock > SHA256SUMS", shell=True, cwd=folder, check=True)


def test_a_folder_of_wheels_with_a_space_in_its_name_installs_without_a_network(wheels, tmp_path):
    """Test: no index can be reached. Expected: the twin and what its lock names are there."""
    summed(wheels)
    nowhere = {
        "PIP_INDEX_URL": "http://127.0.0.1:9/simple",
        "PIP_EXTRA_INDEX_URL": "",
        "PIP_FIND_LINKS": "",
        "PIP_CONFIG_FILE": "/dev/null",
    }
    script("install.sh", tmp_path, "--wheels", wheels, **nowhere)
    code = "import ballast_of_the_test, twin; print(ballast_of_the_test.WEIGHT)"
    done = subprocess.run(
        [tmp_path / "opt/shiptwin/current/bin/python", "-c", code], capture_output=True, text=True, cwd="/"
    )
    assert done.stdout.strip() == "1", done.stderr


@pytest.mark.parametrize("what", ["a wheel", "the lock", "the lock, and the sums made to fit"])
def test_Q9_a_wheel_or_a_lock_that_was_tampered_with_is_not_installed(wheels, tmp_path, what):
    """Test: one byte more in a wheel, another hash in the lock. Expected: refused in words, nothing left,
    nothing running."""
    folder = tmp_path / "wheels"
    shutil.copytree(wheels, folder)
    summed(folder)
    if what == "a wheel":
        with open(next(folder.glob("ballast*.whl")), "ab") as file:
            file.write(b"x")
    else:
        lock = folder / "requirements.lock"
        lock.write_text(re.sub(r"sha256:\w{6}", "sha256:000000", lock.read_text()))
    if "sums" in what:
        summed(folder)
    done = tried("install.sh", tmp_path / "root", "--wheels", folder)
    assert done.returncode != 0
    assert ("HASHES" if "sums" in what else "not what deploy/wheels.sh made") in done.stderr
    left = tmp_path / "root/opt/shiptwin/versions"
    assert not left.exists() or not list(left.iterdir())


def signed(folder, key):
    sums = folder / "SHA256SUMS"
    command = ["openssl", "dgst", "-sha256", "-sign", key, "-out", folder / "SHA256SUMS.sig", sums]
    subprocess.run(command, check=True)


@pytest.mark.skipif(not shutil.which("openssl"), reason="openssl is not installed")
def test_wheels_without_the_signature_that_the_ship_asks_for_are_not_installed(wheels, tmp_path):
    """Test: a ship with a maker's public key; wheels without a signature, with another maker's, changed after
    it was made, from no folder at all, and as they should be. Expected: only the last are installed."""
    folder, root = tmp_path / "wheels", tmp_path / "root"
    shutil.copytree(wheels, folder)
    summed(folder)
    for name in ("maker", "other"):
        key = ["openssl", "ecparam", "-genkey", "-name", "prime256v1", "-noout", "-out", tmp_path / name]
        subprocess.run(key, check=True, capture_output=True)
    (root / "etc/shiptwin").mkdir(parents=True)
    public = root / "etc/shiptwin/release.pem"
    command = ["openssl", "pkey", "-in", tmp_path / "maker", "-pubout", "-out", public]
    subprocess.run(command, check=True)

    def refused(*arguments, words="is not signed"):
        done = tried("install.sh", root, *arguments)
        return done.returncode == 1 and words in done.stderr and not (root / "opt").exists()

    assert refused("--wheels", folder)
    signed(folder, tmp_path / "other")
    assert refused("--wheels", folder)
    signed(folder, tmp_path / "maker")
    sums = folder / "SHA256SUMS"
    honest = sums.read_text()
    sums.write_text(honest.replace("  ", " *", 1))
    assert refused("--wheels", folder)
    assert refused(folder / "any.whl", words="signed wheels only")
    sums.write_text(honest)
    script("install.sh", root, "--wheels", folder)
    assert running(root)
