"""The Dockerfile, read line by line: its stages are the README's steps and what it copies is there."""

import fnmatch
from pathlib import Path

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "Dockerfile").read_text().replace("\\\n", " ")
LINES = [line.split(None, 1) for line in TEXT.splitlines() if line.strip() and not line.startswith("#")]
STAGES = [arguments.split()[-1] for word, arguments in LINES if word == "FROM"]
KNOWN = {"FROM", "ENV", "WORKDIR", "COPY", "RUN", "USER", "VOLUME", "HEALTHCHECK", "STOPSIGNAL"}
KNOWN |= {"ENTRYPOINT", "CMD"}


def stage(name):
    start = next(i for i, (word, rest) in enumerate(LINES) if word == "FROM" and rest.endswith(f" AS {name}"))
    end = next((i for i in range(start + 1, len(LINES)) if LINES[i][0] == "FROM"), len(LINES))
    return LINES[start:end]


def test_every_instruction_is_one_docker_knows():
    assert {word for word, _ in LINES} <= KNOWN


def test_every_stage_begins_with_an_image_or_an_earlier_stage():
    for index, (image, _, _) in enumerate(arguments.split() for word, arguments in LINES if word == "FROM"):
        assert ":" in image or image in STAGES[:index]


def test_the_stages_are_those_of_the_documents():
    assert STAGES == ["base", "build", "on-board", "study", "test"]
    for name in STAGES[1:]:
        assert f"`{name}`" in (ROOT / "deploy" / "README.md").read_text()


def test_what_is_copied_is_there_and_not_ignored():
    rules = (ROOT / ".dockerignore").read_text().split()
    for word, arguments in LINES:
        if word != "COPY" or "--from" in arguments:
            continue
        for source in arguments.split()[:-1]:
            assert (ROOT / source).exists(), source
            top = source.split("/")[0]
            assert top == "." or any(fnmatch.fnmatch(f"!{top}", rule) for rule in rules), source


def test_the_test_stage_runs_the_readmes_second_command():
    assert ["RUN", "make test"] in stage("test")


def test_on_board_there_is_no_root_and_no_extra():
    words = dict(stage("on-board"))
    assert words["USER"] == "shiptwin"
    assert not any("[" in rest for word, rest in stage("build") if word == "RUN")
    assert "torch" not in TEXT
