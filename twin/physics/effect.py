"""What an effect is: one physical cause, declared once, read by the loop, the study, the training and the
documentation.

Four kinds. A Force pushes the ship. A Flow changes the water that the hull, propeller and rudder feel. A Lag
gives an actuator a state of its own. A SensorFault leaves the ship alone and changes what an instrument says
of it."""

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple, Protocol, Self, TypeVar

from twin.errors import SettingsError
from twin.num import as_given

from .ship_like import ShipLike
from .state import Force as ForceVector
from .state import Number, Rates, Situation, Water

# by how much of its size a number may be off because nature writes the effect otherwise, unless more is known
FORM = 0.1
SCALES = ("force", "moment", "speed", "time", "length")
OWNERS = ("ship", "instrument", "voyage")
S = TypeVar("S", bound=ShipLike)
ROLES = {  # what every ship may have one of, and by what the study asks for it
    "stream": "water that moves alike everywhere and at all times",
    "gear": "what stands between the rudder's order and the rudder",
    "antenna": "where position and speed over ground are measured",
    "wind": "how the wind that was recorded pushes the ship",
    "shallow_water": "how the ship answers to the depth that was recorded",
    "compass": "how far the compass is off, by the heading",
}


class Sailing(Protocol):
    """What an effect asks of a model to say how strong it is: the ship, the model with the effect, and the
    accelerations that it gives."""

    @property
    def ship(self) -> ShipLike:
        """The ship itself."""

    def but(self, *effects: "Effect") -> "Sailing":
        """The same with these effects too."""

    def nu_dot(self, s: Situation) -> Rates:
        """Its accelerations (u, v, r) in this situation [m/s2, m/s2, rad/s2]."""


class Param(NamedTuple):
    """One number of an effect: what it is, where it may lie, and what it is before any data (a prior).

    `lo, hi` is the box of fits and of the adaptation; `sd` the width of the prior around `null`, the value at
    which the effect is not there (half-normal where the box has one side). With `of`, the four are multiples
    of one of the ship's own scales (see Ship.scale), so that one declaration serves a 2 m boat and a 320 m
    tanker. `form` is by how much of its size it may be off (one standard deviation) because nature writes the
    effect otherwise than the catalogue does. `input` is a field of Situation without which this number alone
    does nothing."""

    name: str
    default: float
    unit: str
    lo: float
    hi: float
    sd: float
    null: float
    of: str | None
    form: float
    input: str | None
    doc: str

    def scale(self, ship: ShipLike) -> float:
        """The ship's own size of which the numbers are multiples; 1 when of none."""
        return ship.scale(self.of) if self.of else 1.0

    def box(self, ship: ShipLike) -> tuple[float, float]:
        """(lowest, highest) value for this ship, in the parameter's unit."""
        k = self.scale(ship)
        return self.lo * k, self.hi * k


def param(
    default: float,
    *,
    unit: str,
    lo: float,
    hi: float,
    doc: str,
    sd: float | None = None,
    null: float = 0.0,
    of: str | None = None,
    form: float = FORM,
    input: str | None = None,
) -> Any:
    """Declare a parameter: its plausible value when the effect is there, unit, box, prior width, doubt about
    its form and meaning."""
    if of is not None and of not in SCALES:
        raise ValueError(f"of={of!r}: one of {SCALES}")
    sd = abs(default - null) if sd is None else sd
    meta = {"default": default, "unit": unit, "lo": lo, "hi": hi, "sd": sd, "null": null, "of": of}
    meta |= {"form": form, "input": input, "doc": doc}
    # none of it is none on any ship
    return field(default=MISSING if of and default else default, metadata=meta, kw_only=True)


