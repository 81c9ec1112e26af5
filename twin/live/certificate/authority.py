"""Whether the rudder could hold a course against all that the certificate leaves open (docs/stability.md,
section 8).

    margin = 1 - (sum_j S_rj b_j + sum_k |M^-1|_rk D_k) / r_dot(35 deg)

the share of the rudder's authority, straight ahead at U_0, that is left. Below 0 the closed loop is not
covered by the certificate: course keeping is then shown by simulation only.
"""

from twin.live.certificate.certificate import Certificate
from twin.live.observer.operating import propeller_rate
from twin.physics.maths import dot
from twin.physics.model import Model
from twin.physics.state import Situation

HARD_OVER = 0.6109  # rad: 35 deg
YAW = 2


def authority(model: Model) -> float:
    """What the rudder hard over does to the rate of turn, straight ahead at U_0 [rad/s^2]."""
    U, n = model.loaded.U_0, propeller_rate(model)
    over, back = (
        float(model.nu_dot(Situation(u=U, delta=side * HARD_OVER, n=n))[YAW])  # type: ignore[arg-type]
        for side in (1.0, -1.0)
    )
    return 0.5 * abs(over - back)


def authority_margin(model: Model, certificate: Certificate) -> float:
    """The share of the rudder's authority that is left, in calm water; below 0 there is not enough."""
    plant = certificate.plant
    error = dot(plant.magnitude()[YAW], certificate.bound)
    push = dot(plant.inertia[YAW], certificate.disturbance.at(0.0))
    return 1.0 - (error + push) / max(authority(model), 1e-12)
