"""What counts as a manoeuvre: a turn or a change of the engine's speed; holding a course in a seaway does
not."""

import numpy as np
import pytest

from twin.physics.ship import load
from twin.study.track.excitation import manoeuvred
from twin.study.track.track import READINGS, Track


@pytest.fixture(scope="module", params=["kvlcc2", "usv"])
def ship(request):
    return load(request.param)


def sailed(ship, turn_deg=0.0, wiggle_deg=0.0, shaft=0.0, lengths=100.0, period=4.0 * np.pi):
    """`turn_deg` in the middle, over two lengths; `wiggle_deg`: an autopilot's weaving, of a period in
    lengths; `shaft`: a step, as a share."""
    h = float(ship.scale("time")) / 4.0
    n = int(4 * lengths)
    s = np.arange(n) / 4.0
    state = np.zeros((n, 6))
    state[:, 2] = np.radians(turn_deg) * np.clip((s - 50.0) / 2.0, 0.0, 1.0) + np.radians(
        wiggle_deg
    ) * np.sin(2.0 * np.pi * s / period)
    revolutions = np.where(s > 50.0, 1.0 + shaft, 1.0)
    return Track(
        "t",
        h * np.arange(n),
        h,
        state,
        np.zeros(n),
        revolutions,
        {},
        np.zeros((n, len(READINGS))),
        np.ones(8),
        np.ones(n, bool),
    )


@pytest.mark.parametrize(
    "what, answer",
    [({"turn_deg": 20.0}, True), ({"shaft": -0.2}, True), ({"wiggle_deg": 2.0}, False), ({}, False)],
)
@pytest.mark.parametrize("lengths", [60.0, 2000.0])
def test_one_turn_or_one_change_of_speed_is_a_manoeuvre_however_long_the_voyage_and_weaving_is_none(
    ship, what, answer, lengths
):
    assert manoeuvred(sailed(ship, lengths=lengths, **what), ship) is answer


def test_a_turn_that_is_undone_within_five_lengths_is_a_manoeuvre_too(ship):
    assert manoeuvred(sailed(ship, wiggle_deg=14.0, period=5.0), ship)


def test_a_turn_while_the_controls_were_not_recorded_does_not_count(ship):
    track = sailed(ship, turn_deg=40.0)
    track.whole[180:240] = False
    assert not manoeuvred(track, ship)
