"""The page on 127.0.0.1, for whoever holds the link: its token opens the page once, a cookie keeps it open.

Every request is asked for the name it was sent to (no other site may point a name here), where it comes from,
and the cookie. Only the files of the page exist; a path is looked up in a table and never on a disk."""

import hmac
import json
import secrets
from collections.abc import Callable
from contextlib import suppress
from http.cookies import CookieError, SimpleCookie
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from threading import BoundedSemaphore, Lock
from typing import TYPE_CHECKING
from urllib.parse import parse_qs, urlsplit

from twin.errors import TwinError

if TYPE_CHECKING:
    from twin.live.bridge.watch import BridgeWatch

HOST = "127.0.0.1"
MOST_VIEWERS = 16  # event streams at a time
MAX_BODY = 2000  # bytes
TIMEOUT_S = 10.0  # for a request, and for a viewer that takes nothing
KINDS = {"html": "text/html", "css": "text/css", "js": "text/javascript", "svg": "image/svg+xml"}
NAMES = ("page.html", "page.css", "main.js", "chart.js", "panels.js", "dom.js", "look.js", "icon.svg")
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}
CLOSED = "This page is opened with the link that twin view prints. Each link opens it once.\n"


class Doors:
    """Who may come in: the link's token once, then the cookie."""

    def __init__(self, said: Callable[[str], None]):
        self._said, self._lock = said, Lock()
        self.session = secrets.token_urlsafe(32)
        self._token = ""

    def new_link(self, port: int) -> None:
        """Make a link with a new token, and say it."""
        self._token = secrets.token_urlsafe(32)
        self._said(f"http://{HOST}:{port}/?token={self._token}")

    def opened(self, token: str, port: int) -> bool:
        """Whether the token is the one of the newest link; it opens nothing again, and a new one is said."""
        with self._lock:
            good = bool(self._token) and hmac.compare_digest(token.encode(), self._token.encode())
            if good:
                self.new_link(port)
            return good

    def known(self, session: str) -> bool:
        """Whether this is the session's cookie."""
        return hmac.compare_digest(session.encode(), self.session.encode())


class Server(ThreadingHTTPServer):
    """The page, its events, and the acknowledging of alarms."""

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, watch: "BridgeWatch", port: int, said: Callable[[str], None]):
        try:
            super().__init__((HOST, port), Handler)
        except (OSError, OverflowError) as failure:
            why = getattr(failure, "strerror", None) or failure
            raise TwinError(
                f"{HOST}:{port}: {why}. Choose another with --port, 0 for any free one."
            ) from None
        self.watch, self.doors = watch, Doors(said)
        self.pages = pages()
        self.seats = BoundedSemaphore(MOST_VIEWERS)
        self.hosts = {f"{HOST}:{self.port}", f"localhost:{self.port}"}
        self.doors.new_link(self.port)

    @property
    def port(self) -> int:
        """Where it listens."""
        return int(self.server_address[1])

    @property
    def cookie(self) -> str:
        """The name of its cookie: a port each has its own."""
        return f"twin-view-{self.port}"

    def handle_error(self, request: object, client_address: object) -> None:
        """A viewer that went away is no news."""


def pages() -> dict[str, tuple[str, bytes]]:
    """{path: (type, bytes)}: all there is."""
    folder = files("twin.live.bridge")
    found = {}
    for name in NAMES:
        kind = KINDS[name.rpartition(".")[2]]
        found["/" if name == "page.html" else f"/{name}"] = (
            f"{kind}; charset=utf-8",
            (folder / name).read_bytes(),
        )
    return found


