"""The `next:` line of a diagnosis: what an owner can type or sail."""

import pytest

from twin.commands.next_command import after_diagnose


def asked(verdict, lasting=(), manoeuvre=None):
    """What a diagnosis holds of that."""
    sail = {"manoeuvre": manoeuvre} if manoeuvre else None
    return {"verdict": verdict, "answer": {"lasting": list(lasting)}, "next_manoeuvre": sail}


@pytest.mark.parametrize("verdict", ["undecided", "unknown"])
@pytest.mark.parametrize("manoeuvre", [None, "zigzag 10/10"])
def test_a_voyage_that_cannot_tell_alone_is_asked_with_others(verdict, manoeuvre):
    """Expected: to ask it with another one, beside the manoeuvre, and not where three were asked already."""
    still_open = asked(verdict, manoeuvre=manoeuvre)
    said = after_diagnose(["a.mcap"], "ship.toml", still_open)
    assert "twin diagnose a.mcap OTHER-DAY.mcap --ship ship.toml: voyages together tell more" in said
    assert ("sail zigzag 10/10" in said) == (manoeuvre is not None)
    assert "OTHER-DAY" not in after_diagnose(["a.mcap", "b.mcap", "c.mcap"], "ship.toml", still_open)


def test_what_was_named_is_added_and_where_nothing_is_missing_the_next_voyage_is_asked():
    named = asked("missing", ["HullFouling"])
    assert after_diagnose(["a.mcap"], "s.toml", named).startswith("twin add HullFouling --ship s.toml")
    healthy = after_diagnose(["a.mcap"], "s.toml", asked("nothing_missing"))
    assert healthy.startswith("twin diagnose OTHER-DAY.mcap --ship s.toml") and "twin calibrate" in healthy
