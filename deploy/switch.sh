# Read by install.sh and rollback.sh (base, root): which version runs, and how to change it in one rename.

running() { readlink "$base/current" 2>/dev/null | sed 's#^versions/##'; }

point_to() {  # the symlink changes in one step: there is never none, and never half of one
    ln -s "versions/$1" "$base/.current.$$"
    mv -T "$base/.current.$$" "$base/current"
}

restart() {  # good when it says that it is ready and still runs, fed its watchdog, after five seconds
    [ -z "$root" ] || return 0
    systemctl daemon-reload
    systemctl reset-failed shiptwin 2>/dev/null || true
    systemctl enable --quiet shiptwin
    systemctl restart shiptwin || return 1
    started="$(systemctl show --property NRestarts --value shiptwin)"
    sleep 5
    systemctl is-active --quiet shiptwin || return 1
    [ "$(systemctl show --property NRestarts --value shiptwin)" = "$started" ] || return 1
    systemctl show --property StatusText --value shiptwin
}

switch_to() {  # VERSION: run it; when it does not stay up, run again what ran before
    before="$(running)"
    point_to "$1"
    if restart; then
        [ -z "$before" ] || [ "$before" = "$1" ] || echo "$before" > "$base/previous"
        echo "running: $1. Before: ${before:-nothing}. Back: deploy/rollback.sh"
        return 0
    fi
    echo "version $1 does not run" >&2
    [ -z "$before" ] || { point_to "$before"; restart || true; echo "running again: $before" >&2; }
    return 1
}
