"""One actuator, or several of one make alike, answers late: what is recorded is its order, and thrust or
angle follow it.

d(actual)/dt = (order(t - delay) - actual)/ease
"""

from twin.physics.effect import Lag, param
from twin.physics.state import Number

from .of_actuator import OfActuator

TINY = 1e-9  # s


class ActuatorLag(OfActuator, Lag):
    """This actuator answers late and slowly: a dead time and a time constant stand between its order and what
    it does."""

    of_several = (
        "These actuators answer late and slowly, all alike: a dead time and a time constant stand between "
        "their orders and what they do."
    )
    ages = ("delay",)
    with_core = "what was recorded of it is its order"
    source = "Fossen (2021) Handbook of Marine Craft Hydrodynamics, 2nd ed., ch. 9 (actuator dynamics)"

    delay: float = param(0.05, unit="s", lo=0.0, hi=0.5, sd=0.05, of="time", form=0.5, doc="dead time")
    ease: float = param(0.1, unit="s", lo=0.0, hi=2.0, sd=0.15, of="time", form=0.5, doc="time constant")

    def dead_time(self) -> Number:
        return self.delay

    def step(self, actual: Number, order: Number, h: Number) -> Number:
        return actual + (order - actual) * ((h + TINY) / (h + TINY + self.ease))
