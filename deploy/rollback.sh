#!/bin/sh
# Runs again the version that ran before, or the one that is named, with its own units.
#   sudo deploy/rollback.sh [VERSION]      rollback.sh --list shows what there is
set -eu
root="${ROOT:-}"
base="$root/opt/shiptwin"
. "$(cd "$(dirname "$0")" && pwd)/switch.sh"

if [ "${1:-}" = --list ]; then
    for folder in "$base"/versions/*/; do
        version="$(basename "$folder")"
        release="$("$folder/bin/python" -c 'from importlib.metadata import version; print(version("shiptwin"))' 2>/dev/null || echo "not whole: delete it")"
        if [ "$version" = "$(running)" ]; then note=" (running)"; else note=""; fi
        echo "$version shiptwin $release$note"
    done
    exit 0
fi
version="${1:-$(cat "$base/previous" 2>/dev/null || true)}"
[ -n "$version" ] || { echo "No earlier version is known. See: $0 --list" >&2; exit 1; }
case "$version" in */* | .*) echo "$version is no version. See: $0 --list" >&2; exit 2 ;; esac
[ -f "$base/versions/$version/share/shiptwin/shiptwin.service" ] || { echo "$version is not installed. See: $0 --list" >&2; exit 1; }
link_units
switch_to "$version"
