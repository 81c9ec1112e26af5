"""A voyage of a minute as ticks and as a log; a feed that is given its ticks; a page that is served."""

from threading import Thread

import pytest

from twin.live.bridge.feed import About
from twin.live.bridge.server import Server
from twin.live.bridge.watch import BridgeWatch
from twin.live.log.logfile import LogFile
from twin.live.log.mcap_index import PROVENANCE
from twin.live.provenance import provenance
from twin.live.signals.config import Settings

TOPIC = "twin/@v0/ship/pubsub/twin_tick/twin"


class Given:
    """A feed of ticks made beforehand: `give` some, and they are there at the next poll."""

    def __init__(self, about):
        self.name, self.about, self.over = "given", about, False
        self._waiting = []

    def give(self, *ticks):
        self._waiting += ticks

    def poll(self, now_s):
        taken, self._waiting = self._waiting, []
        return taken


@pytest.fixture
def ticks(make_bridge):
    """Twenty seconds of a twin, the first prediction among them."""
    return make_bridge().run(20.0)


@pytest.fixture
def feed(kvlcc2):
    return Given(About("MV Alma", kvlcc2.L_pp, kvlcc2.B, "0.2.0"))


@pytest.fixture
def watch(feed):
    return BridgeWatch(feed)


@pytest.fixture
def log(ticks, kvlcc2, tmp_path):
    path = tmp_path / "voyage.mcap"
    with LogFile(path) as file:
        file.describe(PROVENANCE, provenance(Settings(), kvlcc2))
        for tick in ticks:
            file.add(TOPIC, "shiptwin.Tick", tick.SerializeToString(), round(tick.wall_s * 1e9))
    return path


@pytest.fixture
def links():
    return []


@pytest.fixture
def server(watch, links):
    """The page on a free port, served until the test ends; `links` are those that were said."""
    watch.step(0.0)
    with Server(watch, 0, links.append) as server:
        thread = Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
        thread.start()
        yield server
        server.shutdown()
