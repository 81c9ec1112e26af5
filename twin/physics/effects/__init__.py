"""The catalogue: every effect the twin knows, in one explicit list, and those that others add.

An installed package adds its own by the entry point group `twin.effects`, name = class.
"""

from functools import lru_cache

from twin.errors import SettingsError, did_you_mean
from twin.physics.effect import Effect
from twin.physics.plugin import GROUP, Refused, loaded
from twin.physics.ship_like import ShipLike

from .actuator_lag import ActuatorLag
from .angle_offset import AngleOffset
from .antenna_offset import AntennaOffset
from .bank import Bank
from .compass_deviation import CompassDeviation
from .cross_flow_drag import CrossFlowDrag
from .current import Current
from .external_force import ExternalForce
from .gyro_bias import GyroBias
from .gyro_scale import GyroScale
from .heading_bias import HeadingBias
from .heading_lag import HeadingLag
from .hull_asymmetry import HullAsymmetry
from .hull_damping import HullDamping
from .hull_fouling import HullFouling
from .loading import Loading
from .of_actuator import OfActuator, of
from .propeller_walk import PropellerWalk
from .propeller_wear import PropellerWear
from .receiver_smoothing import ReceiverSmoothing
from .roll_coupling import RollCoupling
from .rudder_offset import RudderOffset
from .rudder_play import RudderPlay
from .rudder_wear import RudderWear
from .sensor_delay import SensorDelay
from .shallow_water import ShallowWater
from .speed_log_bias import SpeedLogBias
from .speed_log_misalignment import SpeedLogMisalignment
from .speed_log_scale import SpeedLogScale
from .steering_lag import SteeringLag
from .steering_wear import SteeringWear
from .swaying_mass import SwayingMass
from .thruster_wear import ThrusterWear
from .thruster_zero import ThrusterZero
from .tow_force import TowForce
from .varying_current import VaryingCurrent
from .wave_drift import WaveDrift
from .wind import Wind

BUILT_IN: tuple[type[Effect], ...] = (
    Wind,
    WaveDrift,
    CrossFlowDrag,
    HullFouling,
    PropellerWear,
    RudderWear,
    RudderOffset,
    Loading,
    Bank,
    TowForce,
    ExternalForce,
    PropellerWalk,
    RollCoupling,
    Current,
    VaryingCurrent,
    ShallowWater,
    SteeringLag,
    HeadingBias,
    SpeedLogBias,
    SpeedLogScale,
    SpeedLogMisalignment,
    AntennaOffset,
    SensorDelay,
    GyroBias,
    GyroScale,
    HeadingLag,
    CompassDeviation,
    ReceiverSmoothing,
)
# known by their form, so that nothing of the catalogue is named in their place
UNNAMED: tuple[type[Effect], ...] = (RudderPlay, SwayingMass, HullAsymmetry, HullDamping)
# families: each is an effect for every actuator that it suits (`ThrusterWear.port`)
OF_ACTUATORS: tuple[type[OfActuator], ...] = (
    ThrusterWear,
    ThrusterZero,
    AngleOffset,
    SteeringWear,
    ActuatorLag,
)


def of_role(role: str) -> type[Effect]:
    """The effect of the catalogue that has this role (`effect.ROLES`) in every ship's model."""
    return next(e for e in BUILT_IN if e.role == role)


def of_ship(ship: ShipLike) -> dict[str, type[Effect]]:
    """What may be wrong with this ship: the catalogue; of a ship with actuators of its own their effects, and
    not those of one propeller and rudder."""
    if not ship.actuators:
        return catalogue()
    known = {name: effect for name, effect in catalogue().items() if not effect.one_screw}
    own: list[type[Effect]] = [
        of(family, a.name)  # type: ignore[arg-type]
        for a in ship.actuators
        for family in OF_ACTUATORS
        if family.suits(a)
    ]
    own += [of(family, "+".join(names)) for family in OF_ACTUATORS for names in _alike(family, ship)]  # type: ignore[arg-type]
    return known | {e.__name__: e for e in own}


