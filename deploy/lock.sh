#!/bin/sh
# Writes down what is installed on board, to the byte: requirements.lock (versions and hashes of every file) and sbom.json.
#   deploy/lock.sh              needs a network; run it when a dependency changes, and commit both files
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
python="${PYTHON:-python3}"
tools="$(mktemp -d)"
trap 'rm -rf "$tools"' EXIT
"$python" -m venv "$tools"
"$tools/bin/python" -m pip install --quiet --disable-pip-version-check "pip-tools>=7.5"
cd "$here/.."
CUSTOM_COMPILE_COMMAND="deploy/lock.sh" "$tools/bin/pip-compile" --quiet --generate-hashes --strip-extras --no-emit-index-url --no-emit-trusted-host --no-emit-find-links \
    --output-file "$here/requirements.lock" pyproject.toml
"$python" "$here/sbom.py" "$here/requirements.lock" "$here/sbom.json"
