"""For all rooms: what hypothesis draws is the same in every run, and how long it takes is no verdict; and who
works beside whom when several processes share the tests (`make tests`).

A file is the work of one process, so what its tests share is made once; the long work begins first, so that
all processes end together. The mark `xdist_group` would say the same beside the tests, but pytest 9.2 does
not hear it."""

import os

import pytest
from hypothesis import settings

settings.register_profile("shiptwin", deadline=None, derandomize=True)
settings.load_profile("shiptwin")

# They measure time, run the loop at its real-time priority or listen at the default port: one process has
# them all, one after the other. bench/test_tick.py runs before all of them and alone (Makefile): its loop is
# thirty times as fast as time, and 30 ms without a processor for the bus are a second without measurements.
BY_THE_CLOCK = (
    "deploy/test_zenoh.py",
    "live/keelson/test_bus.py",
    "live/test_clock.py",
    "live/test_demonstration.py",
    "live/test_realtime.py",
    "live/log/test_record.py",
    "live/log/test_record_faults.py",
    "live/log/test_recover.py",
    "live/test_service.py",
    "live/test_overload.py",
    "live/keelson/test_bus_hostile.py",
    "live/log/test_power_cut.py",
    "live/test_secrets.py",
    "live/keelson/test_sockets.py",
    "live/test_fault.py",
    "live/log/test_quota.py",
    "test_house.py",
    "test_readme.py",
)
# sailed once for these rooms: half a minute
SAME_VOYAGES = (
    "study/diagnosis/",
    "study/reference/",
    "study/estimation/",
    "study/calibration/",
    "study/track/",
)
# a minute or more, the longest first: what begins last must not keep one process busy while the others wait
LONG = (
    "study/test_my_boat.py",
    "studio/test_story.py",
    "study/test_first_hour.py",
    "bench/test_paper.py",
    "studio/test_looks.py",
    "studio/test_calibrate.py",
    "study/update/test_addition.py",
    "bench/test_hidden_effects.py",
    "bench/test_endurance.py",
    "live/gates/test_rudder_feedback.py",
    "study/instruments/test_instruments.py",
    "study/instruments/test_on_references.py",
    "report/test_keyboard.py",
    "live/bridge/test_browser.py",
    "bench/test_instrument_faults.py",
    "deploy/test_install.py",
    "live/keelson/test_stamps.py",
    "test_killed_ship.py",
    "study/prediction/test_open_loop_comparison.py",
)
FIRST = ("by the clock", "same voyages", *LONG)
WAITING = 1  # processes more than cores: a quarter of the time a test waits, for a clock, a bus or a browser
BEHIND = 5  # niceness of those who do not measure time


def work(nodeid):
    """Which piece of work a test belongs to; a process takes whole pieces."""
    name = nodeid.partition("::")[0].removeprefix("tests/")
    if name in BY_THE_CLOCK:
        return "by the clock"
    return "same voyages" if name.startswith(SAME_VOYAGES) else name


def pytest_collection_modifyitems(config, items):
    if hasattr(config, "workerinput"):  # alone, the order is pytest's own
        place = {name: i for i, name in enumerate(FIRST)}
        items.sort(key=lambda item: place.get(work(item.nodeid), len(FIRST)))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers(config):
    return len(os.sched_getaffinity(0)) + WAITING if hasattr(os, "sched_getaffinity") else None


def pytest_runtest_setup(item):
    """A process steps back for good when it has no more tests that measure time; these come first."""
    if hasattr(item.config, "workerinput") and work(item.nodeid) != "by the clock" and os.nice(0) < BEHIND:
        os.nice(BEHIND - os.nice(0))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    if config.getvalue("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    gone = [
        name
        for name in (*BY_THE_CLOCK, *SAME_VOYAGES, *LONG)
        if not (config.rootpath / "tests" / name).exists()
    ]
    if gone:
        raise pytest.UsageError(f"tests/conftest.py names what is not there: {', '.join(gone)}")

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid):
            return work(nodeid)

    config.option.loadscopereorder = False  # which would begin with the files that have the most tests
    return Scheduling(config, log)


@pytest.fixture(scope="session")
def tab(tmp_path_factory):
    """A tab of a real Chromium (tests/chromium.py); whoever takes it opens its own page and sets the size."""
    from tests.chromium import CHROMIUM, Browser

    if CHROMIUM is None:
        pytest.skip("no Chromium here")
    tab = Browser(tmp_path_factory.mktemp("chromium"))
    yield tab
    tab.close()
