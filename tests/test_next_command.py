"""The `next:` line of a diagnosis: what an owner can type or sail."""

import pytest

from twin.commands.next_command import after_diagnose


def asked(verdict, lasting=(), manoeuvre=None):
    """What a diagnosis holds of that."""
    sail = {"manoeuvre": manoeuvre} if manoeuvre else None
    return {"verdict": verdict, "answer": {"lasting": list(lasting)}, "next_manoeuvre": sail}


@pytest.mark.parametrize("manoeuvre", [None, "zigzag 10/10"])
def test_a_voyage_that_cannot_tell_alone_is_asked_with_others(manoeuvre):
    """Expected: to ask it with another one, beside the manoeuvre, and not where two were asked already."""
    undecided = asked("undecided", manoeuvre=manoeuvre)
    said = after_diagnose(["a.mcap"], "ship.toml", undecided)
    assert "twin diagnose a.mcap OTHER.mcap --ship ship.toml: two voyages tell more than one" in said
    assert ("sail zigzag 10/10" in said) == (manoeuvre is not None)
    assert "OTHER.mcap" not in after_diagnose(["a.mcap", "b.mcap"], "ship.toml", undecided)


def test_what_was_named_is_added_and_nothing_missing_is_compared():
    named = asked("missing", ["HullFouling"])
    assert after_diagnose(["a.mcap"], "s.toml", named).startswith("twin add HullFouling --ship s.toml")
    assert after_diagnose(["a.mcap"], "s.toml", asked("nothing_missing")).startswith("twin compare a.mcap")
