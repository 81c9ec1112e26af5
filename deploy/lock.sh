#!/bin/sh
# Writes down what is installed on board, to the byte: requirements.lock and requirements-3.14.lock (versions and hashes of every file;
# see which-lock.sh) and sbom.json.
#   deploy/lock.sh              needs a network; run it when a dependency changes, and commit both files
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
python="${PYTHON:-python3}"
tools="$(mktemp -d)"
trap 'rm -rf "$tools"' EXIT
"$python" -m venv "$tools"
"$tools/bin/python" -m pip install --quiet --disable-pip-version-check "pip-tools>=7.5"
cd "$here/.."
echo 'onnxruntime==1.20.*' > "$tools/memory.txt"  # see which-lock.sh
compile() {
    CUSTOM_COMPILE_COMMAND="deploy/lock.sh" "$tools/bin/pip-compile" --quiet --generate-hashes --strip-extras --no-emit-index-url \
        --no-emit-trusted-host --no-emit-find-links "$@" pyproject.toml
}
compile --constraint "$tools/memory.txt" --output-file "$here/requirements.lock"
sed -i "\|#   -c $tools|d" "$here/requirements.lock"
compile --output-file "$here/requirements-3.14.lock"
"$python" "$here/sbom.py" "$here/requirements.lock" "$here/sbom.json"
