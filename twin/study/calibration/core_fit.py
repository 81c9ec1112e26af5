"""`twin calibrate`: fits the core to reference voyages, and learns what a model of this kind still leaves
unexplained."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from twin.physics.effect import Effect
from twin.physics.effects import of_ship
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.jsonable import plain
from twin.recording.progress import Progress, silent
from twin.study.calibration.calibration_record import (
    PARTS,
    Core,
    record,
    remembering,
    searched_parts,
    sourced,
)
from twin.study.calibration.held_out import HeldOut, errors
from twin.study.calibration.own_deviation import own_deviation
from twin.study.calibration.own_instruments import own_instruments
from twin.study.calibration.parts import given, placed, significant, with_its_weather
from twin.study.calibration.usual import usual
from twin.study.calibration.ways import FittedShip, best_way
from twin.study.estimation.columns import Unknown, core_unknowns
from twin.study.estimation.fit import Fit, fit
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.reference.derivatives import first_prior, informed_by, noted, with_derivatives
from twin.study.reference.nuisance import TEMPER, instruments, temper_of
from twin.study.reference.reading import fitted_parts
from twin.study.reference.sailed import Sailed
from twin.study.reference.seaway import levelled, swung
from twin.study.reference.steering_gear import beside_its_gear, with_or_without_gear
from twin.study.reference.structure import structural_noise
from twin.study.track.track import Track

Curve = tuple[Unknown, ...]  # numbers of the compass's deviation


@dataclass(frozen=True)
class Calibrated:
    """The calibrated ship, and the numbers of how it came about."""

    ship: Ship
    result: dict[str, Any]


@dataclass(frozen=True)
class RoughCore:
    """A core fitted before the noise model is known."""

    ship: Ship
    tracks: list[Track]  # with the swing in waves, where they showed
    fit: Fit
    curve: Curve  # fitted beside it
    asked: Curve  # of that deviation, where the voyages clearly ask for it and it was not


class Begun(NamedTuple):
    """What an earlier fit found, with which a later one begins: its gear, its antenna and its compass; all
    numbers are as open as ever."""

    model: Model
    noise_model: NoiseModel | None = None
    antenna: Effect | None = None
    curve: Curve = ()


@dataclass(frozen=True)
class FittedCore:
    """A ship with its core fitted, before it is known what is usual on it."""

    begun: Ship  # with the core as it was, and its instruments as kinematics find them
    core: Core
    curve: Curve  # numbers of the compass's deviation that were fitted beside it
    chosen: FittedShip
    held_out: list[dict[str, Any]]  # by horizon, the error before the fit beside that after it
    instruments: dict[str, Any]  # numbers of instruments that became a part of the ship

    @property
    def moved(self) -> bool:
        """Whether predictions were better with the antenna where it was found."""
        return self.core.antenna in self.chosen.ship.effects

    def once_more(self) -> Begun:
        """With what a fit of these voyages and more begins."""
        return Begun(self.core.model, self.core.noise_model, self.core.antenna, self.curve)

    def calibrated(
        self,
        progress: Progress = silent,
        measured_by: "FittedCore | None" = None,
    ) -> Calibrated:
        """With what is usual on this ship. `measured_by`: the fit whose errors on what was held out count,
        where this one has used every voyage."""
        progress("estimating the baseline of this ship")
        lasting_ones = usual(self.chosen.ship, self.chosen.by_steps, self.core.tracks, self.core.noise_model)
        by = measured_by or self
        errors_of = {"held_out": by.chosen.off.by_horizon, "by_regime": by.chosen.off.by_regime}
        after = noted(self.chosen.ship, "structural", lasting_ones | errors_of)
        result = record(self.begun, after, self.core, self.chosen.way, by.held_out)
        return Calibrated(after, plain(result | {"instruments": self.instruments}))


def calibrate(
    fitted: Sequence[Sailed],
    held_out: HeldOut,
    ship: Ship,
    progress: Progress = silent,
) -> Calibrated:
    """Fit the core to the tracks, and learn what is usual on this ship."""
    return fitted_core(fitted, held_out, ship, progress).calibrated(progress)


def fitted_core(
    fitted: Sequence[Sailed],
    held_out: HeldOut,
    ship: Ship,
    progress: Progress = silent,
    by: str | None = None,
    begun: FittedCore | None = None,
) -> FittedCore:
    """Fit the core to the tracks, with the ship's instruments as kinematics find them on all of these. `by`:
    one of FITTED_BY; None: the one that predicts what was held out better. `begun`: what was fitted to a part
    of them, with which this begins, and which chose by what was held out from it: the way, and whether what
    was found of antenna and compass is the ship's; None: as for any ship."""
    first, sailed = ship, [s.track for s in fitted]
    progress("asking how the instruments go together, whatever the ship is")
    own = own_instruments(fitted, ship)
    ship = own.ship
    core, curve = _with_its_antenna(sailed, ship, progress, begun.once_more() if begun else None)
    held_out = [(swung(t, core.model, gear=False), first) for t, first in held_out]
    beside, antenna = _beside(ship, core), core.antenna
    if begun is None:
        beside = placed(beside, antenna, held_out)
    elif antenna is not None and begun.moved:
        beside = beside.with_effects(antenna)
    chosen = best_way(
        remembering(beside, core, fitted),
        core.tracks,
        [d.unknown for d in core.derivatives if d.excited],
        held_out,
        by=by,
        found_curve=bool(curve),
        like=begun.chosen if begun else None,
        progress=progress,
    )
    before = errors(Model.of(first), held_out).by_horizon
    rows = [
        e | {"before_m": b["position_m"], "before_deg": b["heading_deg"]}
        for b, e in zip(before, chosen.off.by_horizon, strict=True)
    ]
    return FittedCore(ship, core, curve, chosen, rows, own.written)


