"""The machine stands still for a while, or the voyage has a hole: the loop that the service builds goes on,
and remembers nothing that is no longer so."""

from math import hypot, isfinite

import pytest

from twin.live.keelson import messages
from twin.live.log.mcap_read import McapReader
from twin.live.log.record import LogFile
from twin.live.log_replay import replay
from twin.live.observer.dynamics import Gear
from twin.live.signals.config import Settings
from twin.physics.effect import Lag
from twin.physics.effects import find


def pause(bridge, seconds):
    """The machine stands still; the ship and its instruments go on."""
    for _ in range(round(seconds / 0.1)):
        bridge.sailing.advance()
    bridge.now_s += seconds


@pytest.mark.parametrize("seconds", (1.0, 2.9, 3.1, 4.0, 60.0))
def test_C10_a_pause_of_any_length_ends_nothing_and_the_promise_that_follows_is_kept(make_service, seconds):
    """Test: suspend for a second to a minute, under way in a zigzag. Expected: the next tick comes, the bound
    holds, and the promise is back within a minute."""
    bridge = make_service()
    assert bridge.run(60.0)[-1].certificate.inside
    pause(bridge, seconds)
    for _ in range(60):
        tick = bridge.run(1.0)[-1]
        off = hypot(bridge.error("surge_velocity_mps"), bridge.error("sway_velocity_mps"))
        assert tick.mode == "hybrid" and off < tick.certificate.bound
    assert tick.certificate.inside


def test_a_pause_while_the_speed_is_not_heard_ends_nothing(make_service):
    """Test: suspend for 4 s; afterwards only heading, position and controls are heard. Expected: ticks with
    no promise, then one again."""
    bridge = make_service()
    bridge.run(30.0)
    pause(bridge, 4.0)
    deaf = bridge.run(
        10.0,
        lambda readings, b: [r for r in readings if "velocity" not in r.channel and "yaw" not in r.channel],
    )
    assert not any(t.certificate.inside for t in deaf)
    assert bridge.run(120.0)[-1].certificate.inside


def test_nothing_that_was_foretold_before_a_pause_is_said_after_it(make_service):
    """Test: suspend for a minute in the middle of a prediction. Expected: every prediction is of what lies
    ahead, by a fresh estimate."""
    bridge = make_service()
    bridge.run(31.3)
    pause(bridge, 60.0)
    said = [p for t in bridge.run(10.0) for p in t.predictions]
    assert said and all(p.horizon_s > 9.0 and p.age_s < 5.0 for p in said)


def test_a_steering_gear_forgets_the_orders_from_before_a_pause():
    """Test: an order of 0.3 rad, a minute's pause, an order of -0.2. Expected: the rudder is taken to be
    where it is now ordered."""

    class Slow(Lag):
        def dead_time(self):
            return 1.0

        def step(self, actual, order, dt):
            return actual + max(min(order - actual, 0.05 * dt), -0.05 * dt)

    gear = Gear(Slow())
    for k in range(100):
        gear.turn(0.3, 0.1 * k)
    assert gear.turn(-0.2, 70.0) == -0.2 and gear.turn(-0.2, 70.1) == -0.2


def test_a_voyage_with_a_hole_of_a_minute_is_replayed_to_its_end(bridge, tmp_path, on_file):
    """Test: an imported voyage of 2 min in whose middle nothing is recorded for 61 s. Expected: a summary,
    all numbers finite."""
    path, out = tmp_path / "hole.mcap", tmp_path / "out.mcap"
    with LogFile(path) as log:
        for k in range(1810):
            t = 100.0 + 0.1 * k
            if not 600 <= k < 1210:
                row = messages.Row(time_s=t)
                messages.fill(row, bridge.sailing.true() | {"wave_height_significant_m": 0.0})
                log.add("voyage/row", "shiptwin.Row", row.SerializeToString(), round(t * 1e9))
            bridge.sailing.advance()
    settings = Settings({"observer.certificate": str(on_file / "kvlcc2.json")})
    summary = replay(path, settings, out)
    ticks = [
        messages.Tick.FromString(m.data) for m in McapReader(out).messages() if m.type_name == "shiptwin.Tick"
    ]
    assert summary.ticks == len(ticks) > 1000 and ticks[-1].certificate.inside
    assert all(isfinite(t.certificate.bound) and all(p.horizon_s > 0.0 for p in t.predictions) for t in ticks)


def test_a_pause_makes_no_instrument_a_liar(make_service):
    """Test: a ship with a fouled hull and a coarse log, a pause of 4 s every 12 s under way, as when a machine
    is short of time; found by the endurance of the service. Expected: the estimate that begins anew at one
    noisy sample is pulled to its place, and nobody takes that for a force of shaft or rudder."""
    bridge = make_service(seed=21, noise=4.0)
    bridge.sailing.model = bridge.sailing.model.but(find("HullFouling").plausible(bridge.loop.ship))
    bridge.run(30.0)
    for _ in range(12):
        pause(bridge, 4.0)
        said = {reason for tick in bridge.run(12.0) for reason in tick.reasons if "against" in reason}
        assert not said