def _alike(family: type[OfActuator], ship: ShipLike) -> list[tuple[str, ...]]:
    """The actuators of one make that may have this effect alike, each of several."""
    makes = dict[tuple[object, ...], list[str]]()
    for a in ship.actuators if family.of_several else ():
        if family.suits(a):
            makes.setdefault(a.make, []).append(a.name)
    return [tuple(names) for names in makes.values() if len(names) > 1]


def unnamed_of(ship: ShipLike) -> tuple[type[Effect], ...]:
    """Of those known by their form alone, what this ship can have."""
    return tuple(e for e in UNNAMED if not (ship.actuators and e.one_screw))


@lru_cache(maxsize=1)
def catalogue() -> dict[str, type[Effect]]:
    """Name -> effect, built-in first, then those that installed packages bring; a broken one is left out, and
    the log `twin` says why."""
    found, broken = _installed()
    if broken:
        import logging  # nothing on board asks what is installed

        for name, why in broken.items():
            logging.getLogger("twin").warning(
                "the installed effect %s is left out: %s. Try: twin effects --check %s", name, why, name
            )
    return {e.__name__: e for e in BUILT_IN} | found


@lru_cache(maxsize=1)
def _installed() -> tuple[dict[str, type[Effect]], dict[str, str]]:
    """Effects of installed packages, and by the name of each that cannot be used why."""
    from importlib.metadata import entry_points  # heavy, and nothing on board asks what is installed

    taken = {e.__name__ for e in (*BUILT_IN, *UNNAMED)}
    good, bad = dict[str, type[Effect]](), dict[str, str]()
    for point in entry_points(group=GROUP):
        try:
            if point.name in taken:
                raise Refused("the twin has an effect of that name")
            good[point.name] = loaded(point)
        except Refused as why:
            bad[point.name] = str(why)
    return good, bad


def find_for(name: str, ship: ShipLike) -> type[Effect]:
    """The same, of this ship. SettingsError: it is of the one propeller and rudder, and the ship has
    actuators."""
    effect = find(name)
    if ship.actuators and effect.one_screw:
        theirs = [n for n in of_ship(ship) if "." in n]
        raise SettingsError(
            f"{name} is of a ship with one propeller and rudder, and this one has actuators. What may be "
            f"wrong with them: {', '.join(theirs[:8])}{' ...' * (len(theirs) > 8)}."
        )
    return effect


def find(name: str) -> type[Effect]:
    """The effect of that name; a built-in one is found without looking at what is installed.
    SettingsError: there is none that can be used."""
    for effect in BUILT_IN:
        if effect.__name__ == name:
            return effect
    family, dot, actuator = name.partition(".")
    for kind in OF_ACTUATORS:
        if family == kind.__name__:
            if not dot or not actuator:
                raise SettingsError(f"{family} is of one actuator: write {family}.NAME, as in {family}.port.")
            if "+" in actuator and not kind.of_several:
                raise SettingsError(
                    f"{family} is of one actuator alone: write {family}.NAME for each of them."
                )
            return of(kind, actuator)  # type: ignore[arg-type]
    if name in (e.__name__ for e in UNNAMED):
        raise SettingsError(
            f"{name} is known by its form alone: what a repair mends is no part of a ship "
            f"file; what is to stay is found by twin calibrate. What it is: twin effects {name}."
        )
    found, broken = _installed()
    if name in found:
        return found[name]
    if name in broken:
        raise SettingsError(
            f"The installed effect {name} cannot be used: {broken[name]}. Try: twin effects --check {name}"
        )
    forms = (e.__name__ for e in UNNAMED)
    known = [*catalogue(), *forms, *(f"{e.__name__}.NAME" for e in OF_ACTUATORS)]
    raise SettingsError(f"Unknown effect {name!r}.{did_you_mean(name, known)}")