def _with_its_antenna(
    sailed: Sequence[Track], ship: Ship, progress: Progress, begun: Begun | None
) -> tuple[Core, Curve]:
    """The core, and the numbers of the compass's deviation that were fitted beside it, if the voyages ask for
    them. Where the antenna stands elsewhere than in the file it is in the model from the start: what heel and
    turning carry it about is no sway of its own, and bends the core."""
    antenna = begun.antenna if begun else None
    if antenna is None:
        core, curve = _beside_its_compass(sailed, ship, progress, begun)
        if (antenna := core.antenna) is None:
            return core, curve
        progress("fitting again, with the antenna where it was found")
        begun = Begun(core.model, core.noise_model, antenna, curve)
        del core  # its columns are large
    core, curve = _beside_its_compass(sailed, ship.with_effects(antenna), progress, begun)
    return _moved(core, ship, antenna), curve


def _moved(found: Core, ship: Ship, begun: Effect) -> Core:
    """With the antenna where it was found, but in the model as the ship's file has it until predictions are
    better with the other (`placed`). `begun`: where the fit had it."""
    of_antenna = type(begun)
    numbers = found.numbers[of_antenna.__name__]
    lasting_ones = (e for e in ship.effects if isinstance(e, of_antenna))
    return replace(
        found,
        effects=(*lasting_ones, *(e for e in found.effects if not isinstance(e, of_antenna))),
        antenna=begun.but(**{k: number["value"] for k, number in numbers.items()}),
    )


def _beside_its_compass(
    sailed: Sequence[Track], ship: Ship, progress: Progress, begun: Begun | None
) -> tuple[Core, Curve]:
    """The same with the antenna where this ship has it."""
    start, curve = (begun.noise_model, begun.curve) if begun else (None, ())
    if not curve:
        rough = _rough(sailed, ship, progress, begun)
        if not (curve := rough.asked):
            return _core(rough, progress, start), ()
        begun = Begun(rough.fit.model, start)
        del rough  # its columns are large
        progress("fitting again, with a compass that deviates with the heading")
    return _core(_rough(sailed, _deviating(ship), progress, begun, curve), progress, start), curve


def _deviating(ship: Ship) -> Ship:
    """The ship whose compass may deviate with the heading."""
    return ship.with_effects(PARTS["compass"].absent(ship))


