"""A force that comes and goes: whether what acts like a cause lasts all voyage, as that cause does.

Ice that is met now and then takes speed as fouling does, and a propeller that draws air as a worn one does.
An effect of the catalogue is there at every moment, with the force that its form has for how the ship sails.
So the explanation's causes are asked whether the voyages are likelier when as much of their force, for some
ship lengths at a time, may be there or not, as of an effect that comes and goes with what no input shows."""

from dataclasses import replace

import numpy as np

from twin.study.diagnosis.case import Case
from twin.study.diagnosis.refine import IRREGULAR, Found, standing
from twin.study.estimation.linear import Linear
from twin.study.estimation.respond import accelerations
from twin.study.reference.evidence import posterior


def comes_and_goes(case: Case, found: Found) -> float:
    """How much likelier the voyages are when the force of this hypothesis' causes comes and goes than when it
    is as steady as their forms [log Bayes factor]; 0 without a cause that exerts a force."""
    chosen = found.hypothesis.effects
    if not case.causes(chosen):
        return 0.0
    lines, at = standing(case, found)
    forces = [_of_causes(case, line) for line in lines]
    if not any(np.any(force) for force in forces):
        return 0.0
    noise_model = case.scenarios([found.hypothesis.scenario], found.doubt)

    def evidence(share: float) -> float:
        loose = [
            replace(line, slack=np.hypot(line.slack, share * force))
            for line, force in zip(lines, forces, strict=True)
        ]
        return posterior(case.reduced(loose, noise_model, at)[0], chosen).log_evidence

    return max(map(evidence, IRREGULAR)) - evidence(0.0)


def _of_causes(case: Case, line: Linear) -> np.ndarray:
    """(N, 3) accelerations, unsigned [m/s2, m/s2, rad/s2], that the causes give beside the day's weather and
    what comes and goes in any case."""
    others = (e for e in line.model.effects if type(e).__name__ in case.weather or e.irregular)
    without = case.model.but(*others)
    return np.abs(accelerations(line.track, line.model) - accelerations(line.track, without))
