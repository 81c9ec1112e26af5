"""Who may come in: the printed link opens the page once, its cookie keeps it open."""

import hmac
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from twin.live.bridge.server import HEADERS, HOST, Doors

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' blob: data:; frame-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'self'"
)
ANSWERED = HEADERS | {"Content-Security-Policy": POLICY, "X-Frame-Options": "SAMEORIGIN"}
CLOSED = "This page is opened with the link that twin studio prints. Each link opens it once.\n"
ELSEWHERE = "Sent to another name, or by another page: refused.\n"
READS = ("GET", "HEAD")


class DoorGuard:
    """Asks every request for the name it was sent to, the page that sent it, and the cookie."""

    def __init__(self, app: ASGIApp, doors: Doors, port: int):
        self._app, self._doors, self._port = app, doors, port
        self.cookie = f"twin-studio-{port}"
        self._hosts = {f"{HOST}:{port}", f"localhost:{port}"}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "lifespan":
            return await self._app(scope, receive, send)
        if scope["type"] != "http":
            return None  # no web socket is served

        async def marked(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in ANSWERED.items():
                    headers[name] = value
            await send(message)

        answer = self._refused(scope)
        return await (answer or self._app)(scope, receive, marked)

    def _refused(self, scope: Scope) -> Response | None:
        """The answer to who may not come in, or who opens the page with the link; None: come in."""
        headers = Headers(scope=scope)
        host, origin = headers.get("host", ""), headers.get("origin")
        own = host in self._hosts and headers.get("sec-fetch-site", "none") in ("none", "same-origin")
        must_say = scope["method"] not in READS
        own &= origin == f"http://{host}" if must_say or origin is not None else True
        if not own:
            return PlainTextResponse(ELSEWHERE, 403)
        token = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        if scope["path"] == "/" and token:
            return self._opened(token)
        return None if self._known(headers.get("cookie", "")) else PlainTextResponse(CLOSED, 403)

    def _opened(self, token: str) -> Response:
        if not self._doors.opened(token, self._port):
            return PlainTextResponse(CLOSED, 403)
        answer = RedirectResponse("/", 303)
        answer.set_cookie(self.cookie, self._doors.session, httponly=True, samesite="strict")
        return answer

    def _known(self, said: str) -> bool:
        cookies: SimpleCookie = SimpleCookie()
        try:
            cookies.load(said)
        except CookieError:
            return False
        found = cookies.get(self.cookie)
        return found is not None and hmac.compare_digest(found.value.encode(), self._doors.session.encode())
