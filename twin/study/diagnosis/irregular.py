"""A force that comes and goes: whether what acts like a cause lasts all voyage, as that cause does.

Ice that is met now and then takes speed as fouling does, and a propeller that draws air as a worn one does.
Where a force comes and goes faster than a ship answers, its mean looks like an effect that lasts, and the
rest like a rough day. So the two are held against each other: the effect and a fast part of the noise model
as these voyages show it (`settle` in case.py), and that part as on the reference voyages, beside as much of
the effect's own force, there or not from moment to moment. On a rough day the noise does not follow it."""

from dataclasses import replace

import numpy as np
from scipy.special import expit

from twin.study.diagnosis.case import ODDS, ODDS_UNNAMED, Case
from twin.study.diagnosis.refine import Found, standing
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.linear import Linear
from twin.study.estimation.respond import accelerations
from twin.study.reference.evidence import posterior

SHARES = (0.5, 0.7, 1.0, 1.4)  # of the causes' mean force, that may come and go


def comes_and_goes(case: Case, found: Found) -> float:
    """How probable it is [1] that the force of this hypothesis' causes comes and goes, and has no name,
    rather than lasts on a day as rough as these voyages show; 0 where no cause exerts a force."""
    gain = log_bayes_factor(case, found)
    return 0.0 if gain is None else float(expit(gain + np.log(ODDS_UNNAMED / ODDS)))


def log_bayes_factor(case: Case, found: Found) -> float | None:
    """How much likelier the voyages are when that force comes and goes than when it lasts, on a day that is
    rough or as the references were [log Bayes factor]; None where no cause exerts one."""
    chosen = found.hypothesis.effects
    if not case.causes(chosen):
        return None
    lines, at = standing(case, found)
    forces = [_of_causes(case, line) for line in lines]
    if not any(map(np.any, forces)):
        return None
    (rough,) = case.scenarios([found.hypothesis.scenario], found.doubt)
    calm = replace(rough, white=case.white)

    def evidence(noise_model: NoiseModel, share: float) -> float:
        fitful = [replace(line, fitful=share * f) for line, f in zip(lines, forces, strict=True)]
        return posterior(case.reduced(fitful, [noise_model], at)[0], chosen).log_evidence

    return max(evidence(calm, share) for share in SHARES) - max(evidence(n, 0.0) for n in (rough, calm))


def _of_causes(case: Case, line: Linear) -> np.ndarray:
    """(N, 3) accelerations, unsigned [m/s2, m/s2, rad/s2], that the causes give beside the day's weather and
    what comes and goes in any case."""
    others = (e for e in line.model.effects if type(e).__name__ in case.weather or e.irregular)
    without = case.model.but(*others)
    return np.abs(accelerations(line.track, line.model) - accelerations(line.track, without))
