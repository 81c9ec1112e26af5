"""Weather that the model knows, and effects that were added since it was calibrated: their forms are only
roughly right, and another day shows it.

What such a form misses changes from moment to moment (the filter's slack), and it lasts: of a wind that blows
from one side all voyage, and whose force is known to a tenth, a tenth is left over that would be a tow, a
drag or a list. So a share of the known force may stand in each axis, as a Fourier series in the heading: each
term a column of its own, and no part of any model."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from twin.physics.effect import Effect, Force
from twin.physics.model import Model
from twin.physics.state import Force as ForceVector
from twin.physics.state import Situation
from twin.study.estimation.respond import respond, standard
from twin.study.track.track import Track

KNOWN = 0.1  # share of the force of an effect in the model that may be something else
# share of an irregular effect's force, and of what it does to the path, that no size of it explains
COMES_AND_GOES = 0.5
TINY = 1e-12
AXES = ("surge", "sway", "yaw")
COURSES = ("always", "cos", "sin", "cos_twice", "sin_twice")  # of the heading
TERMS = tuple(f"{axis}_{course}" for axis in AXES for course in COURSES)


def added(model: Model) -> list[tuple[Model, float]]:
    """Of every effect of the model that was not there when it was calibrated, and of weather (another one on
    each day): the model without it, and by what share of its force its form may be wrong."""
    return [(_but(model, e), COMES_AND_GOES if e.irregular else KNOWN) for e in _since(model)]


def elsewhere(model: Model, names: Collection[str] | None = None) -> list[tuple[Model, Model]]:
    """Of every such effect (or those of `names`) whose side force may attack elsewhere along it: the model
    with it farther ahead, and aft."""
    mine = [
        e
        for e in _since(model)
        if isinstance(e, Force) and e.lever and (names is None or type(e).__name__ in names)
    ]
    return [(_turned(model, e, 1.0), _turned(model, e, -1.0)) for e in mine]


def _since(model: Model) -> list[Effect]:
    calibrated = model.ship.notes.get("structural", {}).get("beside_effects", ())
    return [
        e for e in model.effects if not getattr(e, "stream", False) and type(e).__name__ not in calibrated
    ]


def _but(model: Model, effect: Effect) -> Model:
    return Model(model.ship, tuple(e for e in model.effects if e is not effect))


def _turned(model: Model, effect: Force, side: float) -> Model:
    def moment(s: Situation) -> ForceVector:
        if any(getattr(s, name) is None for name in effect.needs):
            return ForceVector()
        return ForceVector(N=side * effect.lever * float(model.ship.L_pp) * effect.force(s, model.loaded).Y)

    return replace(model, residual=moment)


def doubted(track: Track, model: Model) -> np.ndarray:
    """(N, 3) [m/s2, m/s2, rad/s2] by which the accelerations of these effects may be wrong at each moment: a
    share of each, and of the turning what a push aside makes that attacks elsewhere."""
    out = np.zeros((len(track), 3))
    for without, share in added(model):
        out += np.square(share * (respond(track, model)[0] - respond(track, without)[0]))
    for ahead, aft in elsewhere(model):
        out += np.square(0.5 * (respond(track, ahead)[0] - respond(track, aft)[0]))
    return np.sqrt(out)


def accelerations(track: Track, model: Model) -> dict[str, np.ndarray]:
    """(N, 3) of one unit of each term: in each axis what is doubted of it as a rule, stronger where all of it
    together is stronger."""
    each = doubted(track, model)
    strength, usual = np.linalg.norm(each / standard(model), axis=1), np.sqrt(np.mean(each**2, axis=0))
    size = strength / max(float(np.sqrt(np.mean(strength**2))), TINY)
    psi = track.state[:, 2]
    courses = (np.ones_like(psi), np.cos(psi), np.sin(psi), np.cos(2.0 * psi), np.sin(2.0 * psi))
    columns = (np.outer(size * course, np.eye(3)[axis] * usual) for axis in range(3) for course in courses)
    return dict(zip(TERMS, columns, strict=True))
