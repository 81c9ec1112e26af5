"""Weather that the model knows, and effects that were added since she was calibrated: their forms are only roughly right, and another day shows it.

What such a form misses changes from moment to moment (the filter's slack), and it lasts: of a wind that blows from one side all voyage, and whose
force is known to a tenth, a tenth is left over that would be a tow, a drag or a list. So a share of the known force may stand in each axis, as a
Fourier series in the heading: each term a column of its own, and no part of any model.
"""

import numpy as np

from twin.physics.model import Model

from .respond import respond, standard
from .track import Track

KNOWN = 0.1  # share of the force of an effect in the model that may be something else
COMES_AND_GOES = 0.5  # share of an irregular effect's force, and of what it does to the path, that no size of it explains
TINY = 1e-12
AXES = ("surge", "sway", "yaw")
COURSES = ("always", "cos", "sin", "cos_twice", "sin_twice")  # of the heading
TERMS = tuple(f"{axis}_{course}" for axis in AXES for course in COURSES)


def added(model: Model) -> list[tuple[Model, float]]:
    """Of every effect of the model that was not there when she was calibrated, and of weather (another one on each day): the model without it, and
    by what share of its force its form may be wrong."""
    calibrated = model.ship.notes.get("structural", {}).get("beside_effects", ())
    since = [e for e in model.effects if not getattr(e, "stream", False) and type(e).__name__ not in calibrated]
    return [(Model(model.ship, tuple(o for o in model.effects if o is not e)), COMES_AND_GOES if e.irregular else KNOWN) for e in since]


def doubted(track: Track, model: Model) -> np.ndarray:
    """(N, 3) [m/s2, m/s2, rad/s2] by which the accelerations of these effects may be wrong at each moment."""
    out = np.zeros((len(track), 3))
    for without, share in added(model):
        out += np.square(share * (respond(track, model)[0] - respond(track, without)[0]))
    return np.sqrt(out)


def accelerations(track: Track, model: Model) -> dict[str, np.ndarray]:
    """(N, 3) of one unit of each term: in each axis what is doubted of it as a rule, stronger where all of it together is stronger."""
    each = doubted(track, model)
    strength, usual = np.linalg.norm(each / standard(model), axis=1), np.sqrt(np.mean(each**2, axis=0))
    size = strength / max(float(np.sqrt(np.mean(strength**2))), TINY)
    psi = track.state[:, 2]
    courses = (np.ones_like(psi), np.cos(psi), np.sin(psi), np.cos(2.0 * psi), np.sin(2.0 * psi))
    columns = (np.outer(size * course, np.eye(3)[axis] * usual) for axis in range(3) for course in courses)
    return dict(zip(TERMS, columns, strict=True))
