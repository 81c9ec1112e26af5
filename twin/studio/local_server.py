"""`twin studio`: the page on 127.0.0.1, for whoever holds the printed link."""

import argparse
import socket
import sys
import webbrowser
from pathlib import Path

import uvicorn

from twin.errors import TwinError, UsageError
from twin.live.bridge.server import HOST, Doors
from twin.studio.app import Studio
from twin.studio.doors import DoorGuard

STOP_S = 2  # for pages that are open when it ends


def served(args: argparse.Namespace) -> int:
    """Serves until it is told to stop; the exit code."""
    if not 0 <= args.port <= 65535:
        raise UsageError(f"--port {args.port}: 0 (any free one) to 65535.")
    folder = Path(args.folder)
    if args.demo:
        if args.read_only:
            raise UsageError("--demo copies files into the folder: leave out --read-only.")
        folder.mkdir(parents=True, exist_ok=True)
    studio = Studio(folder, args.read_only)
    if args.demo:
        studio.project.take_demo()
    with listening(args.port) as sock:
        port = int(sock.getsockname()[1])
        links: list[str] = []

        def said(link: str) -> None:
            links.append(link)
            print(f"open once: {link}", flush=True)

        doors = Doors(said)
        doors.new_link(port)
        app = DoorGuard(studio.app(), doors, port)
        print(f"project {studio.project.folder}; Ctrl-C ends it, work goes on", file=sys.stderr, flush=True)
        if not args.no_browser:
            webbrowser.open(links[0])
        settings = uvicorn.Config(
            app,
            log_level="error",
            access_log=False,
            server_header=False,
            timeout_graceful_shutdown=STOP_S,
            lifespan="on",
            h11_max_incomplete_event_size=32 * 1024,
            limit_concurrency=200,
        )
        uvicorn.Server(settings).run(sockets=[sock])
    return 0


def listening(port: int) -> socket.socket:
    """A socket on this computer's own address, and on no other."""
    sock = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        sock.bind((HOST, port))
        sock.listen(128)  # so that whoever opens the link at once waits, and is not turned away
    except OSError as failure:
        sock.close()
        raise TwinError(
            f"{HOST}:{port}: {failure.strerror}. Choose another with --port, 0 for any free one."
        ) from None
    return sock
