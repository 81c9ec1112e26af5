#!/bin/sh
# Certificates for zenoh.json5: a CA of this ship, and one certificate each for the twin, its sensors and its viewers.
#   make-certificates.sh FOLDER ADDRESS...     ADDRESS: what the twin is reached by, such as 10.0.0.5 or twin.local
# The CA's own key goes into FOLDER-ca (or $CA_FOLDER), which only who runs this may read; it is to leave the ship.
set -eu
[ $# -ge 2 ] || { echo "usage: make-certificates.sh FOLDER ADDRESS..." >&2; exit 2; }
command -v openssl >/dev/null || { echo "openssl is needed. On Debian: apt install openssl" >&2; exit 1; }
folder="$1"; shift
days="${DAYS:-825}"
names=""
for address in "$@"; do
    case "$address" in
        *:*) names="$names,IP:$address" ;;  # IPv6
        *[!0-9.]*) names="$names,DNS:$address" ;;
        *) names="$names,IP:$address" ;;
    esac
done
umask 077
mkdir -p "$folder"
cd "$folder"
authority="${CA_FOLDER:-$(pwd)-ca}"
mkdir -p -m 700 "$authority"
[ ! -e ca.pem ] || { echo "$folder/ca.pem exists: move it away to start anew" >&2; exit 1; }

key() { openssl ecparam -name prime256v1 -genkey -noout | openssl pkcs8 -topk8 -nocrypt -out "$1.key"; }

key "$authority/ca"
openssl req -x509 -new -key "$authority/ca.key" -sha256 -days 3650 -subj "/CN=shiptwin CA" \
    -addext "basicConstraints=critical,CA:TRUE" -addext "keyUsage=critical,keyCertSign,cRLSign" -out ca.pem
for who in twin sensors viewer; do
    key "$who"
    { echo "basicConstraints=CA:FALSE"
      echo "keyUsage=critical,digitalSignature"
      echo "extendedKeyUsage=serverAuth,clientAuth"
      if [ "$who" = twin ]; then echo "subjectAltName=${names#,}"; else echo "subjectAltName=DNS:$who"; fi
    } > "$who.ext"
    openssl req -new -key "$who.key" -subj "/CN=$who" |
        openssl x509 -req -CA ca.pem -CAkey "$authority/ca.key" -CAserial "$authority/ca.srl" -CAcreateserial -sha256 -days "$days" -extfile "$who.ext" -out "$who.pem" 2>/dev/null
    rm "$who.ext"
done
chmod 644 ./*.pem
echo "made in $folder: ca.pem, and twin, sensors, viewer (.pem, .key), valid for $days days. Take $authority off the ship: its key signs more."
