"""The page in a real Chromium: what is seen, by keyboard and screen reader, small and large, day and night."""

import threading
import time

import pytest

from tests.chromium import CHROMIUM, FAINT

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here")

NAMELESS = """[...document.querySelectorAll("button, th, table, section, svg[role=img], [role=group]")]
  .filter((e) => e.checkVisibility() && !(e.getAttribute("aria-label") || e.textContent.trim()
    || document.getElementById(e.getAttribute("aria-labelledby"))?.textContent)).map((e) => e.outerHTML.slice(0, 80))"""
THEMES = ("light", "dark", "night")


class Sea:
    """Feeds ten ticks a second until it is stopped, and makes the frames go on."""

    def __init__(self, watch, feed, ticks):
        self.watch, self.feed, self.ticks = watch, feed, ticks
        self.speaks, self.over = True, False
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self):
        i = 0
        while not self.over:
            if self.speaks:
                self.feed.give(self.ticks[i % len(self.ticks)])
                i += 1
            self.watch.step(time.monotonic())
            time.sleep(0.1)


@pytest.fixture
def sea(watch, feed, ticks):
    """From the first prediction on: it is what a page is waited for."""
    for tick in ticks:
        tick.reasons.append("rudder_angle_deg is lost: its last value, 3.1, is held")
        tick.measured.true_wind_speed_mps, tick.measured.true_wind_direction_deg = 8.0, 200.0
    sea = Sea(watch, feed, ticks[next(i for i, tick in enumerate(ticks) if tick.predictions) :])
    yield sea
    sea.over = True
    sea.thread.join(5)


@pytest.fixture
def page(tab, sea, server, links):
    tab.size(1400, 900)
    tab.leave()
    tab.open(links[-1])
    tab.wait("window.twinView?.frame()?.ahead?.shown?.length === 2")
    return tab


def seen(page):
    return page.value("document.body.innerText")


def test_the_page_shows_ship_mode_motion_forces_and_alarms(page):
    text = seen(page)
    for wanted in ("MV Alma", "320 m long, 58 m wide", "not acknowledged", "kN", "200°", "heading"):
        assert wanted in text, wanted
    outlines = page.value("document.querySelectorAll('.later').length")
    assert outlines == 2
    title = page.value("document.getElementById('sea-title').textContent")
    assert "in 60 s" in title and "in 120 s" in title
    assert not page.said


def test_ship_and_grid_have_one_scale(page):
    """Test: the drawn length of the ship against the ruler. Expected: 320 m of the same metres."""
    page.value("window.twinView.look.zoom = 2; document.getElementById('wider').click()")
    time.sleep(0.4)
    length = page.value("document.querySelector('.hull').getBBox().height")
    ruler = page.value("document.querySelector('.ruler').getBBox().width")
    said = page.value("document.querySelector('.ruler').nextSibling.textContent")
    metres = float(said.split()[0]) * (1000.0 if "km" in said else 1.0)
    assert length / ruler * metres == pytest.approx(320.0, rel=0.02)


def test_head_up_turns_the_sea_and_not_the_ship(page):
    page.value("document.getElementById('up').click()")
    page.wait("document.getElementById('up').textContent === 'Head up'")
    time.sleep(0.3)
    turned = page.value("document.querySelector('.hull').getAttribute('transform')")
    assert abs(float(turned.rpartition("(")[2].rstrip(")"))) < 0.1
    page.value("document.getElementById('up').click()")


def test_a_silent_twin_is_marked_over_the_whole_picture_and_live_again_when_it_speaks(page, sea):
    sea.speaks = False
    page.wait("document.documentElement.classList.contains('old')", 5)
    page.wait("document.querySelector('.stamp').textContent === 'OLD'", 5)
    assert "NOTHING HEARD FOR" in seen(page) and page.value("document.title").startswith("OLD")
    assert page.value("getComputedStyle(document.querySelector('.hatch')).visibility") == "visible"
    assert not page.value(FAINT)
    sea.speaks = True
    page.wait("!document.documentElement.classList.contains('old')", 5)
    assert "NOTHING HEARD" not in seen(page)


def test_a_viewer_whose_server_is_gone_is_marked_too(page, sea):
    sea.over = True
    page.wait("document.documentElement.classList.contains('old')", 5)
    assert "HAS NOT ANSWERED FOR" in seen(page)


def test_an_alarm_is_acknowledged_with_the_keyboard_alone(page):
    names = []
    for _ in range(30):
        page.press("Tab", 9)
        names.append(page.value("document.activeElement.textContent"))
        if names[-1] == "Acknowledge":
            break
    assert {"Light", "Dark", "Night", "+", "Fit", "Acknowledge all"} <= set(names)
    page.ask(
        "Input.dispatchKeyEvent",
        type="keyDown",
        key="Enter",
        code="Enter",
        windowsVirtualKeyCode=13,
        text="\r",
    )
    page.ask("Input.dispatchKeyEvent", type="keyUp", key="Enter", code="Enter", windowsVirtualKeyCode=13)
    page.wait("document.querySelector('#alarms li.seen') !== null", 5)
    assert "stands, acknowledged" in seen(page)


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("width", [360, 1400, 3840])
def test_it_is_read_in_every_light_and_on_every_width(page, theme, width):
    """Expected: no text with a contrast below 4.5, nothing wider than the screen, a name for everything."""
    page.size(width, 800)
    page.value(f"document.querySelector('[data-theme-name={theme}]').click()")
    time.sleep(0.4)
    assert not page.value(FAINT)
    assert not page.value(NAMELESS)
    assert page.value("document.documentElement.scrollWidth") <= width
    cut = "[...document.querySelectorAll('.tile, td, th, button')].filter((e) => e.scrollWidth > e.clientWidth + 1)"
    assert not page.value(f"{cut}.map((e) => e.textContent)")


def test_words_of_the_twin_are_never_markup(page, sea):
    for tick in sea.ticks:
        tick.reasons.append("<img src=x onerror=alert(1)><b>bold</b>")
    page.wait("document.body.innerText.includes('<b>bold</b>')", 5)
    assert page.value("document.querySelectorAll('#alarms b, #alarms img').length") == 0
    assert not page.said


def test_ten_frames_a_second_come_and_are_drawn(page):
    script = """new Promise((done) => { let n = 0, last = null;
      const look = () => { const f = twinView.frame(); if (f !== last) { n += 1; last = f; }
        if (performance.now() - from < 3000) requestAnimationFrame(look); else done(n); };
      const from = performance.now(); look(); })"""
    assert page.value(script) >= 20
