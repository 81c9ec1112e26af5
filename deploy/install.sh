#!/bin/sh
# Installs a version beside those that are there and switches to it; when it does not stay up, switches back.
#   sudo deploy/install.sh [WHEEL]              without WHEEL the version of this source folder; what it needs comes from the network,
#                                               in the versions and with the hashes of requirements.lock
#   sudo deploy/install.sh --wheels FOLDER      everything from a folder that deploy/wheels.sh made: no network
# Where /etc/shiptwin/release.pem is, only a folder of wheels signed with its private half is installed.
# For a trial without systemd: ROOT=/some/folder deploy/install.sh
set -eu
umask 022  # the service is another user, and has to read what root writes here
here="$(cd "$(dirname "$0")" && pwd)"
root="${ROOT:-}"
base="$root/opt/shiptwin"
python="${PYTHON:-python3}"
lock="${LOCK-$("$here/which-lock.sh" "$python")}"
. "$here/switch.sh"

wheels=""
signer="$root/etc/shiptwin/release.pem"
if [ "${1:-}" = --wheels ]; then
    wheels="$(cd "${2:?usage: install.sh --wheels FOLDER}" && pwd)" || exit 2
    (cd "$wheels" && sha256sum --check --quiet --strict SHA256SUMS) || { echo "$wheels is not what deploy/wheels.sh made: copy it again" >&2; exit 1; }
    [ ! -e "$signer" ] || openssl dgst -sha256 -verify "$signer" -signature "$wheels/SHA256SUMS.sig" "$wheels/SHA256SUMS" >/dev/null 2>&1 ||
        { echo "$wheels is not signed by $signer: sign it with deploy/wheels.sh (SIGN_KEY), or take $signer away" >&2; exit 1; }
    lock="$wheels/requirements.lock"
    source="$(find "$wheels" -name 'shiptwin-*.whl' | head -n 1)"
    [ -n "$source" ] || { echo "$wheels holds no shiptwin-*.whl" >&2; exit 1; }
else
    [ ! -e "$signer" ] || { echo "$signer is there: this ship installs signed wheels only (--wheels FOLDER)" >&2; exit 1; }
    source="${1:-$(dirname "$here")}"
fi
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "$python is older than 3.11. Name a newer one: PYTHON=..." >&2; exit 1; }
[ -n "$root" ] || [ "$(id -u)" = 0 ] || { echo "Only root may install to /opt: sudo $0" >&2; exit 1; }

version="$(date -u +%Y%m%dT%H%M%S)"
new="$base/versions/$version"
echo "1/4 a fresh environment beside the old ones: $new"
mkdir -p "$base/versions"
mkdir "$new"
trap 'rm -rf "$new"' EXIT
"$python" -m venv "$new"
pip() { "$new/bin/python" -m pip install --quiet --disable-pip-version-check ${wheels:+--no-index --find-links "$wheels"} "$@"; }
[ -z "$lock" ] || pip --require-hashes --requirement "$lock"
pip --no-deps "$source"
"$new/bin/python" -m compileall -q "$new/lib" || true
mkdir -p "$new/share/shiptwin"
cp "$here"/*.md "$here"/*.sh "$here"/*.json "$here"/*.json5 "$here"/*.toml "$here"/*.service "$new/share/shiptwin/"
"$new/bin/twin" --help >/dev/null || { echo "version $version does not even start: is $python the one that $source was made for?" >&2; exit 1; }
"$new/bin/python" "$here/evict.py" "$new/lib" || true  # fresh files cost the service up to 11 MB of memory
trap - EXIT

echo "2/4 settings (those that are there stay)"
mkdir -p "$root/etc/shiptwin"
for file in twin.toml zenoh.json5; do
    [ -e "$root/etc/shiptwin/$file" ] || cp "$here/$file" "$root/etc/shiptwin/$file"
done
if [ -z "$root" ]; then
    id shiptwin >/dev/null 2>&1 ||
        useradd --system --home-dir /var/lib/shiptwin --shell /usr/sbin/nologin shiptwin
    [ ! -d /etc/shiptwin/tls ] || "$here/tls-rights.sh" /etc/shiptwin/tls
fi

echo "3/4 the service: its units come from the version that runs"
link_units

echo "4/4 switch"
switch_to "$version"
