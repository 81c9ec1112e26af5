"""Live: the bridge's page (docs/view.md) of a running twin, or of a log of one, inside the workbench; what
it needs is imported when a twin is looked at, not before the first picture."""

import json
import time
from threading import Thread
from typing import TYPE_CHECKING, Any

import anyio
from starlette.requests import Request
from starlette.responses import JSONResponse, PlainTextResponse, Response, StreamingResponse

from twin.errors import UsageError
from twin.live.bridge.server import MAX_BODY, pages

if TYPE_CHECKING:
    from twin.live.bridge.feed import BridgeFeed
    from twin.live.bridge.watch import BridgeWatch

WAIT_S = 2.0  # for a frame, before it is asked whether the viewer is still there
MOST_VIEWERS = 16


class Live:
    """At most one twin is looked at; its frames are made by a thread of their own, ten a second."""

    def __init__(self) -> None:
        self.watch: BridgeWatch | None = None
        self._viewers = 0
        self.pages = pages()

    def attach(self, connect: str | None, log: str | None) -> str:
        """Looks at the twin at `connect` (default: on this computer), or at a log; the feed's name."""
        from twin.live.bridge.feed import BusFeed, LogFeed
        from twin.live.bridge.watch import BridgeWatch
        from twin.live.signals import config

        self.leave()
        feed: BridgeFeed
        if log:
            feed = LogFeed(log)
        else:
            settings = config.load(None)
            if connect:
                if len(connect) > 200 or not connect.isprintable():
                    raise UsageError("a place is written as tcp/127.0.0.1:7447.")
                for name, value in (("listen", ""), ("router", ""), ("connect", [connect])):
                    settings = settings.but(f"bus.{name}", value)
            feed = BusFeed(settings)
        watch = self.watch = BridgeWatch(feed)
        watch.step(time.monotonic())
        Thread(target=self._look, args=(watch,), name="live", daemon=True).start()
        return feed.name

    def _look(self, watch: "BridgeWatch") -> None:
        """Until another twin, or none, is looked at."""
        watch.run(lambda: self.watch is watch)
        watch.feed.close()

    @property
    def name(self) -> str:
        """Of what is looked at; "" for nothing."""
        return self.watch.feed.name if self.watch is not None else ""

    def leave(self) -> None:
        self.watch = None

    def page(self, request: Request) -> Response:
        """A file of the bridge's page."""
        path = "/" if request.url.path == "/live" else request.url.path
        kind, data = self.pages[path]
        return Response(data, headers={"Content-Type": kind})

    async def events(self, request: Request) -> Response:
        watch = self.watch
        if watch is None:
            return PlainTextResponse("No twin is looked at. Attach to one first.\n", 404)
        if self._viewers >= MOST_VIEWERS:
            return PlainTextResponse(f"{MOST_VIEWERS} pages are open already.\n", 503)
        return StreamingResponse(self._frames(watch, request), media_type="text/event-stream")

    async def _frames(self, watch: "BridgeWatch", request: Request) -> Any:
        self._viewers += 1
        try:
            number, trail = 0, -1
            while self.watch is watch and not await request.is_disconnected():
                frame = await anyio.to_thread.run_sync(watch.newer, number, WAIT_S)
                if frame is None:
                    continue
                number, text = frame
                if watch.trail_number != trail:
                    trail = watch.trail_number
                    yield f"event: trail\ndata: {json.dumps(list(watch.trail))}\n\n"
                yield f"data: {text}\n\n"
        finally:
            self._viewers -= 1

    async def acknowledge(self, request: Request) -> Response:
        body = await request.body()
        try:
            said = json.loads(body) if len(body) <= MAX_BODY else None
        except ValueError:
            said = None
        key = said.get("key") if isinstance(said, dict) else None
        if not isinstance(key, str) or self.watch is None:
            return PlainTextResponse('An alarm is named as {"key": "..."}.\n', 400)
        return JSONResponse({}) if self.watch.acknowledge(key) else PlainTextResponse("No such alarm.\n", 404)
