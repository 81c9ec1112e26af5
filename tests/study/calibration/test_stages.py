"""How far a calibration is, in the words of its stages."""

import pytest

from twin.study.calibration.stages import AGAIN, BASELINE, CORE_STAGES, FIT_STAGES, ONCE_MORE, PATH, Stages


class Clock:
    def __init__(self) -> None:
        self.s = 0.0

    def __call__(self) -> float:
        return self.s


def run(
    stages: list[str], every: float | None, second_per: float = 1.0, took: dict[str, float] | None = None
) -> list[str]:
    """What is told when each stage takes `second_per` times its usual seconds, or what it `took`."""
    said: list[str] = []
    clock = Clock()
    told = Stages(said.append, every, clock)
    for text in stages:
        told(text)
        clock.s += (took or {}).get(text, second_per * FIT_STAGES.get(text, 0.0))
    return said


def test_the_stages_of_one_fit_are_counted():
    said = run([*FIT_STAGES, PATH, BASELINE], None)
    assert [s.split(" (")[1].split(" of ")[0] for s in said] == [str(i + 1) for i in range(9)]
    assert all("of 9" in s for s in said)


def test_what_is_left_is_what_the_other_stages_take_on_this_machine():
    """Twice as slow as usual: after the first fit's 23.9 s of work, 47.8 s; left are 1.0 and 8.5 s of work, 19 s."""
    said = run([*FIT_STAGES, PATH], None, 2.0)
    assert said[-1] == "fitting along the path (8 of 9, about 19 s left)"
    assert "left" not in said[0]


CORE, SEA, NOISE = "fitting the core", "testing again whether waves", "estimating the noise model"
# a later fit begins where the first one ended: its gear is not looked for (0.4 of the core's time), its noise
# model from where that was (0.3); and its sea is asked about before its core is fitted
SECOND_FIT_S = sum(FIT_STAGES.values()) - 0.6 * FIT_STAGES[CORE] - 0.7 * FIT_STAGES[NOISE]
AGAIN_CORE = [SEA, *(s for s in CORE_STAGES if s != SEA)]
LATER = ["asking how the instruments", *AGAIN_CORE]


def test_a_second_fit_with_more_voyages_takes_longer_in_proportion():
    said = run([*FIT_STAGES, PATH], 1.5, 10.0)
    left = 10.0 * (1.0 + 1.5 * (SECOND_FIT_S + 8.5)) / 60.0
    assert said[-1].endswith(f"(8 of 17, about {left:.0f} min left)")
    assert run([*FIT_STAGES, PATH, ONCE_MORE, *LATER, BASELINE], 1.5)[-1].startswith(f"{BASELINE} (17 of 17")


def test_a_stage_of_the_second_fit_is_awaited_as_long_as_it_took_in_the_first():
    """Test: a small vessel in waves, whose noise model takes ten times as long as usual beside the rest.
    Expected: by hand, at the path after 23.9 + 94.5 s, the same again but 0.7 * 105 s and 0.6 of the core's, and
    (1.0 + 8.5) * 118.4/23.9 s."""
    took = {NOISE: 105.0}
    said = run([*FIT_STAGES, PATH], 1.0, took=took)
    first = sum(FIT_STAGES.values()) - FIT_STAGES[NOISE] + 105.0
    second = first - 0.7 * 105.0 - 0.6 * FIT_STAGES[CORE]
    left = second + 9.5 * first / sum(FIT_STAGES.values())
    assert said[-1] == f"{PATH} (8 of 17, about {left:.0f} s left)"


@pytest.mark.parametrize("part", ["the antenna where it was found", "a compass that deviates"])
def test_the_second_fit_begins_with_the_part_that_the_first_one_found(part):
    """Test: an antenna or a compass found in the first fit; the second has half as many voyages more. Expected: by
    hand, 8 + 7 stages and the second's 7 + 2. One that only the second finds is planned then."""
    first = [*FIT_STAGES, f"{AGAIN} {part}", *AGAIN_CORE]
    assert run([*first, PATH], 1.5)[-1].startswith(f"{PATH} (15 of 24, about")
    assert run([*first, PATH, ONCE_MORE, *LATER, BASELINE], 1.5)[-1].startswith(f"{BASELINE} (24 of 24")
    second = [*LATER, f"{AGAIN} {part}", *AGAIN_CORE]
    only_then = run([*FIT_STAGES, PATH, ONCE_MORE, *second, BASELINE], 1.5)
    assert only_then[-1].startswith(f"{BASELINE} (24 of 24")


def test_two_parts_found_one_after_the_other_are_both_counted():
    compass, antenna = f"{AGAIN} a compass that deviates", f"{AGAIN} the antenna where it was found"
    first = [*[*FIT_STAGES][:5], compass, *AGAIN_CORE, antenna, *AGAIN_CORE]
    said = run([*first, PATH, ONCE_MORE, *LATER, BASELINE], 2.0)
    assert [s.split(" (")[1].split(" of ")[0] for s in said] == [str(i + 1) for i in range(len(said))]
    assert said[-1].startswith(f"{BASELINE} ({len(said)} of {len(said)}")


def test_a_core_that_is_begun_again_half_way_is_counted_without_its_other_half():
    """Expected: the noise model, which was not looked for yet, takes all of its time."""
    again, half = "fitting again, with a compass that deviates with the heading", [*FIT_STAGES][:5]
    said = run([*half, again, *AGAIN_CORE, PATH, BASELINE], None)
    assert said[5].startswith(f"{again} (6 of 14")
    assert said[-1].startswith(f"{BASELINE} (14 of 14")


def test_a_stage_that_is_left_out_is_not_waited_for():
    said = run([*FIT_STAGES, BASELINE], None)
    assert said[-1].startswith(f"{BASELINE} (9 of 9")


def test_other_words_are_told_as_they_are():
    assert run(["HeadingLag: found"], None) == ["HeadingLag: found"]


@pytest.mark.parametrize("text", [*FIT_STAGES, PATH, BASELINE])
def test_every_stage_is_told_by_a_calibration(text):
    """The words stand where the work is done; another word there would not be counted."""
    from pathlib import Path

    source = Path(__file__).parents[3] / "twin" / "study" / "calibration"
    assert any(f'"{text}' in p.read_text() for p in source.glob("*.py") if p.name != "stages.py")
