"""The workbench by mouse, for the tests that walk through it: addresses, buttons, jobs, and the command line beside
them."""

import json
import shlex
import subprocess
import sys

SLOW_S = 240.0
OVER = "twinStudio.state.jobs.find((j) => j.name === {name})?.state"


def opened(tab, served):
    """The page, opened with the printed link; the browser has no other network."""
    tab.ask("Network.enable")
    tab.size(1400, 900)
    tab.leave()
    tab.open(served.links[0])
    tab.wait("window.twinStudio?.drawn > 0", 30)
    return tab


def go(page, address):
    """Another address, drawn anew also when it is shown already."""
    before = page.value("twinStudio.drawn")
    address += f"{'&' if '?' in address else '?'}again={before}"
    page.value(f"location.hash = {json.dumps(address)}")
    page.wait(f"twinStudio.drawn > {before}", 30)


def press(page, name):
    """The button of that name in the form."""
    page.wait(
        f"[...document.querySelectorAll('main button')].some((b) => b.textContent === {json.dumps(name)} && !b.disabled)",
        30,
    )
    page.value(
        f"[...document.querySelectorAll('main button')].find((b) => b.textContent === {json.dumps(name)}).click()"
    )


def ended(page, verb):
    """The name of the job that was just begun, when it is over and shown."""
    page.wait(f"location.hash.startsWith('#/{verb}/')", 30)
    name = page.value("location.hash.split('/')[2].split('?')[0]")
    page.wait(f"!['waiting', 'running', undefined].includes({OVER.format(name=json.dumps(name))})", SLOW_S)
    page.wait(
        "[...document.querySelectorAll('main h2')].some((h) => h.textContent === 'The same on the command line')",
        30,
    )
    return name


def answer(project, name):
    return json.loads((project.folder / "jobs" / name / "result.json").read_text())


def typed(project, command, out):
    """What the command line answers to the command that the page shows."""
    words = [sys.executable, "-m", "twin", *shlex.split(command)[1:], "--json", str(out)]
    subprocess.run(words, cwd=project.folder, check=True, capture_output=True, timeout=SLOW_S)
    return json.loads(out.read_text())


def shown(page):
    return page.value("document.querySelector('main').innerText")
