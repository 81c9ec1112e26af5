"""What systemd is told: ready, alive after a good step, and how it goes in words. Without systemd nothing
happens."""

import os
import socket
from contextlib import suppress


class Notifier:
    """The socket named by NOTIFY_SOCKET, if there is one."""

    def __init__(self, address: str | None = None):
        address = os.environ.get("NOTIFY_SOCKET", "") if address is None else address
        self._address = "\0" + address[1:] if address.startswith("@") else address
        self._socket = (
            socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC) if address else None
        )
        if self._socket is not None:
            self._socket.setblocking(False)

    def ready(self, status: str) -> None:
        """The service is up."""
        self._send(f"READY=1\nSTATUS={_line(status)}")

    def alive(self) -> None:
        """After a good step, and only then: this is what the watchdog waits for."""
        self._send("WATCHDOG=1")

    def status(self, status: str) -> None:
        """How it goes, in words."""
        self._send(f"STATUS={_line(status)}")

    def stopping(self) -> None:
        """The service ends."""
        self._send("STOPPING=1")

    def _send(self, text: str) -> None:
        if self._socket is None:
            return
        with suppress(OSError):  # a busy or missing service manager must not stop the loop
            self._socket.sendto(text.encode(), self._address)


def _line(text: str) -> str:
    return " ".join(text.split())[:400]
