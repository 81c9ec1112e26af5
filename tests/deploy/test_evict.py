"""What an installation leaves in memory."""

import ctypes
import mmap
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.sources import ROOT

EVICT = ROOT / "deploy" / "evict.py"


def in_memory(path: Path) -> int:
    """Pages of a file that lie in the page cache."""
    libc = ctypes.CDLL(None, use_errno=True)
    with path.open("r+b") as file, mmap.mmap(file.fileno(), 0) as mapped:
        pages = (len(mapped) + mmap.PAGESIZE - 1) // mmap.PAGESIZE
        seen = (ctypes.c_ubyte * pages)()
        held = ctypes.c_char.from_buffer(mapped)
        assert libc.mincore(ctypes.c_void_p(ctypes.addressof(held)), ctypes.c_size_t(len(mapped)), seen) == 0
        del held
        return sum(page & 1 for page in seen)


def test_what_was_installed_is_on_the_disk_and_no_more_in_memory(tmp_path):
    """Test: files as an installer writes them, one in a folder, one that is a link. Expected: none of their pages is
    left in memory, and they are what they were."""
    (tmp_path / "deep").mkdir()
    files = [tmp_path / "library.so", tmp_path / "deep" / "module.py"]
    for file in files:
        file.write_bytes(os.urandom(1 << 20))
    (tmp_path / "link").symlink_to("nowhere")
    if not all(in_memory(file) for file in files):
        pytest.skip("this file system keeps nothing in memory")
    before = [file.read_bytes() for file in files]
    subprocess.run([sys.executable, EVICT, tmp_path], check=True)
    left = [in_memory(file) for file in files]
    if any(left) and os.major(tmp_path.stat().st_dev) == 0:
        pytest.skip("files here live in memory alone")
    assert left == [0, 0]
    assert [file.read_bytes() for file in files] == before


def test_the_installer_evicts_what_it_has_installed_before_the_service_starts():
    text = (ROOT / "deploy" / "install.sh").read_text()
    assert text.index("compileall") < text.index('/bin/twin" --help') < text.index('evict.py" "$new/lib"')
    assert text.index('evict.py" "$new/lib"') < text.index("\nswitch_to ")