def _rough(
    sailed: Sequence[Track],
    ship: Ship,
    progress: Progress,
    begun: Begun | None,
    curve: Curve = (),
) -> RoughCore:
    """`curve`: numbers of the compass's deviation, which the ship then has, that are as open as in any
    ship's."""
    model, known = Model.of(ship), of_ship(ship)
    own = [
        u
        for u in instruments(model, known)
        if not ((curve and u.owner == PARTS["compass"].__name__) or given(ship, u))
    ]
    unknowns = tuple(first_prior(u, ship) for u in (*core_unknowns(model), *own, *curve))
    if begun:
        tracks = _in_its_sea(sailed, begun.model, progress)
        progress("fitting the core from where it was found")
        parts = fitted_parts(tracks, model)
        rough = beside_its_gear(parts, model.but(*begun.model.lags), unknowns, known, TEMPER)
    else:
        progress(
            "fitting the core, and testing whether "
            + (
                "actuators lag behind what was recorded of them"
                if ship.actuators
                else "the recorded rudder angle is the order"
            )
        )
        tracks = [levelled(t) for t in sailed]
        parts = fitted_parts(tracks, model)
        rough = with_or_without_gear(parts, model, unknowns, known, TEMPER)
        again = _in_its_sea(sailed, rough.model, progress)
        if [t.swell is None for t in again] != [t.swell is None for t in sailed]:
            tracks, parts = again, fitted_parts(again, model)
            rough = with_or_without_gear(parts, model, unknowns, known, TEMPER)
    progress("testing whether wind or little water under the keel acted on the ship")
    rough = with_its_weather(parts, rough, known, TEMPER)
    progress("testing whether the compass deviates with the heading")
    return RoughCore(ship, tracks, rough, curve, own_deviation(parts, rough, known, TEMPER))


def _in_its_sea(sailed: Sequence[Track], model: Model, progress: Progress) -> list[Track]:
    """The tracks with the swing in waves, where it shows beside this model, whose gear was looked for."""
    progress("testing again whether waves move the ship")
    return [levelled(swung(t, model, gear=False)) for t in sailed]


def _core(rough: RoughCore, progress: Progress, start: NoiseModel | None) -> Core:
    """The core under the noise model that these voyages ask for."""
    ship, tracks, begun, unknowns = rough.ship, rough.tracks, rough.fit, rough.fit.unknowns
    progress("estimating the noise model")
    noise_model = structural_noise(begun.lines, unknowns, start)
    temper = temper_of(innovate(begun.lines, [noise_model])[0], unknowns)
    progress("fitting again with this noise model")
    read = fitted_parts(tracks, begun.model)
    found = fit(read, begun.model, unknowns, of_ship(ship), noise_model, temper=temper, smooth=True)
    searched = (*searched_parts(ship), *([PARTS["compass"]] if rough.curve else []))
    asked = tuple(e for e in found.model.effects if type(e) in searched)
    kept = tuple(e for e in ship.effects if type(e) not in map(type, asked))
    parts = {e.__name__: e for e in (*searched, *PARTS.values())}
    numbers = {name: _numbers(found, name, e.with_core) for name, e in parts.items()}
    return Core(
        tracks,
        found.model,
        informed_by(found),
        (*kept, *asked),
        numbers,
        searched,
        significant(found),
        noise_model,
        temper,
    )


def _numbers(found: Fit, owner: str, why: str) -> dict[str, dict[str, Any]]:
    """What the ship file keeps of the numbers of a part of it that was found with the core."""
    return {
        u.name: {"value": float(value), "unit": u.unit, "sd": float(sd), "source": sourced(u.sd, sd, why)}
        for u, value, sd in zip(found.unknowns, found.value, found.sd, strict=True)
        if owner in (u.owner, *u.also)
    }


def _beside(ship: Ship, core: Core) -> Ship:
    """The ship with the fitted derivatives, and with what was searched beside them and found."""
    return replace(with_derivatives(ship, core.derivatives), effects=core.effects)
