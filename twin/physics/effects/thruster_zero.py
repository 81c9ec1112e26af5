"""The command at which one actuator stands still is not where its curve has it (a controller's trim).

(X, Y, N) = (X, Y, N)_actuator(zero + shift) - (X, Y, N)_actuator(zero)
"""

from twin.physics.actuators import Actuator
from twin.physics.effect import param

from .of_actuator import ActuatorForce


class ThrusterZero(ActuatorForce):
    """This actuator's command is counted from elsewhere than its curve has it: it pushes when it is told to
    stand still."""

    recorded = ("command", "pwm")
    source = "controllers of brushless thrusters: pulse width at stop within tens of microseconds"

    shift: float = param(
        0.05, unit="-", lo=-0.4, hi=0.4, sd=0.05, doc="command at which it stands still, less the known one"
    )

    def altered(self, a: Actuator) -> Actuator:
        return a.but(zero=a.zero + self.shift)
