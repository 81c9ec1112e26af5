"""Files: a ship, a certificate, a log, a table. What cannot be used is one line (TwinError), never another
exception; what can be used is usable to the end."""

import hashlib
import json
import os
import tempfile
from math import isfinite, radians
from pathlib import Path
from typing import Any

from bench.fuzz.take import Take
from twin.errors import TwinError
from twin.live.certificate.certificate import Certificate, certify, on_board
from twin.live.certificate.observer_tube import Tube
from twin.live.certificate.rolled_tube import tube_of
from twin.live.log.log_rows import read_rows
from twin.live.log.mcap_read import McapReader
from twin.live.log.recover import recover
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation
from twin.recording.read import read_voyage


class Unfit(AssertionError):
    """Something that was accepted cannot be used, or a refusal is more than one line."""


def _demand(kept: bool, what: str) -> None:
    if not kept:
        raise Unfit(what)


class FileTarget:
    """Bytes into a file in memory; `use` opens it."""

    names: tuple[str, ...] = ("file",)

    def __init__(self) -> None:
        memory = "/dev/shm" if os.path.isdir("/dev/shm") else None
        self._folder = tempfile.TemporaryDirectory(dir=memory)  # goes when the target does

    def one(self, data: bytes) -> None:
        name = self.names[0] if len(self.names) == 1 else self.names[(data or b"\0")[0] % len(self.names)]
        path = Path(self._folder.name) / name
        path.write_bytes(data if len(self.names) == 1 else data[1:])
        try:
            self.use(path)
        except TwinError as error:
            _demand("\n" not in str(error).strip(), f"more than a line: {error}")
        finally:
            for left in Path(self._folder.name).iterdir():
                left.unlink()

    def use(self, path: Path) -> None:
        raise NotImplementedError


class ShipTarget(FileTarget):
    """A ship file: refused, or a model that says how the ship accelerates in a usual turn."""

    names = ("ship.toml",)

    def use(self, path: Path) -> None:
        ship = load(path)
        model = Model.of(ship)
        s = Situation(u=0.8 * ship.U_0, v=0.1, r=0.001, delta=radians(5.0), n=1.0)
        _demand(all(isfinite(x) for x in model.nu_dot(s)), "an acceleration that is not finite")


class LogTarget(FileTarget):
    """An MCAP file: read, read as rows, finished as after a crash, and read again."""

    names = ("log.mcap",)

    def use(self, path: Path) -> None:
        reader = McapReader(path)
        try:
            for message in reader.messages():
                _demand(isinstance(message.topic, str) and message.log_ns >= 0, str(message)[:200])
        except TwinError:
            pass
        _demand(all("\n" not in problem for problem in reader.problems), str(reader.problems))
        recover(path)
        read_rows(path, [], [])


class TableTarget(FileTarget):
    """A table or a bridge's log of any text format: one line, or a voyage. The first byte says its name."""

    names = ("v.csv", "v.log", "v.nmea", "v.txt", "v.jsonl", "v.json", "v.toml", "v.csv.gz")

    def use(self, path: Path) -> None:
        voyage = read_voyage(path, controls=False)
        _demand(len(voyage) > 0 and all(map(isfinite, voyage.time_s)), "a time that is not finite")


class CertificateTarget:
    """The certificate's own file: other text, or a true one in which numbers were changed and the checksum
    made to fit. Accepted is only what the theorem makes of the rest, and it can be stepped."""

    def __init__(self) -> None:
        ship = load("kvlcc2", arrays=False)
        made = certify(Model.of(ship), None, 0.105, **on_board(ship, 5, True, (1e5, 1e5, 1e7)))
        self.text = made.to_json()
        self.paths = list(_leaves(json.loads(self.text)))

    def one(self, data: bytes) -> None:
        take = Take(data)
        text = take.rest().decode("utf-8", "replace") if take.byte() % 4 == 0 else self._changed(take)
        try:
            found = Certificate.from_json(text)
        except (ValueError, KeyError, TypeError):
            return
        _demand(found.follows(), "accepted, and promises what does not follow")
        tube = tube_of(found)
        if isinstance(tube, Tube) and found.ok:
            for k in range(20):
                tube.step((k % 3 > 0,) * 3, dt=found.h * (1, 1, 1, 4)[k % 4])
            _demand(all(b >= 0.0 for b in tube.beta), f"a bound of {tube.beta}")

    def _changed(self, take: Take) -> str:
        table = json.loads(self.text)
        table.pop("sha256")
        version = table.pop("version")
        for _ in range(1 + take.byte() % 3):
            place = self.paths[take.short() % len(self.paths)]
            _put(table, place, take)
        told = {"version": version, "sha256": _digest(table), **table}
        return json.dumps(told)


def _digest(table: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(table, sort_keys=True).encode()).hexdigest()


def _leaves(value: Any, place: tuple[Any, ...] = ()) -> Any:
    """Where each number, word and list of a table stands, apart from version and checksum."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        if key not in ("sha256", "version"):
            yield (*place, key)
            yield from _leaves(inner, (*place, key))


def _put(table: Any, place: tuple[Any, ...], take: Take) -> None:
    """Another value there: any double, a neighbour, another kind, or nothing."""
    for key in place[:-1]:
        try:
            table = table[key]
        except (KeyError, IndexError, TypeError):
            return  # an earlier change took it away
    kind, last = take.byte() % 7, place[-1]
    try:
        if kind == 0 and isinstance(table, dict):
            table.pop(last, None)
        elif kind == 1 and isinstance(table[last], (int, float)):
            table[last] = table[last] * (0.5 + take.share())
        else:
            table[last] = (take.number(), 0, -1, [], "", None, True, 10**400)[take.byte() % 8]
    except (KeyError, IndexError, TypeError, OverflowError):
        return
