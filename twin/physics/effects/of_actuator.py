"""Effects of one named actuator, or of several of one make alike: `ThrusterWear.port` is ThrusterWear of the
actuator that is called port, `ThrusterWear.port+starboard` the same share of both.

A family is declared once, like every effect; `of(family, name)` is the effect for one actuator, and the same
name gives the same class each time."""

from functools import cache
from typing import Any, ClassVar, TypeVar

from twin.errors import SettingsError, did_you_mean
from twin.physics.actuators import Actuator
from twin.physics.effect import Effect, Force
from twin.physics.maths import total
from twin.physics.ship_like import ShipLike
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation

E = TypeVar("E", bound="OfActuator")


class OfActuator(Effect):
    """What is common to effects of one actuator."""

    actuator: ClassVar[str] = ""
    names: ClassVar[tuple[str, ...]] = ()  # the same, of several one by one
    # the sentence of several that have it alike; "": there is no cause that several have
    of_several: ClassVar[str] = ""
    recorded: ClassVar[tuple[str, ...]] = ()  # one of these must be recorded of it
    of_angle: ClassVar[bool] = False  # whether it is of what the actuator's angle turns

    @classmethod
    def sentence(cls, ship: ShipLike | None = None) -> str:
        """The family's sentence with the actuator's name, and of a ship also with what it is: the port
        propeller, the bow thruster."""
        if len(cls.names) > 1:
            called = {a.name: a.called(cls.of_angle) for a in (ship.actuators if ship else ())}
            every = [f"the {called.get(name, f'actuator {name}')}" for name in cls.names]
            text = f"{', '.join(every[:-1])} and {every[-1]}"
            said = cls.of_several.replace("These actuators", f"T{text[1:]}")
            return said.replace("these actuators", text)
        owner = next((a for a in ship.actuators if a.name == cls.actuator), None) if ship else None
        name = (
            f"the {owner.called(cls.of_angle)}"
            if owner
            else f"actuator {cls.actuator}"
            if cls.actuator
            else "this actuator"
        )
        text = super().sentence(ship).replace("this actuator", name)
        return text.replace("This actuator", name[0].upper() + name[1:])

    @classmethod
    def suits(cls, a: Actuator) -> bool:
        """Whether an actuator can have it."""
        return not cls.recorded or bool(set(cls.recorded) & set(a.attributes))

    def check(self, ship: ShipLike, where: str = "") -> None:
        """Refuse an actuator that the ship has not, or that cannot have the effect. SettingsError: it says
        which."""
        name, known = type(self).__name__, [a.name for a in ship.actuators]
        for one in self.names:
            if one not in known:
                has = did_you_mean(one, known) if known else " The ship file has no [[actuators]]."
                raise SettingsError(f"{where}effects.{name}: no actuator is called {one!r}.{has}")
            if not self.suits(ship.actuator(one)):
                raise SettingsError(
                    f"{where}effects.{name}: of {one} no {' and no '.join(self.recorded)} is recorded. "
                    f'Remove [effects."{name}"].'
                )
        super().check(ship, where)

    def __reduce__(self) -> Any:
        return remade, (type(self).__mro__[1], self.actuator, self.values())


class ActuatorForce(OfActuator, Force):
    """The force that an actuator gives otherwise, less the one that the ship file has of it."""

    def altered(self, a: Actuator) -> Actuator:
        """The actuator as it is with the effect."""
        return a

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        forces = []
        for a in map(ship.actuator, self.names):
            was = a.force(s.orders, s.u_r, s.v_r, s.r, ship)  # type: ignore[arg-type]
            now = self._altered(a).force(s.orders, s.u_r, s.v_r, s.r, ship)  # type: ignore[arg-type]
            forces.append(ForceVector(now[0] - was[0], now[1] - was[1], now[2] - was[2]))
        return forces[0] if len(forces) == 1 else ForceVector(*map(total, zip(*forces, strict=True)))

    def _altered(self, a: Actuator) -> Actuator:
        """The same, made once: the loop asks a hundred times a second."""
        made: dict[str, tuple[Actuator, Actuator]] = self.__dict__.setdefault("_made", {})
        if a.name not in made or made[a.name][0] is not a:
            made[a.name] = a, self.altered(a)
        return made[a.name][1]


@cache
def of(family: type[E], actuator: str) -> type[E]:
    """The effect of that family for one actuator, or for several of one make (`port+starboard`); the same
    class each time."""
    names = tuple(actuator.split("+"))
    parts = tuple(f"{family.__name__}.{name}" for name in names if len(names) > 1)
    own = {"actuator": actuator, "names": names, "holds": (*family.holds, *parts)}
    return type(
        f"{family.__name__}.{actuator}",
        (family,),
        own | {"__doc__": family.__doc__, "__module__": family.__module__},
    )


def remade(family: type[OfActuator], actuator: str, values: dict[str, Any]) -> Effect:
    """The effect again, where it was sent from one process to another."""
    return of(family, actuator)(**values)  # type: ignore[arg-type]
