"""A python3 that makes environments by copying one, in a tenth of the time."""

import subprocess


def copying_python(folder):
    """The program, in this folder, with the environment that it copies."""
    subprocess.run(["python3", "-m", "venv", folder / "made"], check=True, capture_output=True, timeout=180)
    program = folder / "python3"
    copied = f'cp -a "{folder}/made" "$3.copy" && mv "$3.copy"/* "$3" && rmdir "$3.copy"'
    program.write_text(f'#!/bin/sh\nif [ "$1 $2" = "-m venv" ]; then {copied}; else exec python3 "$@"; fi\n')
    program.chmod(0o755)
    return program
