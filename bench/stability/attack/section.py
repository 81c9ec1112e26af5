"""The attack's part of the page that the random runs write: each rewrites its own and leaves the other's."""

from pathlib import Path

HEAD = "## The attack"


def section_of(page: Path | None) -> str:
    """What the attack wrote on the page that is there."""
    old = page.read_text() if page and page.exists() else ""
    return f"\n{HEAD}{old.partition(HEAD)[2]}" if HEAD in old else ""


def with_section(page: Path, section: str) -> str:
    """The page with this part in the place of the old one."""
    before = page.read_text().partition(HEAD)[0].rstrip("\n") if page.exists() else ""
    return f"{before}\n\n{section}" if before else section
