#!/bin/sh
# Who may read what in the folder of certificates: the service its own key, root the others, nobody else anything.
#   tls-rights.sh FOLDER [GROUP]        GROUP: the service's, shiptwin unless it is named
set -eu
folder="${1:?usage: tls-rights.sh FOLDER [GROUP]}"
group="${2:-shiptwin}"
chown root:"$group" "$folder"
chmod 750 "$folder"
find "$folder" -mindepth 1 -type f -exec chown root:root {} + -exec chmod 600 {} +
for file in ca.pem twin.pem twin.key; do
    [ ! -f "$folder/$file" ] || { chgrp "$group" "$folder/$file"; chmod 640 "$folder/$file"; }
done
if [ -e "$folder/ca.key" ]; then
    echo "$folder/ca.key signs new certificates: who has it can be anybody on this bus. Take it off the ship." >&2
fi
