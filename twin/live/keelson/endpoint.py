"""Where a bus listens or connects, checked before Zenoh sees it: what can never work ends the start, what may
come (an address that is not up yet, a port that is not free yet) does not."""

import re

from twin.errors import SettingsError

MAX_BYTES = 255  # Zenoh's own
WITH_PORT = ("tcp", "tls", "udp", "quic", "ws")
PATHS = ("unixsock-stream",)
_PLACE = re.compile(r"(\[[0-9A-Fa-f:.]+(?:%\w+)?\]|[\w.-]+):(\d{1,5})", re.ASCII)
_ASIDE = re.compile(r"(?:\?(?:rel=[01]|prio=[0-7]-[0-7]|;)+)?(?:#[\w=;./:-]+)?", re.ASCII)
AS_IN = "as in 'tcp/127.0.0.1:7447'"


def check(endpoint: str, where: str) -> str:
    """The endpoint, when it can be one; SettingsError says what is wrong with it. `where`: the setting's
    name."""
    said = f"[bus] {where} = {endpoint[:80]!r}"
    protocol, _, rest = endpoint.partition("/")
    if protocol not in (*WITH_PORT, *PATHS):
        raise SettingsError(
            f"{said}: it must begin with {', '.join(WITH_PORT)} or {PATHS[0]} and '/', {AS_IN}."
        )
    if len(endpoint.encode()) > MAX_BYTES:
        raise SettingsError(f"{said}...: {len(endpoint.encode())} bytes, at most {MAX_BYTES} can be used.")
    aside = re.search(r"[?#]", rest)
    place, more = (rest[: aside.start()], rest[aside.start() :]) if aside else (rest, "")
    if not _ASIDE.fullmatch(more):
        raise SettingsError(
            f"{said}: {more!r} behind the address means nothing to Zenoh. Leave it out, {AS_IN}."
        )
    if protocol in WITH_PORT:
        _with_port(place, said)
    elif not place or "\0" in place:
        raise SettingsError(f"{said}: a path is needed behind '{protocol}/'.")
    return endpoint


def _with_port(place: str, said: str) -> None:
    found = _PLACE.fullmatch(place)
    if not found:
        raise SettingsError(f"{said}: an address and a port parted by ':' are needed, {AS_IN}.")
    if int(found[2]) > 65535:
        raise SettingsError(f"{said}: the port {found[2]} lies outside 0 to 65535.")


MAY_COME = (
    "in use",
    "assign requested address",
    "lookup address",
    "No such device",
    "unreachable",
    "refused",
    "timed out",
    "timeout",
    "reset by peer",
    "temporarily",
    "Too many open files",
)


def may_come(why: str) -> bool:
    """Whether what Zenoh says of an opening that failed may be over in a while: an address that is not up
    yet, a port that is still taken, a name that is not known yet, a router that is silent."""
    return any(word.lower() in why.lower() for word in MAY_COME)