class Effect:
    """Base of the four kinds; a subclass is final and frozen, and its docstring is the plain sentence of the
    report."""

    kind: ClassVar[str]
    # one of OWNERS: what keeps it, also tomorrow; weather and water of a day belong to the voyage
    belongs_to: ClassVar[str] = "ship"
    needs: ClassVar[tuple[str, ...]] = ()  # fields of Situation without which the effect is switched off
    needs_ship: ClassVar[tuple[str, ...]] = ()  # particulars without which it cannot be sized
    every_day: ClassVar[tuple[str, ...]] = ()  # numbers of which each day brings a little
    # standard deviation of its numbers between voyages, in widths of what a healthy ship has (decision 0030)
    varies: ClassVar[float] = 0.0
    ages: ClassVar[tuple[str, ...]] = ()  # numbers that the age of a reading makes, too (decision 0035)
    copies: ClassVar[tuple[str, ...]] = ()  # numbers that do, to first order about none, what another does
    # effects that are a part of this one, so that beside it they say nothing
    holds: ClassVar[tuple[str, ...]] = ()
    # whether the readings show it and the ship's motion hardly does: no core is fitted beside it unless the
    # ship file has it; and whether a diagnosis weighs it only where kinematics ask for it, or as a change
    kinematic: ClassVar[bool] = False
    suspected_first: ClassVar[bool] = False
    irregular: ClassVar[bool] = False  # whether it comes and goes with what no input shows
    # share of its length by which its side force may attack elsewhere than its form has it (one sd)
    lever: ClassVar[float] = 0.0
    # the number without which the others are a form of nothing; of most effects any of them is enough
    size: ClassVar[str] = ""
    source: ClassVar[str] = ""
    # whether it is a fault of the one propeller or rudder of a ship without actuators of its own
    one_screw: ClassVar[bool] = False
    # one of ROLES, of which the catalogue has one effect each; "": none of them
    role: ClassVar[str] = ""
    # as the source of its numbers where calibration finds them together with the core; "": it does not
    with_core: ClassVar[str] = ""
    # whether it is of the place (bottom, banks): a chart knows it, and no `add` fits it beside others
    of_place: ClassVar[bool] = False
    # numbers of it that the readings alone tell, as `twin instruments` calls them, and each number's own name
    by_readings: ClassVar[Mapping[str, str]] = MappingProxyType({})
    # numbers that it was given after the first residuals had been trained: a ship without them is the same
    added_later: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if cls.belongs_to not in OWNERS:
            raise ValueError(f"{cls.__name__}.belongs_to = {cls.belongs_to!r}: one of {OWNERS}")
        if cls.role and cls.role not in ROLES:
            raise ValueError(f"{cls.__name__}.role = {cls.role!r}: one of {tuple(ROLES)}, or none")
        dataclass(frozen=True)(cls)

    @classmethod
    def params(cls) -> tuple[Param, ...]:
        """Its numbers, as declared."""
        return tuple(Param(f.name, **f.metadata) for f in fields(cls))  # type: ignore[arg-type]

    @classmethod
    def sentence(cls, ship: ShipLike | None = None) -> str:
        """What an engineer would say of it in a report; `ship`: whose parts it is told of."""
        return " ".join((cls.__doc__ or "").split())

    @classmethod
    def plausible(cls, ship: ShipLike) -> "Effect":
        """The effect at its published or typical size on this ship."""
        return cls(**{p.name: p.default * p.scale(ship) for p in cls.params()})

    @classmethod
    def absent(cls, ship: ShipLike) -> "Effect":
        """The effect at the size at which it does nothing."""
        return cls(**{p.name: p.null * p.scale(ship) for p in cls.params()})

    @classmethod
    def lacking(cls, ship: ShipLike) -> tuple[str, ...]:
        """The particulars for want of which it cannot be sized on this ship."""
        return tuple(name for name in cls.needs_ship if getattr(ship, name, None) is None)

    @classmethod
    def of_recorded_weather(cls) -> bool:
        """Whether its cause is weather or water that was recorded: the cause is the voyage's, and its numbers
        are the ship's answer to it."""
        return cls.belongs_to == "voyage" and bool(set(cls.needs) - {"t"})

    @classmethod
    def is_weather(cls) -> bool:
        """Whether it is water or weather of a voyage: a moving or shallow water, or what a recorded sea, wind
        or bank does."""
        return cls.belongs_to == "voyage" and (issubclass(cls, Flow) or cls.of_recorded_weather())

    @classmethod
    def lasts(cls) -> bool:
        """Whether its numbers hold on another day: those of ship and instruments, and how the ship answers to
        weather that is recorded."""
        return cls.belongs_to != "voyage" or cls.of_recorded_weather()

    @classmethod
    def strength(cls, s: Situation, model: Sailing) -> Rates:
        """How strong its cause is in a situation: the accelerations [m/s2, m/s2, rad/s2] that it gives the
        ship at its plausible size, beyond those of the model without it. Sets s.u_r and s.v_r."""
        beside, alone = model.but(cls.plausible(model.ship)).nu_dot(s), model.nu_dot(s)
        return Rates(*[a - b for a, b in zip(beside, alone, strict=True)])

    def values(self) -> dict[str, Number]:
        """Its numbers as they are now, by name."""
        return {p.name: getattr(self, p.name) for p in self.params()}

    def but(self, **values: Number) -> Self:
        """The same effect with some of its numbers changed."""
        return replace(self, **values)  # type: ignore[type-var]

    def check(self, ship: ShipLike, where: str = "") -> None:
        """Refuse a parameter outside its box, or a ship that lacks a particular it needs. SettingsError:
        it says which."""
        name = type(self).__name__
        for p in self.params():
            lo, hi = p.box(ship)
            value = getattr(self, p.name)
            if not lo <= value <= hi:
                unit = "" if p.unit == "-" else f" {p.unit}"
                raise SettingsError(
                    f"{where}effects.{name}.{p.name} = {as_given(value)}{unit} lies outside its box "
                    f"[{as_given(lo)}, {as_given(hi)}]. Correct the number, or remove [effects.{name}]."
                )
        for particular in self.lacking(ship):
            raise SettingsError(
                f"{where}effects.{name} needs {particular}. Add it under [particulars], "
                f"or remove [effects.{name}]."
            )


