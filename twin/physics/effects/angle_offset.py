"""One actuator stands at another angle than its feedback says: azimuth, nozzle, outboard or rudder.

(X, Y, N) = (X, Y, N)_actuator(angle + offset) - (X, Y, N)_actuator(angle)
"""

from twin.physics.actuators import Actuator
from twin.physics.effect import param

from .of_actuator import ActuatorForce


class AngleOffset(ActuatorForce):
    """This actuator's zero is not where its feedback says: the same order pushes the ship another way."""

    recorded = ("angle",)
    of_angle = True
    source = "IMO MSC/Circ.1053 (2002), neutral rudder angle; alike for a pod's or a nozzle's feedback"

    offset: float = param(0.05, unit="rad", lo=-0.6, hi=0.6, sd=0.05, doc="true angle less the recorded one")

    def altered(self, a: Actuator) -> Actuator:
        return a.but(trim=a.trim + self.offset)
