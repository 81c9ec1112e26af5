#!/bin/sh
# The lock for a Python. ONNX Runtime 1.20 leaves the twin at 42 MB where 1.32 takes it to 46, with the same replayed bytes; it was made
# for Python 3.11 to 3.13, so a newer Python has a lock of its own.
#   deploy/which-lock.sh PYTHON
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
"$1" -c 'import sys; sys.exit(sys.version_info >= (3, 14))' && echo "$here/requirements.lock" || echo "$here/requirements-3.14.lock"
