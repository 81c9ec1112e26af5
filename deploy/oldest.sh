#!/bin/sh
# Do the lower bounds in pyproject.toml hold? The oldest version of everything in an environment of its own: a replay, and a service
# that answers. Needs a network; run it when a bound changes.
#   deploy/oldest.sh
set -eu
source="$(cd "$(dirname "$0")/.." && pwd)"
python="${PYTHON:-python3.11}"
place="$(mktemp -d)"
trap 'rm -rf "$place"' EXIT
"$python" -m venv "$place/venv"
"$python" - "$source/pyproject.toml" > "$place/oldest.txt" <<'PYTHON'
import re, sys, tomllib
for wanted in tomllib.load(open(sys.argv[1], "rb"))["project"]["dependencies"]:
    print(re.sub(r"^([\w-]+)>=([^,]+).*", r"\1==\2", wanted))
PYTHON
cat "$place/oldest.txt"
"$place/venv/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$place/oldest.txt"
export PYTHONPATH="$source" HOME="$place"
cd "$place"
twin() { "$place/venv/bin/python" -m twin.cli "$@"; }
twin replay "$source/twin/voyages/monday.mcap" --ship kvlcc2 -o replayed.mcap | tail -n 1
cat > twin.toml <<'TOML'
[loop]
priority = 0
lock_memory = false
[bus]
listen = "tcp/127.0.0.1:17447"
[log]
folder = "logs"
TOML
twin run --config twin.toml --duration 8 &
twin health --config twin.toml --timeout 8 | grep "starting, 10 Hz" || { echo "the service does not answer" >&2; exit 1; }
wait
echo "the oldest versions run"
