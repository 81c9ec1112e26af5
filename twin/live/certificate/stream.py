"""How wrong the followed current may be before it alone is more than the certificate's disturbance.

A current that is wrong by c leaves |F(nu - c) - F(nu)| + |r x c| of acceleration that the physics does not
know: a part of A3 (docs/stability.md)."""

from math import hypot

from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.certificate import Certificate
from twin.live.certificate.comparison_systems import AXES, Row
from twin.live.certificate.plant import Plant


def stream_margin(certificate: Certificate) -> float:
    """By how much [m/s] the followed current may be wrong before that alone is more than the disturbance of
    calm water (without the learned force's part)."""
    d, part = certificate.disturbance.calm, certificate.saturation
    calm = c3.row(a - b for a, b in zip(d, part, strict=True))
    covered = c3.apply(certificate.plant.inertia, calm)
    return min(a / max(b, 1e-12) for a, b in zip(covered, by_stream(certificate.plant), strict=True))


def by_stream(plant: Plant) -> Row:
    """What a metre a second of unknown current adds to nu_dot at most, whatever its direction: the slopes
    with the speed through the water, and its turning in the ship's axes [1/s, 1/s, 1/(m s)]."""
    size, r = plant.magnitude(), max(abs(x) for x in plant.operating.ranges["r"])
    return c3.row(hypot(size[i][0], size[i][1]) + (r if i < 2 else 0.0) for i in AXES)
