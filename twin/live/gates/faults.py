"""Instruments whose faults are known: what the ship file says is wrong with them is taken off before anybody
uses it.

measured' = measured - (read(s) - s), read being what the instruments would say of the ship where it is
    believed to be.
"""

from dataclasses import fields

from twin.live.observer.estimate import Estimate
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.physics.effect import SensorFault
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import Rates, Situation

FIELDS = tuple(f.name for f in fields(Situation) if f.name not in ("t", "p", "u_dot", "v_dot", "r_dot"))
OWN = ("psi", "r", "wind_speed", "wind_to")  # derived, these come from what the faults were taken off already


class KnownFaults:
    """The sensor faults of a ship; a ship without any costs nothing."""

    def __init__(self, ship: Ship):
        model = Model.of(ship)
        self.ship: Ship = model.loaded
        self.faults: tuple[SensorFault, ...] = model.faults
        self._of_positions = tuple(_by_compass(f) for f in model.faults if not f.of_velocity)

    def undo(self, measured: Measured, e: Estimate, rates: Rates) -> Measured:
        """Takes the faults off `measured.si`; what is logged and shown as measured stays as it came."""
        if not self.faults or not e.ready:
            return measured
        si = measured.si
        drift = e.current_body()
        true = Situation(e.x, e.y, e.psi, e.u, e.v, e.r, e.u - drift[0], e.v - drift[1])
        true.u_dot, true.v_dot, true.r_dot = rates
        for name in FIELDS[8:]:
            if name in si:
                setattr(true, name, si[name])
        read = true
        for fault in self._of_positions if "u" in measured.derived else self.faults:
            if all(need in si for need in fault.needs):
                read = fault.read(read, self.ship)
        for name in FIELDS:
            said, is_so = getattr(read, name), getattr(true, name)
            if name in si and said != is_so and not (name in OWN and name in measured.derived):
                si[name] -= turn(said - is_so) if name == "psi" else said - is_so
        return measured


def _by_compass(fault: SensorFault) -> SensorFault:
    """The same fault where the compass turns speed over ground into the ship's axes."""
    if not fault.turning:
        return fault
    (number,) = fault.by_readings.values()
    return fault.but(**{fault.turning: getattr(fault, number)})
