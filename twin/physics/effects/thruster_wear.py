"""One actuator gives less than its record says: worn or fouled blades, a weak battery, weed in a jet.

(X, Y, N) = (X, Y, N)_actuator(gain (1 - loss)) - (X, Y, N)_actuator(gain)
A negative loss: it gives more than its record says.
"""

from twin.physics.actuators import Actuator
from twin.physics.effect import param

from .of_actuator import ActuatorForce


class ThrusterWear(ActuatorForce):
    """This actuator gives less thrust than its record says, so the ship is slower and is pulled to its
    side."""

    of_several = "These actuators give less thrust than their record says, all alike, so the ship is slower."
    source = "Carlton (2018) Marine Propellers and Propulsion, 4th ed. (blade damage in service)"

    loss: float = param(
        0.15,
        unit="-",
        lo=-1.0,
        hi=1.0,
        sd=0.15,
        doc="share of its thrust that is lost, alike at every command",
    )

    def altered(self, a: Actuator) -> Actuator:
        return a.but(gain=a.gain * (1.0 - self.loss))
