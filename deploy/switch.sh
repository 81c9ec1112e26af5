# Read by install.sh and rollback.sh (base, root): which version runs, and how to change it in one rename.

running() { readlink "$base/current" 2>/dev/null | sed 's#^versions/##'; }

point_to() {  # the symlink changes in one step: there is never none, and never half of one
    ln -s "versions/$1" "$base/.current.$$"
    mv -T "$base/.current.$$" "$base/current"
}

restart() {
    [ -z "$root" ] || return 0
    systemctl daemon-reload
    systemctl reset-failed shiptwin 2>/dev/null || true
    systemctl enable --quiet shiptwin
    systemctl restart shiptwin && "$base/current/bin/twin" health --config /etc/shiptwin/twin.toml
}

switch_to() {  # VERSION: run it; when it is not healthy, run again what ran before
    before="$(running)"
    point_to "$1"
    if restart; then
        [ -z "$before" ] || [ "$before" = "$1" ] || echo "$before" > "$base/previous"
        echo "running: $1. Before: ${before:-nothing}. Back: deploy/rollback.sh"
        return 0
    fi
    echo "version $1 is not healthy" >&2
    [ -z "$before" ] || { point_to "$before"; restart || true; echo "running again: $before" >&2; }
    return 1
}
