"""Numbers that a benchmark may be given."""

import argparse


def positive(text: str) -> int:
    """A whole number, one or more; anything else is a wrong use of the option."""
    if not text.isdecimal() or not (number := int(text)):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number of one or more")
    return number
