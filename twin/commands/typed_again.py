"""What was typed, as it is typed again: the command in a result, and options that a `next:` line repeats."""

import argparse
from typing import Any

from twin.api.result import Result
from twin.commands.verb_output import typed


def command_of(args: argparse.Namespace) -> str:
    """The command that gives a result again: what was typed, less where the answer goes."""
    answers = argparse.ArgumentParser(add_help=False)
    answers.add_argument("--json")
    answers.add_argument("--report", "--html")
    return typed(*answers.parse_known_args(args.typed)[1])


def with_request(found: Result, args: argparse.Namespace, **files: Any) -> Result:
    """The result with what was typed and of which files it is."""
    return found.with_keys(command=command_of(args), files=files)


def given(option: str, *values: str | None) -> list[str]:
    """An option as it was typed; nothing where it was not."""
    return [option, *map(str, values)] if any(values) else []
