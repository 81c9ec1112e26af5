"""A trained residual in the study, for arrays of situations: the learned force as the loop adds it (its
adaptation left out), and the features it is made of."""

from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path

import numpy as np

from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.network import Network
from twin.live.learning.onnx_file import look
from twin.live.learning.residual import load
from twin.physics.ship import Ship
from twin.physics.state import Force, Situation


def learned_force(path: str, ship: Ship) -> Callable[[Situation], Force]:
    """Situation (floats or arrays, s.u_r and s.v_r set) -> the residual's force; SettingsError when it must
    not be used."""
    learned = LearnedForce(ship, load(path, ship), adapt=False)

    def force(s: Situation) -> Force:
        return Force(*np.array([learned.at(one, ()).force for one in _each(s)]).T)

    return force


def features(path: str, ship: Ship) -> tuple[Callable[[Situation], np.ndarray], np.ndarray]:
    """Situation -> (N, features) phi, nothing where it is not believed; and the last layer W (3,
    features)."""
    residual, model = load(path, ship), Path(path).read_bytes()
    manifest, names = residual.manifest, look(model)
    trunk = Network(model, names.inputs[0][0], len(manifest.inputs), names.outputs[0][0], manifest.features)

    def phi(s: Situation) -> np.ndarray:
        told = [residual.scaled(one) for one in _each(s)]
        return np.array(
            [
                weight * np.array(trunk.run(x)) if weight else np.zeros(manifest.features)
                for x, weight, _ in told
            ]
        )

    return phi, np.array(manifest.W)


def _each(s: Situation) -> Iterator[Situation]:
    """The situations one by one, in plain floats."""
    there = {
        f.name: np.atleast_1d(np.asarray(x, float))
        for f in fields(Situation)
        if (x := getattr(s, f.name)) is not None
    }
    width = max(x.size for x in there.values())
    for row in zip(*(np.broadcast_to(x, width).tolist() for x in there.values()), strict=True):
        yield Situation(**dict(zip(there, row, strict=True)))
