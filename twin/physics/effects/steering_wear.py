"""The rudder behind one propeller gives less force at its angle: worn, fouled, damaged or partly lost.

(X, Y, N) = (X, Y, N)_actuator(A_R (1 - loss)) - (X, Y, N)_actuator(A_R)
"""

from twin.physics.actuators import Actuator
from twin.physics.effect import param

from .of_actuator import ActuatorForce


class SteeringWear(ActuatorForce):
    """The rudder behind this actuator gives less force at the same angle: the ship answers late and turns
    wider."""

    recorded = ("angle",)
    of_several = (
        "The rudders behind these actuators give less force at the same angle, all alike: the ship answers "
        "late and turns wider."
    )
    source = "Yasukawa & Yoshimura (2015) J. Mar. Sci. Technol. 20, 37-52, eq. (20)-(27): a share of F_N"

    loss: float = param(
        0.15, unit="-", lo=0.0, hi=0.8, sd=0.15, doc="share of its rudder's force that is lost"
    )

    @classmethod
    def suits(cls, a: Actuator) -> bool:
        return super().suits(a) and a.A_R is not None

    def altered(self, a: Actuator) -> Actuator:
        return a.but(A_R=a.A_R * (1.0 - self.loss))
