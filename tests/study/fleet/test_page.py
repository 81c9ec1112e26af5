"""The page of a fleet in a real browser: whole, readable, and no word of a file is taken for markup."""

import pytest

from tests.chromium import FAINT
from tests.study.fleet.rows import named, of, plainly
from twin.api.fleet import Fleet
from twin.recording.jsonable import plain
from twin.study.fleet.ranking import ranked

DAYS = [f"2026-0{m}-01T08:00:00+00:00" for m in range(1, 7)]


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    grown = [named(f"v{i}", d, 0.1 + 0.05 * i, score=5.0 + i) for i, d in enumerate(DAYS)]
    fleet = [
        of("Alma & <b>Co</b>", *grown, scores=[0.1] * 3),
        of("Berta", plainly("a", DAYS[0]), [{"failed": "berta.csv: is empty (0 bytes).", "effect": None}]),
        of("Gone", [{"failed": "gone.csv: there is no such file.", "effect": None}]),
    ]
    path = tmp_path_factory.mktemp("page") / "fleet.html"
    Fleet(data=plain(ranked(fleet) | {"asked_now": 0})).write_page(path)
    return path


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 420])
def test_the_page_is_drawn_without_a_word_of_complaint(tab, page, theme, width):
    """Expected: every ship, its history, commands; contrast of text 4.5 at least; nothing wider than the
    screen."""
    tab.leave()
    tab.size(width, 900)
    tab.open("about:blank")
    tab.open(f"{page.as_uri()}#theme={theme}")
    tab.wait("document.documentElement?.dataset.readyMs")
    text = tab.value("document.body.innerText")
    assert "Alma & <b>Co</b>" in text and "there is no such file" in text and "not judged" in text
    assert "+0.051 a month" in text and "by 3 reference voyages" in text
    assert tab.value("document.querySelectorAll('svg circle').length") == len(DAYS)
    commands = tab.value("[...document.querySelectorAll('.command code')].map((c) => c.textContent)")
    assert commands[0].startswith("twin diagnose 'Alma & <b>Co</b>-5.mcap' --ship")
    assert tab.value(FAINT) == [] and tab.said == []
    assert tab.value("document.documentElement.scrollWidth") <= width


def test_the_page_asks_nothing_of_any_network(page):
    text = page.read_text()
    assert "http" not in text.replace("http-equiv", "") and "default-src 'none'" in text
