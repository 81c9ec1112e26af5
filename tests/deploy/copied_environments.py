"""A python3 that makes environments by copying one, in a tenth of the time."""

import subprocess


def copying_python(folder):
    """The program, in this folder, with the environment that it copies: its pip is that of another one, so
    that no copy has a thousand files of pip to write, compile and put on the disk."""
    for words in ((folder / "pip",), ("--without-pip", folder / "made")):
        subprocess.run(["python3", "-m", "venv", *words], check=True, capture_output=True, timeout=180)
    (pip,), (made,) = ((folder / name).glob("lib/python3*/site-packages") for name in ("pip", "made"))
    (made / "pip.pth").write_text(f"{pip}\n")
    program = folder / "python3"
    copied = f'cp -a "{folder}/made" "$3.copy" && mv "$3.copy"/* "$3" && rmdir "$3.copy"'
    program.write_text(f'#!/bin/sh\nif [ "$1 $2" = "-m venv" ]; then {copied}; else exec python3 "$@"; fi\n')
    program.chmod(0o755)
    return program
