#!/bin/sh
# Says that a unit has failed for good: in the journal, in a file others can watch, and by the owner's own program.
#   alarm.sh UNIT
set -eu
unit="${1:?usage: alarm.sh UNIT}"
file="${RUNTIME_DIRECTORY:-/run/shiptwin-alarm}/alarm"
hook="${SHIPTWIN_ON_ALARM:-/etc/shiptwin/on-alarm}"
text="$(date -u +%Y-%m-%dT%H:%M:%SZ) $unit has failed and stays down. Look: journalctl -u $unit -n 50. Then: systemctl reset-failed $unit; systemctl start $unit"
echo "$text" > "$file"
echo "<1>$text" >&2
if [ -x "$hook" ]; then exec "$hook" "$unit" "$text"; fi
