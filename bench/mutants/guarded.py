"""What guards, and the tests that must notice when it does not."""

from typing import NamedTuple

LIVE = "tests/live"


class Guarded(NamedTuple):
    """A source file and its tests, the fastest first."""

    source: str
    tests: tuple[str, ...]


BY_HAND = (f"{LIVE}/certificate/test_theorem_by_hand.py",)
CERTIFICATE = (
    f"{LIVE}/certificate/test_certificate.py",
    f"{LIVE}/certificate/test_observer_tube.py",
)
LOOP = (f"{LIVE}/test_stabilizer.py", f"{LIVE}/test_pause.py", f"{LIVE}/test_assumptions.py")

GUARDED = {
    "recursion": Guarded("twin/live/certificate/recursion.py", BY_HAND),
    "theorem": Guarded("twin/live/certificate/theorem.py", BY_HAND),
    "comparison": Guarded("twin/live/certificate/comparison_systems.py", BY_HAND),
    "periods": Guarded("twin/live/certificate/periods.py", BY_HAND),
    "tube": Guarded("twin/live/certificate/observer_tube.py", (*CERTIFICATE, *LOOP)),
    "store": Guarded("twin/live/certificate/store.py", (f"{LIVE}/test_build.py", *CERTIFICATE[:1])),
    "stabilizer": Guarded("twin/live/stabilizer.py", LOOP),
    "parity": Guarded("twin/live/parity.py", LOOP[2:]),
    "clock": Guarded("twin/live/clock.py", (f"{LIVE}/test_clock.py",)),
    "lagging": Guarded("twin/live/lagging.py", (f"{LIVE}/test_lagging.py",)),
    "gate": Guarded("twin/live/gates/gate.py", (f"{LIVE}/gates/test_sensors.py",)),
    "frozen": Guarded("twin/live/gates/frozen.py", (f"{LIVE}/gates/test_sensors.py",)),
    "cusum": Guarded("twin/live/gates/cusum.py", (f"{LIVE}/gates/test_crosscheck.py",)),
    "stamps": Guarded("twin/live/keelson/stamps.py", (f"{LIVE}/keelson/test_stamps.py",)),
    "source_clock": Guarded("twin/live/keelson/source_clock.py", (f"{LIVE}/keelson/test_stamps.py",)),
    "seats": Guarded("twin/live/keelson/seats.py", (f"{LIVE}/keelson/test_hostile_names.py",)),
    "quota": Guarded("twin/live/log/quota.py", (f"{LIVE}/log/test_quota.py",)),
    "guard": Guarded("twin/live/guard.py", (f"{LIVE}/test_guard.py",)),
}
