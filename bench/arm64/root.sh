#!/bin/sh
# root.sh FOLDER: Debian's Python for arm64, the packages of the service at the versions of the lock, and the
# emulator (QEMU, user mode) that runs them on this machine. Nothing is installed here; needs apt-get and pip.
# ONNXRUNTIME chooses that package's version: Debian 12's QEMU cannot load the newest.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:?"root.sh FOLDER"}
ONNXRUNTIME=${ONNXRUNTIME:-1.20.1}
mkdir -p "$folder/root" "$folder/qemu" "$folder/site"
folder=$(cd "$folder" && pwd)
apt=$(mktemp -d)
trap 'rm -rf "$apt"' EXIT
mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial"
: >"$apt/status"

get() { # get ARCHITECTURE PACKAGE...: the archives of these and of what they need, into $apt/cache/archives
    architecture=$1
    shift
    set -- -qq -o "APT::Architecture=$architecture" -o "APT::Architectures=$architecture" \
        -o "Dir::State::lists=$apt/lists" -o "Dir::State::status=$apt/status" -o "Dir::Cache=$apt/cache" \
        -o APT::Sandbox::User=root "$@"
    apt-get "$@" >/dev/null
}
unpack() { # unpack FOLDER: all archives, which are then gone
    for archive in "$apt"/cache/archives/*.deb; do
        dpkg-deb -x "$archive" "$1"
        rm "$archive"
    done
}

get arm64 update
get arm64 install -y --download-only --no-install-recommends libc6 libstdc++6 python3.11
unpack "$folder/root"
own=$(dpkg --print-architecture)
get "$own" update
(cd "$apt/cache/archives" && get "$own" download qemu-user-static)
unpack "$folder/qemu"

wheels() {
    python3 -m pip install -q --disable-pip-version-check --root-user-action ignore --upgrade \
        --target "$folder/site" --no-deps --only-binary :all: --python-version 3.11 --implementation cp \
        --platform manylinux2014_aarch64 --platform manylinux_2_17_aarch64 \
        --platform manylinux_2_27_aarch64 --platform manylinux_2_28_aarch64 "$@"
}
lock=$(mktemp)
sed -n 's/^\([a-zA-Z0-9._-]*==[^ ;]*\).*/\1/p' "$here/../../deploy/requirements.lock" |
    sed "s/^onnxruntime==.*/onnxruntime==$ONNXRUNTIME/" >"$lock"
wheels -r "$lock"
rm "$lock"
echo "$folder: $(ls "$folder/site" | grep -c dist-info) packages for arm64"
