"""How the page looks: in every light and on every width each text can be read, nothing is cut, everything has a name,
and the keyboard reaches it. Pictures for docs/tour.md: STUDIO_PICTURES=FOLDER pytest tests/studio/test_looks.py."""

import json
import os
import time

import pytest

from tests.chromium import FAINT
from twin.studio.jobs import Jobs

NAMELESS = """[...document.querySelectorAll("button, a, input, select, textarea, section, [role=img], [role=group], iframe, article")]
  .filter((e) => e.checkVisibility() && !(e.getAttribute("aria-label") || e.getAttribute("title")
    || e.labels?.[0]?.textContent.trim() || (!e.matches("section, [role=img], [role=group]") && e.textContent.trim())))
  .map((e) => e.outerHTML.slice(0, 120))"""
TWICE = """(() => { const ids = [...document.querySelectorAll("[id]")].map((e) => e.id);
  return ids.filter((id, i) => ids.indexOf(id) !== i); })()"""
# what is drawn after the page itself has come, and is the same for a tenth of a second
STILL = """(async () => { const now = () => [document.body.innerHTML.length, innerWidth, document.documentElement.scrollWidth,
    [...document.querySelectorAll("canvas")].map((e) => [e.width, e.clientWidth])].join();
  const before = now(); await new Promise((d) => setTimeout(d, 100)); await new Promise((d) => requestAnimationFrame(() => requestAnimationFrame(d)));
  return before === now() && document.getAnimations().every((a) => a.playState !== "running"); })()"""
SHIP, MONDAY, TUESDAY = "tanker.toml", ["monday.mcap"], ["tuesday.mcap"]
ASKED = (
    {"verb": "look", "file": "owner.csv", "ship": SHIP},
    {"verb": "compare", "ship": SHIP, "voyages": MONDAY},
    {"verb": "diagnose", "ship": SHIP, "voyages": MONDAY},
    {
        "verb": "add",
        "ship": SHIP,
        "voyages": MONDAY,
        "held_outs": TUESDAY,
        "effects": ["HullFouling"],
        "output": "better.toml",
    },
)
PAGES = {
    "data": "#/data",
    "file": "#/data/owner.csv",
    "ship": "#/ship/tanker.toml?turn=monday.mcap",
    "new": "#/ship/new",
    "compare": "#/compare/0002-compare",
    "diagnose": "#/diagnose/0003-diagnose",
    "add": "#/add/0004-add",
    "calibrate": "#/calibrate",
    "live": "#/live",
}
PICTURES = os.environ.get("STUDIO_PICTURES")
SEEN_HEIGHT = {"data": 500, "file": 1100, "compare": 1250, "diagnose": 1300, "add": 1300, "ship": 760}


@pytest.fixture(scope="module")
def page(tab, project, spoiled, serve):
    """A project in which everything was done once."""
    jobs = Jobs(project)
    for asked in ASKED:
        jobs.add(asked)
    until = time.monotonic() + 400
    while any(jobs.state(name) in ("waiting", "running") for name in jobs.names()):
        jobs.turn()
        assert time.monotonic() < until
        time.sleep(0.2)
    assert {jobs.state(name) for name in jobs.names()} == {"done"}
    served = serve(project.folder)
    tab.size(1400, 900)
    tab.leave()
    tab.open(served.links[0])
    tab.wait("window.twinStudio?.drawn > 0", 30)
    yield tab
    served.stop()


def show(page, address, width=1400, theme="light", height=900):
    page.size(width, height)
    page.value(f"document.querySelector('[data-theme-name={theme}]').click()")
    before = page.value("twinStudio.drawn")
    page.value(f"location.hash = '#/'; location.hash = {json.dumps(address)}")
    page.wait(f"twinStudio.drawn > {before}", 30)
    page.wait(STILL, 30)


def keep(page, path):
    """A picture in few colours, as small as a document wants it."""
    from PIL import Image

    page.picture(path)
    with Image.open(path) as image:
        small = image.convert("RGB").quantize(128)
    small.save(path, optimize=True)


@pytest.mark.parametrize("part", PAGES)
def test_each_part_is_read_in_every_light_and_on_every_width(page, part):
    """Expected: no text with a contrast below 4.5, nothing wider than the screen, a name for everything."""
    for width, theme in ((1400, "light"), (360, "light"), (1400, "dark"), (360, "night"), (3840, "light")):
        show(page, PAGES[part], width, theme)
        where = f"{part}, {width} px, {theme}"
        assert not page.value(FAINT), where
        assert not page.value(NAMELESS), where
        assert not page.value(TWICE), where
        assert page.value("document.documentElement.scrollWidth") <= width, where
        if width == 360:
            narrow = "[...document.querySelectorAll('.uplot')].filter((e) => e.checkVisibility() && e.clientWidth < 270).length"
            assert page.value(narrow) == 0, where
        if (
            PICTURES
            and part in SEEN_HEIGHT
            and (width, theme) in ((1400, "light"), (1400, "dark"), (360, "night"))
        ):
            page.size(width, SEEN_HEIGHT[part] if width > 400 else 800)
            time.sleep(0.6)
            keep(page, os.path.join(PICTURES, f"studio-{part}-{theme}-{width}.png"))
    assert not page.said


def test_the_keyboard_leaves_every_place_that_it_enters(page):
    """Test: Tab through the whole of a comparison. Expected: no trap; the worst windows and the zoom are reached."""
    show(page, PAGES["compare"])
    page.value("document.activeElement.blur()")
    seen = []
    for _ in range(140):
        page.press("Tab", 9)
        seen.append(
            page.value(
                "document.activeElement.getAttribute('aria-label') || document.activeElement.textContent.trim()"
            )
        )
    assert (
        any(s.endswith("of monday, show it") for s in seen) and "Show less time" in seen and "Compare" in seen
    )
    assert len(set(seen)) > 60


def test_the_printed_page_has_no_buttons(page):
    show(page, PAGES["compare"])
    page.ask("Emulation.setEmulatedMedia", media="print")
    shown = page.value(
        "[...document.querySelectorAll('nav, form, .tools')].filter((e) => e.checkVisibility()).length"
    )
    page.ask("Emulation.setEmulatedMedia", media="screen")
    assert shown == 0


def test_a_picture_and_its_numbers_are_saved(page):
    """Test: the three buttons of a plot. Expected: a PNG, a whole SVG, and the numbers of its three
    lines."""
    show(page, PAGES["compare"])
    caught = page.value(
        """(async () => { const made = [], real = URL.createObjectURL; URL.createObjectURL = (b) => { made.push(b); return real(b); };
        const keep = document.querySelector('[aria-label="Save Position error, open loop"]');
        for (const b of keep.querySelectorAll('button')) { b.click(); await new Promise((d) => setTimeout(d, 700)); }
        URL.createObjectURL = real;
        const text = async (kind) => made.find((b) => b.type.startsWith(kind)) && await made.findLast((b) => b.type.startsWith(kind)).text();
        return { png: made.find((b) => b.type === 'image/png')?.size, svg: await text('image/svg'), csv: await text('text/csv') }; })()"""
    )
    assert caught["png"] > 3000 and caught["svg"].startswith("<svg") and "rgb" in caught["svg"]
    assert len(caught["csv"].splitlines()) == 1 + 9 and caught["csv"].startswith("line,seconds ahead,m")
