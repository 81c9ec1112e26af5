"""The heading that the physics is asked at is the observer's own: its error is a fourth state of the
certificate.

|psi_hat - psi| settles at (n_psi + b_r/K + what one sample's turning misses) (1 + l h K)/(1 - l h K)
"""

from dataclasses import replace

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.comparison_systems import Matrix, Row
from twin.live.certificate.plant import Disturbance, Plant
from twin.live.certificate.recursion import Ages
from twin.live.certificate.theorem import NEVER, Promise, assess


def with_heading(
    plant: Plant,
    K: Row,
    m: Ages,
    noise: Row,
    d: Disturbance,
    heading_noise: float,
    extra: Matrix | None = None,
) -> Promise:
    """The same where the physics is asked at the estimated heading, whose error settles where what the rate
    of turn adds to it is what its own measurement takes away: about n_psi + b_r/K. Two loops, the smaller
    gain of both under one."""
    first, second = (assess(plant, K, m, noise, d, n, extra) for n in (heading_noise, heading_noise + 1.0))
    if not first.ok:
        return first
    pull, back, k = first.step.pull[2], first.step.before[2], K[2]
    curve = 0.25 * plant.h * (plant.most[2] + c3.apply(first.push, d.calm)[2] / plant.h) / k
    grows = (1.0 + back * pull) / (1.0 - back * pull) if back * pull < 1.0 else NEVER
    share = (second.bound[2] - first.bound[2]) / k * grows
    if not share < 1.0:
        reason = (
            "an error of heading comes back larger than it was by way of the rate of turn. Take a "
            "larger K, or measure the heading sooner."
        )
        return replace(first, ok=False, reason=reason)
    alone = first.bound[2] - heading_noise * (second.bound[2] - first.bound[2])
    settled = (heading_noise + alone / k + curve) * grows / (1.0 - share)
    return assess(plant, K, m, noise, d, settled, extra)
