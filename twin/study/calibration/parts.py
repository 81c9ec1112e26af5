"""Parts of the ship that are found with its core, if the reference voyages ask for them: where its antenna
stands, how wind pushes it, and how it answers to little water under its keel.

Nothing is wrong on a reference voyage, so an antenna that clearly stands elsewhere was never where the file
has it (a receiver that reports its centre of gravity, a lever arm left at zero). Wind that was recorded there
pushed it, and a small ship seldom has a calm; the water of a river or a harbour is never deep. Left out,
either would bend the core, and the noise model would grow until it hides what is missing. Kept in mind alone,
each would leave every prediction off."""

from collections.abc import Sequence

from twin.physics.effect import Effect
from twin.physics.effects import of_role
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.ship_notes import known_to_owner
from twin.study.calibration.held_out import HeldOut, errors, size
from twin.study.estimation.columns import Unknown
from twin.study.estimation.fit import Catalogue, Fit, fit
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.reference.steering_gear import GEAR_LOG_BAYES as CLEARLY_BETTER
from twin.study.reference.weather_baseline import strengths
from twin.study.track.track import Track

MOVED_SE = 4.0  # standard errors
BETTER = 0.05  # share by which predictions of what was not used for the fit must be better with it
# of the standard acceleration, by a plausible wind or bottom: what a fainter wind seems to do is the ship's
# own way through the air, and no wind's
PUSHED = 0.08
WEATHER = tuple(map(of_role, ("wind", "shallow_water")))  # that a ship may never be without


def with_its_weather(tracks: Sequence[Track], found: Fit, known: Catalogue, temper: float) -> Fit:
    """The fit with each kind of WEATHER beside the core that was recorded on every voyage and makes them
    clearly more probable: begun where it stands beside the core as that is, for a step of all numbers at once
    may promise too much of the others and be refused."""
    for weather in WEATHER:
        pushed = strengths(tracks, found.model, known).get(weather.__name__, 0.0) > PUSHED
        if not pushed or any(t.missing().intersection(weather.needs) for t in tracks):
            continue
        own = effect_unknowns(weather, Model(found.model.ship))
        alone = fit(tracks, found.model, own, known, NoiseModel(), temper=temper, smooth=True)
        every = (*found.unknowns, *own)
        beside = fit(tracks, alone.model, every, known, NoiseModel(), temper=temper, smooth=True, begun=found)
        found = beside if beside.cost < found.cost - 2.0 * CLEARLY_BETTER else found
    return found


def given(ship: Ship, unknown: Unknown) -> bool:
    """Whether it is a number of the antenna's place that the owner knows. It stays what it is."""
    return unknown.owner == of_role("antenna").__name__ and known_to_owner(ship, unknown.owner, unknown.name)


def significant(found: Fit) -> Effect | None:
    """Where the antenna was found, if that is clearly not where the fit began."""
    antenna = of_role("antenna")
    begun = next((e for e in found.model.effects if isinstance(e, antenna)), antenna.absent(found.model.ship))
    numbers = [
        (u, v, sd)
        for u, v, sd in zip(found.unknowns, found.value, found.sd, strict=True)
        if u.owner == antenna.__name__
    ]
    if not any(abs(v - u.centre) > MOVED_SE * sd for u, v, sd in numbers):
        return None
    return begun.but(**{u.name: float(v) for u, v, _ in numbers})


def placed(ship: Ship, antenna: Effect | None, held_out: HeldOut) -> Ship:
    """The ship with its antenna there, if so it is predicted better."""
    if antenna is None:
        return ship
    moved = ship.with_effects(antenna)
    before, after = (size(errors(Model.of(s), held_out).by_horizon) for s in (ship, moved))
    return moved if after < before - BETTER else ship
