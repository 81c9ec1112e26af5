"""Three sessions: the twin, one that speaks, one that looks. Prints what was heard. Run by test_zenoh.py.

sessions.py TWIN.json5 SPEAKER.json5 VIEWER.json5 KEY...
"""

import os
import sys
import time

import zenoh

from twin.live.keelson.zenoh_config import BusSettings, configuration

ALL = "*/@v0/*/pubsub/**"
OWN = "twin/@v0/ship/pubsub/twin_tick/twin"


def main(twin_file, speaker_file, viewer_file, *keys):
    twin = zenoh.open(configuration(BusSettings(file=twin_file)))
    ear = twin.declare_subscriber(ALL, zenoh.handlers.FifoChannel(100))
    speaker, viewer = session(speaker_file), session(viewer_file)
    eye = viewer.declare_subscriber(ALL, zenoh.handlers.FifoChannel(100))
    time.sleep(1.0)
    for key in keys if speaker else ():
        speaker.put(key, b"x")
    twin.put(OWN, b"x")
    time.sleep(1.0)
    print("twin heard:", *keys_of(ear, but=OWN))
    print("viewer saw:", *keys_of(eye))
    return 0


def session(file):
    """None when it does not get in."""
    try:
        return zenoh.open(zenoh.Config.from_file(file))
    except zenoh.ZError:
        return None


def keys_of(channel, but=""):
    """Keys of what came in; the twin also hears its own voice, once."""
    found = [str(sample.key_expr) for sample in iter(channel.try_recv, None)]
    if but in found:
        found.remove(but)
    return found


code = 1
try:
    code = main(*sys.argv[1:])
finally:
    sys.stdout.flush()
    os._exit(code)
