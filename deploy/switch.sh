# Read by install.sh and rollback.sh (base, root): which version runs, and how to change it in one rename.
# The units in /etc/systemd/system are links into the running version, so code and units change in the same step.

units="shiptwin.service shiptwin-alarm@.service"
if [ -z "$root" ]; then systemctl="${SYSTEMCTL:-systemctl}"; else systemctl="${SYSTEMCTL:-}"; fi

running() { readlink "$base/current" 2>/dev/null | sed 's#^versions/##'; }

point_to() {  # the link changes in one step: there is never none, and never half of one
    ln -s "versions/$1" "$base/.current.$$"
    mv -T "$base/.current.$$" "$base/current"
}

link_units() {  # once; a copy that an earlier version of these scripts left becomes a link
    mkdir -p "$root/etc/systemd/system"
    for unit in $units; do
        ln -s "/opt/shiptwin/current/share/shiptwin/$unit" "$root/etc/systemd/system/.$unit.$$"
        mv -T "$root/etc/systemd/system/.$unit.$$" "$root/etc/systemd/system/$unit"
    done
}

restart() {  # good when it says that it is ready and still runs, fed its watchdog, after five seconds; enabled only then
    [ -n "$systemctl" ] || return 0
    "$systemctl" daemon-reload
    "$systemctl" reset-failed shiptwin 2>/dev/null || true
    "$systemctl" restart shiptwin || return 1
    started="$("$systemctl" show --property NRestarts --value shiptwin)"
    sleep "${SETTLE_S:-5}"
    "$systemctl" is-active --quiet shiptwin || return 1
    [ "$("$systemctl" show --property NRestarts --value shiptwin)" = "$started" ] || return 1
    "$systemctl" enable --quiet shiptwin
    "$systemctl" show --property StatusText --value shiptwin
}

take_away() {  # nothing ran before: nothing is left that would start at the next boot
    if [ -n "$systemctl" ]; then
        "$systemctl" stop shiptwin 2>/dev/null || true
        "$systemctl" disable --quiet shiptwin 2>/dev/null || true
    fi
    for unit in $units; do rm -f "$root/etc/systemd/system/$unit"; done
    rm -f "$base/current"
    if [ -n "$systemctl" ]; then "$systemctl" daemon-reload; fi
}

switch_to() {  # VERSION: run it; when it does not stay up, run again what ran before
    before="$(running)"
    [ -d "$base/versions/$before" ] || before=""
    point_to "$1"
    if restart; then
        [ -z "$before" ] || [ "$before" = "$1" ] || echo "$before" > "$base/previous"
        echo "running: $1. Before: ${before:-nothing}. Back: deploy/rollback.sh"
        return 0
    fi
    echo "version $1 does not run: journalctl -u shiptwin -n 20" >&2
    if [ -n "$before" ]; then
        point_to "$before"
        restart || true
        echo "running again: $before" >&2
    else
        take_away
        echo "nothing ran before, so nothing is enabled now. The version lies in $base/versions/$1; try again: deploy/rollback.sh $1" >&2
    fi
    return 1
}
