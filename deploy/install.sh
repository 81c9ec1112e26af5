#!/bin/sh
# Installs a version beside those that are there and switches to it; when it does not stay up, switches back.
#   sudo deploy/install.sh [WHEEL]      without WHEEL the version of this source folder
# For a trial without systemd: ROOT=/some/folder deploy/install.sh
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
source="${1:-$(dirname "$here")}"
root="${ROOT:-}"
base="$root/opt/shiptwin"
python="${PYTHON:-python3}"
. "$here/switch.sh"

"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "$python is older than 3.11. Name a newer one: PYTHON=..." >&2; exit 1; }
[ -n "$root" ] || [ "$(id -u)" = 0 ] || { echo "Only root may install to /opt: sudo $0" >&2; exit 1; }

version="$(date -u +%Y%m%dT%H%M%S)"
new="$base/versions/$version"
echo "1/4 a fresh environment beside the old ones: $new"
mkdir -p "$base/versions"
mkdir -m 755 "$new"
trap 'rm -rf "$new"' EXIT
"$python" -m venv "$new"
"$new/bin/python" -m pip install --quiet --disable-pip-version-check "$source"
"$new/bin/python" -m compileall -q "$new/lib" || true
mkdir -p "$new/share/shiptwin"
cp "$here"/*.md "$here"/*.sh "$here"/*.json "$here"/*.json5 "$here"/*.toml "$here"/*.service "$new/share/shiptwin/"
trap - EXIT

echo "2/4 settings (those that are there stay)"
mkdir -p "$root/etc/shiptwin"
for file in twin.toml zenoh.json5; do
    [ -e "$root/etc/shiptwin/$file" ] || cp "$here/$file" "$root/etc/shiptwin/$file"
done
if [ -z "$root" ]; then
    id shiptwin >/dev/null 2>&1 ||
        useradd --system --home-dir /var/lib/shiptwin --shell /usr/sbin/nologin shiptwin
    [ ! -d /etc/shiptwin/tls ] || { chown -R root:shiptwin /etc/shiptwin/tls; chmod -R u=rwX,g=rX,o= /etc/shiptwin/tls; }
fi

echo "3/4 the service"
mkdir -p "$root/etc/systemd/system"
cp "$here/shiptwin.service" "$here/shiptwin-alarm@.service" "$root/etc/systemd/system/"

echo "4/4 switch"
switch_to "$version"
