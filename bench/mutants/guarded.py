"""What guards, and the tests that must notice when it does not."""

from typing import NamedTuple

LIVE = "tests/live"


class Guarded(NamedTuple):
    """A source file and its tests, the fastest first; `part`: of files whose tests are so many that a fault
    is shown only to those that reach it."""

    source: str
    tests: tuple[str, ...]
    part: str = ""


BY_HAND = (f"{LIVE}/certificate/test_theorem_by_hand.py",)
CERTIFICATE = (
    f"{LIVE}/certificate/test_certificate.py",
    f"{LIVE}/certificate/test_observer_tube.py",
)
LOOP = (f"{LIVE}/test_stabilizer.py", f"{LIVE}/test_pause.py", f"{LIVE}/test_assumptions.py")

LOG, GATES = f"{LIVE}/log", f"{LIVE}/gates"
SAILED = (f"{LIVE}/test_promise_returns.py", f"{LIVE}/test_assumptions.py", f"{LIVE}/test_lost_controls.py")
PARTS = {  # the files of a part, by folder, and all tests that may notice
    "guard": (
        "twin/live",
        ("guard",),
        (f"{LIVE}/test_guard_ladder.py", f"{LIVE}/test_guard.py", f"{LIVE}/test_loop.py"),
    ),
    "gates": (
        "twin/live/gates",
        (
            *("actuator_rates", "crosscheck", "cusum", "faults", "frozen", "gate", "hole"),
            *("lacking", "noise", "plausible", "rivals", "rudder_feedback", "sensors"),
        ),
        (GATES, *SAILED, f"{LIVE}/test_loop.py", f"{LIVE}/test_noisy.py"),
    ),
    "stabilizer": (
        "twin/live",
        ("stabilizer", "left_open", "contradiction", "parity", "tube_kept", "seen"),
        (
            f"{LIVE}/test_contradiction_by_hand.py",
            *LOOP,
            *SAILED[::2],
            f"{LIVE}/test_guard.py",
            f"{LIVE}/test_boat_in_waves.py",
            f"{GATES}/test_crosscheck.py",
        ),
    ),
    "recorder": (
        "twin/live/log",
        ("record", "segment", "logfile", "recover", "quota", "mcap_write", "mcap_index"),
        (LOG, f"{LIVE}/test_collector_off.py", "tests/recording/test_damaged.py"),
    ),
}

GUARDED = {
    "recursion": Guarded("twin/live/certificate/recursion.py", BY_HAND),
    "theorem": Guarded("twin/live/certificate/theorem.py", BY_HAND),
    "comparison": Guarded("twin/live/certificate/comparison_systems.py", BY_HAND),
    "periods": Guarded("twin/live/certificate/periods.py", BY_HAND),
    "tube": Guarded("twin/live/certificate/observer_tube.py", (*CERTIFICATE, *LOOP)),
    "store": Guarded("twin/live/certificate/store.py", (f"{LIVE}/test_build.py", *CERTIFICATE[:1])),
    "clock": Guarded("twin/live/clock.py", (f"{LIVE}/test_clock.py",)),
    "lagging": Guarded("twin/live/lagging.py", (f"{LIVE}/test_lagging.py",)),
    "stamps": Guarded("twin/live/keelson/stamps.py", (f"{LIVE}/keelson/test_stamps.py",)),
    "source_clock": Guarded("twin/live/keelson/source_clock.py", (f"{LIVE}/keelson/test_stamps.py",)),
    "seats": Guarded("twin/live/keelson/seats.py", (f"{LIVE}/keelson/test_hostile_names.py",)),
}
GUARDED |= {
    name: Guarded(f"{folder}/{name}.py", tests, part)
    for part, (folder, names, tests) in PARTS.items()
    for name in names
}
