"""The shocks of the service, once each and short: what is counted is what happened."""

from bench.endurance.killed_service import Said, ServiceFolder, said_of
from bench.endurance.lies import OTHERS, LieNoticed
from bench.endurance.run import of_kills, of_lies, of_shocks
from bench.endurance.shocks import Killed, Shocked, kills, whole
from bench.lie_kinds import LIES


def test_a_service_that_is_killed_loses_at_most_half_a_second_and_all_its_logs_are_whole(tmp_path):
    """Test: two kills under way, everything on. Expected: as the page counts two hundred."""
    place = ServiceFolder(tmp_path, "kvlcc2")
    try:
        made, good, files = kills(place, 2)
    finally:
        place.close()
    assert [k.lost_s <= 0.5 for k in made] == [True, True]
    assert good == files >= 3
    log = next(place.logs.glob("*.mcap"))
    log.write_bytes(log.read_bytes()[:-100] + bytes(100))
    assert not whole(log)


def test_a_line_of_the_pipe_is_read():
    said = said_of("7 12.5 1 3 dead reckoning|lagging: 3 periods; x")
    assert said == Said(7, 12.5, True, 3, "dead reckoning", "lagging: 3 periods; x")


def test_twenty_four_lies_have_names_of_their_own_and_each_tells_something_else():
    names = [lie.name for lie in (*LIES, *OTHERS)]
    assert len(set(names)) == len(names) == 24
    for lie in OTHERS:
        row = dict.fromkeys(("north_m", "east_m", "heading_true_north_deg", "surge_velocity_mps", "sway_velocity_mps", "yaw_rate_degps", "rudder_angle_deg", "propeller_rate_rpm"), 3.0)  # fmt: skip
        memory = {"north_m": 1.0, "east_m": 1.0} if lie.name == "positions frozen" else {}
        before = dict(row)
        lie.tell(row, 10.0, memory)
        assert row != before, lie.name


def test_the_pages_say_what_was_counted():
    page = of_kills("kills", [Killed(1.0, 0.1, 2.0), Killed(1.0, 0.3, 2.5)], 3, 3)
    assert "2 of 2" in page and "0.300 at most" in page and "3 of 3" in page
    page = of_shocks("pauses", [Shocked("pause of 4 s", 0.1, None, True, 7)], 0)
    assert "| pause of 4 s | 0.1 | - | yes | 7 |" in page
    page = of_lies("kvlcc2", "TS-01", [LieNoticed("none", None, "", 1.0, 0.0, 0.03)])
    assert "| none | - |  | 100 % | 0.0 % | 0.03 |" in page
