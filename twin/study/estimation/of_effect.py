"""The numbers of an effect that could be wrong on a ship.

How late a receiver or a compass is, or how far off, shows twice where the compass turns the velocity over
ground into the ship's axes: in the reading itself, and in that turning (SensorFault.turning). Where the
ship's references told what turns it (instruments/on_references.py), the two are one number, or the second is
none; with two free numbers an antenna elsewhere is likelier than a late receiver."""

from twin.physics.effect import Effect, Param, SensorFault
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.ship_notes import read_from
from twin.study.estimation.columns import Unknown

NOTE = "instruments"  # where a ship file keeps what its references told of them


def effect_unknowns(effect: type[Effect], model: Model) -> list[Unknown]:
    """The parameters of one effect on this ship, centred on what the model holds of it: on "not there" where
    it does not."""
    present = next((e for e in model.effects if type(e) is effect), None) or effect.absent(model.ship)
    turning, of = _turning(present, model.ship)
    open_ones = (p for p in effect.params() if p.name != turning)
    return [_unknown(p, present, model, turning if p.name == of else "") for p in open_ones]


def _unknown(p: Param, present: Effect, model: Model, turning: str) -> Unknown:
    k, (lo, hi) = p.scale(model.ship), p.box(model.ship)
    return Unknown(
        type(present).__name__,
        p.name,
        p.unit,
        float(getattr(present, p.name)),
        p.sd * k,
        lo,
        hi,
        p.name in present.every_day,
        varies=present.varies,
        age=p.name in present.ages,
        turning=turning,
    )


def _turning(present: Effect, ship: Ship) -> tuple[str, str]:
    """The number that is no unknown of its own as what turns the velocity says, and the one that it is the
    same as ("": of none); as long as the ship's own effect has it so, too."""
    if not isinstance(present, SensorFault) or not present.turning:
        return "", ""
    (of,) = present.by_readings.values()
    with read_from(ship, f"[{NOTE}]"):
        now, by = getattr(present, present.turning), (ship.notes.get(NOTE) or {}).get("velocity_by")
    if by == "receiver" and now == 0.0:
        return present.turning, ""
    return (present.turning, of) if by == "compass" and now == getattr(present, of) else ("", "")
