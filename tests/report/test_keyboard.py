"""Every page by keyboard, on a phone's width and on paper: what the mouse can do the keys can do, too.

Pictures: REPORT_PICTURES=FOLDER pytest tests/report/test_keyboard.py."""

import base64
import importlib
import json
import os
import pkgutil
import time

import pytest

import twin.api
from tests.report import pages
from twin.api.result import Result
from twin.physics.effects import find
from twin.physics.model import Model

OF_VERBS = ("history", "project", "replay", "training")  # pages that no class of results has
KINDS = (
    "Calibration",
    "Comparison",
    "Diagnosis",
    "EffectCheck",
    "FirstModel",
    "Fleet",
    "InstrumentCheck",
    "Simulation",
    "TubeCalibration",
    "Update",
    "VoyageCheck",
    *OF_VERBS,
)
WITH_PLOTS = ("Comparison", "Diagnosis", "Update")
PICTURES = os.environ.get("REPORT_PICTURES")
# notes every element that hears the mouse by addEventListener; those that do by a property are asked
HEARS = """const hears = new WeakSet(), add = EventTarget.prototype.addEventListener;
EventTarget.prototype.addEventListener = function (kind, ...rest) {
  if (/^(click|dblclick|mouse|pointer|touch)/.test(kind) && this instanceof Element) hears.add(this);
  return add.call(this, kind, ...rest);
};
window.mouseHeardBy = () => [...document.querySelectorAll("body *")].filter((e) => e.checkVisibility()
  && (hears.has(e) || ["onclick", "ondblclick", "onpointerdown", "onpointermove", "onmousedown"].some((k) => e[k])
  || e.matches("a[href], button, summary, input, select")));
window.placeOf = (e) => [...document.querySelectorAll("*")].indexOf(e);"""
AT = """(() => { const e = document.activeElement;
  if (e === document.body || e === document.documentElement) return null;
  const box = e.getBoundingClientRect(), style = getComputedStyle(e);
  const x = Math.min(Math.max(box.left + Math.min(box.width, 40) / 2, 1), innerWidth - 1);
  const y = Math.min(Math.max(box.top + Math.min(box.height, 16) / 2, 1), innerHeight - 1);
  const top = document.elementFromPoint(x, y);
  return { place: placeOf(e), what: `${e.tagName} ${e.className} ${(e.getAttribute("aria-label") || e.textContent).slice(0, 60)}`,
    named: Boolean((e.getAttribute("aria-label") || e.textContent).trim()),
    marked: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2,
    seen: box.bottom > 0 && box.top < innerHeight && (e.contains(top) || top?.contains(e)) }; })()"""
NEEDED = "mouseHeardBy().filter((e) => !e.classList.contains('draw')).map((e) => [placeOf(e), e.outerHTML.slice(0, 90)])"
FREE = "[...document.querySelectorAll('[role=img], [role=group], [role=slider], canvas')].filter((e) => e.checkVisibility() && !e.closest('[aria-label]') && !e.closest('.legend')).map((e) => e.outerHTML.slice(0, 90))"


@pytest.fixture(scope="module")
def every(tmp_path_factory):
    """All pages, of two short voyages of a ship in a current that its model does not have."""
    from tests.study.conftest import ship, voyage
    from twin.study.reference.sailed import Sailed
    from twin.study.track.track import track

    def one(name):
        stream = find("Current").absent(ship()).but(east=0.8)
        made = voyage(stream, name=name, seconds=500.0, noise=1.0 - 1e-6 * len(name))
        return Sailed(made, track(made, ship()), name)

    return pages.made(tmp_path_factory.mktemp("pages"), one, Model.of(ship()), ship())


@pytest.fixture(scope="module")
def page(tab):
    tab.leave()
    tab.ask("Page.addScriptToEvaluateOnNewDocument", source=HEARS)
    return tab


def opened(page, path, width=1200, height=800):
    page.size(width, height)
    page.leave()
    page.open(f"file://{path}")
    page.wait("document.readyState === 'complete' && !!window.placeOf && !!document.querySelector('h1')")
    page.ask("Page.bringToFront")
    time.sleep(0.1)