class Force(Effect):
    """Pushes the ship, or changes its inertia."""

    kind = "Force"

    def force(self, s: Situation, ship: ShipLike) -> ForceVector:
        """The force in body axes [N, N, N m]."""
        return ForceVector()

    def alter(self, ship: S) -> S:
        """The ship as this effect leaves it (loading changes its mass); most effects leave it alone."""
        return ship


class Flow(Effect):
    """Changes the water that hull, propeller and rudder feel: nu_r = nu - nu_c."""

    kind = "Flow"
    stream: ClassVar[bool] = False  # whether it is nothing but moving water, which carries the ship along

    def water(self, s: Situation, ship: ShipLike) -> Water:
        """The water's velocity over ground in body axes [m/s], and by which shares it changes damping,
        added mass and thrust."""
        raise NotImplementedError


class Lag(Effect):
    """Gives an actuator a state of its own: what is ordered is not at once what acts."""

    kind = "Lag"

    def dead_time(self) -> Number:
        """How long after the order the gear begins to move [s]."""
        raise NotImplementedError

    def step(self, actual: Number, order: Number, h: Number) -> Number:
        """The actuator h seconds on, given where it is and the (already delayed) order."""
        raise NotImplementedError


class SensorFault(Effect):
    """The ship is right, the instrument is wrong."""

    kind = "SensorFault"
    belongs_to = "instrument"
    # whether it is compass or gyro that is wrong: an antenna stands where the true heading puts it
    attitude: ClassVar[bool] = False
    # the number by which the compass turns speed over ground (none where the receiver's own attitude does)
    turning: ClassVar[str] = ""
    of_velocity: ClassVar[bool] = False  # whether a receiver's own velocity has it, and its positions not

    def read(self, s: Situation, ship: ShipLike) -> Situation:
        """What the instruments say (a changed copy) of a ship that is truly in situation s."""
        raise NotImplementedError

    def as_read(self, number: str, value: Number, attitude: bool) -> Self:
        """The same fault with a number that the readings told (see `by_readings`). `attitude`: whether the
        receiver turns its velocity by an attitude of its own, so that the compass does not turn it."""
        turned = {self.turning: 0.0 if attitude else value} if self.turning else {}
        return self.but(**{self.by_readings[number]: value}, **turned)

    def prompt(self) -> "tuple[Number, SensorFault]":
        """How old place and speed over ground are when they are shown [s], and the same fault were they not:
        who has the whole voyage need not undo that to the order to which `read` gives it."""
        return 0.0, self