class Handler(BaseHTTPRequestHandler):
    """One request."""

    server: Server
    server_version, sys_version = "shiptwin", ""
    timeout = TIMEOUT_S

    def do_GET(self) -> None:
        """Let the link's holder in; then the page's files and its events."""
        address = urlsplit(self.path)
        if not self._ours():
            return
        token = parse_qs(address.query).get("token", [""])[0]
        if address.path == "/" and token:
            return self._let_in(token)
        if not self._known():
            return self._say(403, CLOSED)
        if address.path == "/events":
            return self._events()
        kind, data = self.server.pages.get(address.path, ("", b""))
        return self._send(200, data, kind) if kind else self._say(404, "There is no such page.\n")

    def do_POST(self) -> None:
        """Acknowledge an alarm."""
        if not self._ours(must_say=True):
            return
        if not self._known():
            return self._say(403, CLOSED)
        if urlsplit(self.path).path != "/acknowledge":
            return self._say(404, "There is no such page.\n")
        key = self._key()
        if key is None:
            return self._say(400, 'An alarm is named as {"key": "..."}.\n')
        found = self.server.watch.acknowledge(key)
        return self._send(204, b"", "") if found else self._say(404, "There is no such alarm (any more).\n")

    def _ours(self, must_say: bool = False) -> bool:
        """Whether it was sent to us by name, and by our own page or by nobody; answers when it was not."""
        host, origin = self.headers.get("Host", ""), self.headers.get("Origin")
        site = self.headers.get("Sec-Fetch-Site", "none")
        good = host in self.server.hosts and site in ("none", "same-origin")
        good &= origin == f"http://{host}" if must_say or origin is not None else True
        if not good:
            self._say(403, "Sent to another name, or by another page: refused.\n")
        return good

    def _known(self) -> bool:
        cookies: SimpleCookie = SimpleCookie()
        with suppress(CookieError):
            cookies.load(self.headers.get("Cookie", ""))
        found = cookies.get(self.server.cookie)
        return found is not None and self.server.doors.known(found.value)

    def _let_in(self, token: str) -> None:
        if not self.server.doors.opened(token, self.server.port):
            return self._say(403, CLOSED)
        session = f"{self.server.cookie}={self.server.doors.session}"
        self.send_response(303)
        self._heads({"Location": "/", "Set-Cookie": f"{session}; Path=/; HttpOnly; SameSite=Strict"})

    def _key(self) -> str | None:
        """The alarm that a request names; None when it names none."""
        with suppress(ValueError, RecursionError):
            length = int(self.headers.get("Content-Length", ""))
            if 0 <= length <= MAX_BODY:
                said = json.loads(self.rfile.read(length))
                key = said.get("key") if isinstance(said, dict) else None
                return key if isinstance(key, str) else None
        return None

    def _events(self) -> None:
        """Frames as they are made, and the way behind when it grew, until the viewer is gone."""
        if not self.server.seats.acquire(blocking=False):
            return self._say(503, f"{MOST_VIEWERS} pages are open already.\n")
        try:
            self.send_response(200)
            self._heads({"Content-Type": "text/event-stream"})
            number, trail_number, watch = 0, -1, self.server.watch
            while True:
                frame = watch.newer(number, TIMEOUT_S)
                if frame is None:
                    continue
                number, text = frame
                if watch.trail_number != trail_number:
                    trail_number = watch.trail_number
                    self.wfile.write(f"event: trail\ndata: {json.dumps(list(watch.trail))}\n\n".encode())
                self.wfile.write(f"data: {text}\n\n".encode())
        except OSError:
            pass
        finally:
            self.server.seats.release()

    def _say(self, code: int, text: str) -> None:
        self._send(code, text.encode(), "text/plain; charset=utf-8")

    def _send(self, code: int, data: bytes, kind: str) -> None:
        self.send_response(code)
        self._heads({"Content-Type": kind, "Content-Length": str(len(data))} if kind else {})
        if self.command != "HEAD":
            self.wfile.write(data)

    def _heads(self, more: dict[str, str]) -> None:
        for name, value in (HEADERS | more).items():
            self.send_header(name, value)
        self.end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Nothing: the link's token would stand in it."""