def walked(page, shift=False):
    """The places that Tab comes to, from the top of the page until it leaves it."""
    page.value("document.activeElement.blur(); scrollTo(0, 0)")
    stops, most = (
        [],
        40 + 2 * page.value("document.querySelectorAll('a, button, summary, [tabindex]').length"),
    )
    for _ in range(most):
        page.press("Tab", 9, shift=shift)
        at = page.value(AT)
        if at is None or (stops and at["place"] == stops[0]["place"]):
            return stops
        stops.append(at)
    raise AssertionError(f"Tab does not come out: {[s['what'] for s in stops[-4:]]}")


def test_no_kind_of_page_is_forgotten(every):
    """Expected: each class of results that has a page, and the page of a project."""
    for module in pkgutil.iter_modules(twin.api.__path__):
        importlib.import_module(f"twin.api.{module.name}")
    kinds = {c.__name__ for c in Result.__subclasses__()} | set(OF_VERBS)
    assert kinds == set(KINDS) == set(every)


@pytest.mark.parametrize("kind", KINDS)
def test_tab_comes_to_all_that_the_mouse_can_use_and_leaves_it(page, every, kind):
    """Test: Tab through the whole page, and back. Expected: every element that hears the mouse is reached (plots
    have their axis for that, see below), in the page's order, marked, in view and with a name; no trap."""
    for width in (1200, 360):
        opened(page, every[kind], width)
        stops = walked(page)
        places = [stop["place"] for stop in stops]
        assert places == sorted(set(places))
        missed = [what for place, what in page.value(NEEDED) if place not in places]
        assert not missed, f"{width} px"
        for fact in ("named", "marked", "seen"):
            assert not [stop["what"] for stop in stops if not stop[fact]], f"{fact}, {width} px"
        assert page.value(FREE) == []
        assert {stop["place"] for stop in walked(page, shift=True)} == set(places)
    assert not page.said


def focus(page, selector):
    """The element, reached by Tab."""
    page.value("document.activeElement.blur(); scrollTo(0, 0)")
    for _ in range(400):
        page.press("Tab", 9)
        if page.value(f"document.activeElement.matches({json.dumps(selector)})"):
            return
    raise AssertionError(f"Tab does not come to {selector}")


def key(page, name):
    codes = {"Enter": 13, " ": 32, "Escape": 27, "Home": 36, "End": 35, "ArrowLeft": 37, "ArrowRight": 39}
    text = {"Enter": "\r", " ": " ", "+": "+", "-": "-"}.get(name, "")
    page.press(name, codes.get(name, ord(name[0])), text)


def span(page):
    return page.value("[view.from, view.to]")


@pytest.mark.parametrize("kind", WITH_PLOTS)
def test_the_keys_do_on_the_plots_what_the_mouse_does(page, every, kind):
    """Test: a moment shown on every plot, a stretch chosen, nearer, wider, the whole, a place of the heat strip, a
    worst window, another voyage. Expected: each by keys alone, and the focus stays where it was."""
    opened(page, every[kind])
    whole = span(page)
    focus(page, "#plots [role=slider]")
    key(page, "Home")
    for _ in range(20):
        key(page, "ArrowRight")
    now = float(page.value("document.activeElement.getAttribute('aria-valuenow')"))
    assert now == pytest.approx(whole[0] + 0.2 * (whole[1] - whole[0]), abs=1.0)
    said = page.value("[...document.querySelectorAll('#plots .value')].map((e) => e.textContent.trim())")
    assert all(said) and len(set(said)) > 3
    cursors = "[...document.querySelectorAll('#plots .cursor')].map((e) => e.style.display + e.style.left)"
    assert len(set(page.value(cursors))) == 1 and page.value(cursors)[0].startswith("block")
    key(page, "Enter")
    for _ in range(30):
        key(page, "ArrowRight")
    assert " to " in page.value("document.activeElement.getAttribute('aria-valuetext')")
    key(page, "Enter")
    assert span(page) == pytest.approx([now, now + 0.3 * (whole[1] - whole[0])], abs=2.0)
    wide = span(page)[1] - span(page)[0]
    key(page, "+")
    assert span(page)[1] - span(page)[0] == pytest.approx(wide / 2, rel=0.01)
    key(page, "-")
    key(page, "Escape")
    assert span(page) == whole
    key(page, "Enter")
    page.size(700, 800)
    page.wait(f"{cursors}.every((shown) => shown.startsWith('none'))")
    assert page.value("document.documentElement.scrollWidth") <= 700
    page.size(1200, 800)
    focus(page, "canvas[role=slider]")
    key(page, "End")
    key(page, "ArrowLeft")
    key(page, " ")
    assert span(page) != whole and span(page)[1] == whole[1]
    assert page.value("document.activeElement.matches('canvas[role=slider]')")
    key(page, "Escape")
    assert span(page) == whole
    focus(page, "tr.go")
    key(page, "Enter")
    assert span(page) != whole and page.value("document.activeElement.matches('tr.go')")
    focus(page, "[aria-pressed=false]")
    key(page, " ")
    assert page.value("view.voyage") == 1
    assert page.value("document.activeElement.getAttribute('aria-pressed')") == "true"


