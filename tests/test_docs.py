"""The documentation: generated pages are current, what is linked is there, every room is described."""

import importlib.util
import re
from pathlib import Path

import pytest

from twin.api.json_key import JsonKey, absent_keys, unknown_paths
from twin.api.json_keys import KEYS

ROOT = Path(__file__).parents[1]
PAGES = sorted(p for p in (ROOT / "docs").rglob("*.md") if "history" not in p.parts)


def loaded(path):
    """A file as a module, without a package."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


api_page = loaded(ROOT / "docs" / "api_page.py")


@pytest.mark.parametrize("name", api_page.PAGES)
def test_a_generated_page_is_current(name):
    """Expected: equal to what `python docs/api_page.py` writes."""
    assert (ROOT / "docs" / name).read_text() == api_page.PAGES[name]()


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT / "docs")))
def test_what_a_page_links_to_is_there(page):
    links = re.findall(r"\]\((?!https?:)([^)#\s]+)", page.read_text())
    assert not [link for link in links if not (page.parent / link).exists()]


@pytest.mark.parametrize(
    "page", [p for p in PAGES if "results" not in p.parts], ids=lambda p: str(p.relative_to(ROOT / "docs"))
)
def test_a_source_file_that_a_page_names_is_there(page):
    """Expected: every path of the repository; results stand as they were when they were measured."""
    named = re.findall(r"(?<![\w/.])(?:twin|bench|export|deploy|tests)/[\w/]+\.py\b", page.read_text())
    assert not [name for name in named if not (ROOT / name).exists()]


def test_the_index_leads_to_every_page():
    docs = ROOT / "docs"
    here = {page.relative_to(docs).as_posix(): page for page in PAGES if page.name != "index.md"}
    index, decisions = (docs / "index.md").read_text(), (docs / "decisions" / "README.md").read_text()
    numbered = [name for name in here if name.startswith("decisions/0")]
    assert not [n for n in here if n not in numbered and f"({n}" not in index]
    assert not [n for n in numbered if f"({here[n].name})" not in decisions]


def test_the_architecture_describes_every_room():
    rooms = loaded(ROOT / "tests" / "test_house.py").ORDER
    page = (ROOT / "docs" / "architecture.md").read_text()
    assert not [room for room in rooms if room != "twin.study" and f"**{room}**" not in page]


def test_what_the_architecture_names_stands_in_the_file_that_it_names():
    """Expected: of each `name` (`file.py`), and of each type that travels, the file gives the name."""
    page = (ROOT / "docs" / "architecture.md").read_text()
    pairs = re.findall(r"`(\w+)`(?:, `\w+`)* \(`([\w/]+\.py)`", page)
    pairs += re.findall(r"^\| `(\w+)`[^|]*\| `([\w/]+\.py)`", page, re.M)
    files = [p for room in ("twin", "docs") for p in (ROOT / room).rglob("*.py")]
    assert len(pairs) > 25
    for name, file in pairs:
        places = [p.read_text() for p in files if str(p).endswith(f"/{file}")]
        given = rf"^\s*((async )?def|class) {name}\b|^{name}\b.*="
        assert any(re.search(given, text, re.M) for text in places), (name, file)


def test_the_diary_is_linked_from_the_index_alone():
    linking = [p.name for p in PAGES if "](history/design.md)" in p.read_text()]
    assert linking == ["index.md"]


def test_a_key_stands_once_in_its_table():
    for keys in KEYS.values():
        names = [k.path for k in keys]
        assert len(names) == len(set(names))


def test_a_result_is_held_against_the_table_key_by_key():
    keys = (JsonKey("a.*.m", "m", ""), JsonKey("b[].c", "", ""), JsonKey("d.*", "", "", "sometimes"))
    good = {"a": {"x": {"m": 1}}, "b": [{"c": 2}], "d": {"e": {"f": [3]}}}
    assert unknown_paths(keys, good) == [] and absent_keys(keys, good) == []
    assert unknown_paths(keys, good | {"new": 1}) == ["new"]
    assert absent_keys(keys, {"b": [{"c": 2}]}) == ["a.*.m"]


@pytest.mark.parametrize(
    "page", sorted((ROOT / "docs" / "decisions").glob("0*.md")), ids=lambda p: p.name[:4]
)
def test_a_decision_stands_on_one_short_page(page):
    """Expected: at most 25 lines, none longer than a line of code may be by much."""
    lines = page.read_text().splitlines()
    assert len(lines) <= 25 and max(map(len, lines)) <= 120
