"""Parts of the ship that are found with its core: an antenna's place that the owner gave stays."""

from dataclasses import replace

from bench.real.planted_faults import antenna_elsewhere
from tests.study.calibration.test_core_fit import by_steps
from tests.study.conftest import seldom
from tests.thorough import thorough
from twin.physics.effects import find, of_ship
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.calibration.parts import given
from twin.study.reference.nuisance import instruments


def with_antenna(ahead_m, **told):
    """The tanker, whose owner says where its antenna stands; `told`: of the number, beside its value."""
    ship = load("kvlcc2").with_effects(find("AntennaOffset")(ahead=ahead_m, starboard=0.0, above=0.0))
    number = {"value": ahead_m, "unit": "m", "source": "general arrangement"} | told
    return replace(ship, notes={**ship.notes, "effects": {"AntennaOffset": {"ahead": number}}})


def test_a_place_of_the_antenna_is_known_where_the_ship_file_has_it_without_a_standard_error():
    def known(ship):
        model = Model.of(ship)
        return {u.name for u in instruments(model, of_ship(ship)) if given(ship, u)}

    assert known(load("kvlcc2")) == set()
    assert known(with_antenna(64.0)) == {"ahead"}
    assert known(with_antenna(64.0, sd=1.0)) == set()


@thorough
def test_a_place_of_the_antenna_that_the_owner_gave_is_kept_and_another_one_is_not_found(voyages, tmp_path):
    """Test: the owner says that the receiver tells of midship, and it does not, by 64 m. Expected: the file
    keeps his number and where it comes from."""
    elsewhere = [antenna_elsewhere(seldom(voyages[n].between(0.0, 500.0)), 64.0) for n in ("calm", "nothing")]
    ship, result = by_steps(elsewhere, with_antenna(0.0), tmp_path)
    (antenna,) = [e for e in ship.effects if type(e).__name__ == "AntennaOffset"]
    assert antenna.ahead == 0.0 and "ahead" not in result["antenna"]
    number = ship.notes["effects"]["AntennaOffset"]["ahead"]
    assert number["source"] == "general arrangement" and "sd" not in number