@pytest.mark.parametrize("kind", [k for k in KINDS if k in (*WITH_PLOTS, "Fleet", "project", "replay")])
def test_buttons_are_pressed_by_enter_and_by_the_space_bar_and_keep_the_focus(page, every, kind):
    opened(page, every[kind])
    shown = "document.documentElement.dataset.theme"
    for name in ("Enter", " "):
        before = page.value(shown)
        focus(page, "header button")
        key(page, name)
        assert page.value(shown) != before and page.value("document.activeElement.matches('header button')")
    focus(page, ".command button")
    key(page, "Enter")
    assert page.value("document.activeElement.matches('.command button')")
    if page.value("!!document.querySelector('summary')"):
        focus(page, "summary")
        key(page, " ")
        assert page.value("document.querySelector('details').open")


@pytest.mark.parametrize("kind", KINDS)
def test_a_page_fits_a_phone_and_paper(page, every, kind):
    """Test: 360 px; printed from the dark page. Expected: nothing wider than the screen; on paper every text is
    dark on light, no button, nothing cut off that would have to be scrolled, and afterwards the page is as it was."""
    opened(page, every[kind], 360)
    assert page.value("document.documentElement.scrollWidth") <= 360
    small = "[...document.querySelectorAll('svg text')].filter((e) => e.getBoundingClientRect().height < 11).length"
    assert page.value(small) == 0
    if PICTURES:
        page.picture(os.path.join(PICTURES, f"{kind}-360.png"), whole=True)
    opened(page, every[kind], 794, 1123)
    page.value("document.documentElement.dataset.theme = 'dark'; window.redraw?.()")
    page.value(
        "addEventListener('beforeprint', () => { window.printedAs = document.documentElement.dataset.theme; })"
    )
    data = page.ask("Page.printToPDF", paperWidth=8.27, paperHeight=11.69)["data"]
    assert page.value("document.documentElement.dataset.theme") == "dark"
    if page.value("!!document.getElementById('data')"):
        assert page.value("window.printedAs") == "light"
    if PICTURES:
        with open(os.path.join(PICTURES, f"{kind}.pdf"), "wb") as file:
            file.write(base64.b64decode(data))
    page.ask("Emulation.setEmulatedMedia", media="print")
    page.value("dispatchEvent(new Event('beforeprint'))")
    hidden = "[...document.querySelectorAll('main *')].filter((e) => e.checkVisibility() && e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).overflowX !== 'visible').map((e) => e.outerHTML.slice(0, 90))"
    buttons = "[...document.querySelectorAll('button')].filter((e) => e.checkVisibility()).length"
    found = page.value(f"[{hidden}, {buttons}, document.documentElement.scrollWidth]")
    page.value("dispatchEvent(new Event('afterprint'))")
    page.ask("Emulation.setEmulatedMedia", media="screen")
    assert found[0] == [] and found[1] == 0 and found[2] <= 794


@pytest.mark.parametrize("kind", (*WITH_PLOTS, "replay"))
def test_what_is_drawn_is_not_squeezed_on_paper(page, every, kind):
    """Test: printed from a window of 1400 px. Expected: each drawing is as high for its width as it was drawn, for a
    page that is about as wide as paper."""
    opened(page, every[kind], 1400)
    page.value("dispatchEvent(new Event('beforeprint'))")
    assert page.value("document.querySelector('main').clientWidth") == 720
    page.ask("Emulation.setEmulatedMedia", media="print")
    drawn = page.value(
        "[...document.querySelectorAll('main canvas')].filter((e) => e.checkVisibility())"
        ".map((e) => [e.width / e.height, e.clientWidth / e.clientHeight])"
    )
    page.ask("Emulation.setEmulatedMedia", media="")
    page.value("dispatchEvent(new Event('afterprint'))")
    assert len(drawn) > 8
    for made, shown in drawn:
        assert shown == pytest.approx(made, rel=0.03)
