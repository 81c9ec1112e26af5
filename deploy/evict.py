"""Puts the files of a folder on the disk and gives back their pages in memory.

    python deploy/evict.py FOLDER

What an installer has just written lies in the page cache in large pieces, and a process that touches one page
of a library then maps the whole piece: up to 11 MB more than of files read back.
"""

import os
import sys
from pathlib import Path


def evict(folder: Path) -> int:
    """How many files were asked for; what cannot be opened or asked is passed over."""
    os.sync()  # of all at once: to wait for each of some thousand files takes minutes on a slow disk
    asked = 0
    for path in sorted(folder.rglob("*")):
        if path.is_symlink() or not path.is_file():
            continue
        try:
            fd = os.open(path, os.O_RDONLY)
        except OSError:
            continue
        try:
            os.posix_fadvise(fd, 0, 0, os.POSIX_FADV_DONTNEED)
            asked += 1
        except OSError:
            pass
        finally:
            os.close(fd)
    return asked


if __name__ == "__main__":
    evict(Path(sys.argv[1]))
