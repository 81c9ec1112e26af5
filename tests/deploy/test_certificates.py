"""Who may read the keys: the service its own, nobody the one that signs."""

import grp
import os
import shutil
import stat
import subprocess
from pathlib import Path

import pytest

DEPLOY = Path(__file__).parents[2] / "deploy"

pytestmark = pytest.mark.skipif(not shutil.which("openssl"), reason="openssl is not installed")


@pytest.fixture
def tls(tmp_path):
    subprocess.run(
        [DEPLOY / "make-certificates.sh", tmp_path / "tls", "127.0.0.1"], check=True, capture_output=True
    )
    return tmp_path / "tls"


def test_the_key_that_signs_is_in_a_folder_of_its_own_that_only_its_maker_may_read(tls):
    assert not (tls / "ca.key").exists()
    authority = tls.with_name("tls-ca")
    assert (
        stat.S_IMODE(authority.stat().st_mode) == 0o700
        and stat.S_IMODE((authority / "ca.key").stat().st_mode) == 0o600
    )
    assert {p.name for p in tls.iterdir()} == {"ca.pem"} | {
        f"{who}.{end}" for who in ("twin", "sensors", "viewer") for end in ("key", "pem")
    }


@pytest.mark.skipif(os.geteuid() != 0, reason="to give files away needs root")
def test_the_services_group_reads_its_own_key_and_no_other(tls):
    """Test: an earlier version's ca.key lies in the folder too. Expected: twin.key for the group, the rest
    for root alone."""
    (tls / "ca.key").write_text("signs")
    group = grp.getgrnam("daemon")
    done = subprocess.run(
        [DEPLOY / "tls-rights.sh", tls, group.gr_name], capture_output=True, text=True, check=True
    )
    assert "Take it off the ship" in done.stderr
    readable = {p.name for p in tls.iterdir() if p.stat().st_gid == group.gr_gid and p.stat().st_mode & 0o040}
    assert readable == {"ca.pem", "twin.pem", "twin.key"}
    assert all(p.stat().st_mode & 0o007 == 0 for p in [tls, *tls.iterdir()])
