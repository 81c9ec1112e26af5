"""A fault between the sensors and the twin: a proxy on the bus."""

import signal
import time

from google.protobuf.message import DecodeError

from twin.live.injection.faulty import Faulty, Sample
from twin.live.injection.inject import InjectedFault
from twin.live.keelson import messages
from twin.live.keelson.bus import Bus
from twin.live.keelson.topics import OF_ACTUATORS, address, is_own, topic_of
from twin.live.keelson.zenoh_bus import ZenohBus
from twin.live.keelson.zenoh_config import BusSettings

STEP_S = 0.005  # how often the proxy looks for messages


def proxy(
    what: str, fault: InjectedFault, listen: str, connect: str, base: str, entity: str, duration_s: float
) -> int:
    """Hear at one place, say at the other, with the fault in between, until told to stop. The last thing a
    process does (twin/live/ending.py): the signals that end it are taken."""
    stop: list[int] = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda caught, _: stop.append(caught))
    between = ZenohBus(BusSettings(base, entity, listen, (connect,)))
    between.listen_to(list(OF_ACTUATORS))
    with between as bus:
        print(f"{listen} -> {connect}: {what} {fault.kind}. Stop it with Ctrl-C.", flush=True)
        began_s, faulty = time.monotonic(), None
        while not stop and time.monotonic() - began_s < duration_s:
            for key, envelope, now_s in bus.drain(time.monotonic()):
                faulty = faulty or Faulty(what, fault._replace(start_s=now_s + fault.start_s))
                _pass_on(bus, faulty, key, envelope, now_s)
            time.sleep(STEP_S)
        said = bus.state
        print(
            f"{said.received} messages heard, {said.published} passed on, "
            f"{faulty.changed if faulty else 0} with the fault"
        )
    return 0


def _pass_on(bus: Bus, faulty: Faulty, key: str, envelope: bytes, now_s: float) -> None:
    place = address(key)
    topic = topic_of(place) if place else None
    if place is None or topic is None or is_own(place.source):
        return
    try:
        wall_ns, payload = messages.unwrap(envelope)
    except DecodeError:
        bus.publish(key, envelope)
        return
    for sample in faulty.feed(Sample(now_s, key, topic.type_name, payload)):
        bus.publish(sample.key, messages.wrap(sample.payload, wall_ns))
