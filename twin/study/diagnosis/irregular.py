"""A force that comes and goes: whether what acts like a cause of the ship lasts all voyage, as that does.

Ice that is met now and then takes speed as fouling does, and a propeller that draws air as a worn one does.
Where a force comes and goes faster than a ship answers, its mean looks like a cause that lasts, and the rest
like a rough day. So the two are held against each other: the cause and a fast part of the noise model, as
these voyages show it (`settle` in case.py) or as on the reference voyages; and the latter, with as much of
the cause's own force beside it, there or not from moment to moment; each with the slow part of the noise as
the hypothesis has it or as on the references. On a rough day the noise does not follow the force. (What pulls
or pushes from outside need not be steady: of a tow nothing is asked.)"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.special import expit

from twin.study.diagnosis.case import ODDS, ODDS_UNNAMED, Case
from twin.study.diagnosis.refine import Found, standing
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.linear import Linear
from twin.study.estimation.respond import accelerations
from twin.study.reference.evidence import posterior

# of the mean force, that may come and go [1]: a grid by half octaves, the likeliest counts; not fitted
SHARES = (0.5, 0.7, 1.0, 1.4)


def comes_and_goes(case: Case, found: Found) -> float:
    """How probable it is [1] that the force of this hypothesis' causes that belong to the ship comes and
    goes, and has no name, rather than lasts on a day as rough as these voyages show; 0 without such a
    force."""
    gain = log_bayes_factor(case, found)
    return 0.0 if gain is None else float(expit(gain + np.log(ODDS_UNNAMED / ODDS)))


def log_bayes_factor(case: Case, found: Found) -> float | None:
    """How much likelier the voyages are when that force comes and goes than when it lasts, on a day that is
    rough or as the references were [log Bayes factor]; None where there is no such force."""
    chosen = found.hypothesis.effects
    own = {name for name in chosen if case.catalogue[name].belongs_to == "ship"}
    if not own:
        return None
    lines, at = standing(case, found)
    forces = [_of(case, own, line) for line in lines]
    if not any(map(np.any, forces)):
        return None
    rough = case.scenarios(list(dict.fromkeys(("usual", found.hypothesis.scenario))), found.doubt)
    calm = [replace(each, white=case.white) for each in rough]

    def evidence(share: float, noise_models: Sequence[NoiseModel]) -> float:
        fitful = [replace(line, fitful=share * f) for line, f in zip(lines, forces, strict=True)]
        return max(posterior(r, chosen).log_evidence for r in case.reduced(fitful, noise_models, at))

    return max(evidence(share, calm) for share in SHARES) - evidence(0.0, [*rough, *calm])


def _of(case: Case, own: set[str], line: Linear) -> np.ndarray:
    """(N, 3) accelerations, unsigned [m/s2, m/s2, rad/s2], that these effects give beside the others."""
    others = (effect for effect in line.model.effects if type(effect).__name__ not in own)
    without = case.linearised.but(*others)
    return np.abs(accelerations(line.track, line.model) - accelerations(line.track, without))
