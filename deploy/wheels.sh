#!/bin/sh
# A folder with everything install.sh needs, for a ship without a network:
#   deploy/wheels.sh FOLDER             with a network, on a machine of the same kind as the ship's (or PLATFORM=manylinux_2_28_aarch64)
#   sudo deploy/install.sh --wheels FOLDER          on the ship
# SIGN_KEY=release.key signs the folder (openssl ecparam -genkey -name prime256v1 -noout -out release.key); a ship that holds the public
# half as /etc/shiptwin/release.pem (openssl pkey -in release.key -pubout) installs nothing else
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
folder="${1:?usage: wheels.sh FOLDER}"
python="${PYTHON:-python3}"
lock="${LOCK:-$("$here/which-lock.sh" "$python")}"
mkdir -p "$folder"
[ -z "$(ls -A "$folder")" ] || { echo "$folder is not empty" >&2; exit 1; }
other=""
if [ -n "${PLATFORM:-}" ]; then  # what runs with an older C library runs there, too
    other="--only-binary=:all: --platform $PLATFORM"
    machine="${PLATFORM##manylinux_2_}" && machine="${machine#*_}"
    minor="${PLATFORM#manylinux_2_}" && minor="${minor%%_*}"
    while [ "$minor" -gt 17 ] 2>/dev/null; do minor=$((minor - 1)) && other="$other --platform manylinux_2_${minor}_$machine"; done
fi
# shellcheck disable=SC2086 (words)
"$python" -m pip download --quiet --disable-pip-version-check --require-hashes $other --dest "$folder" --requirement "$lock"
"$python" -m pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir "$folder" "${SOURCE:-$(dirname "$here")}"
cp "$lock" "$folder/requirements.lock"
(cd "$folder" && find . -type f ! -name SHA256SUMS | sort | xargs -d '\n' sha256sum > SHA256SUMS)
[ -z "${SIGN_KEY:-}" ] || openssl dgst -sha256 -sign "$SIGN_KEY" -out "$folder/SHA256SUMS.sig" "$folder/SHA256SUMS"
echo "$(find "$folder" -name '*.whl' | wc -l) wheels in $folder. On the ship: sudo deploy/install.sh --wheels FOLDER"
