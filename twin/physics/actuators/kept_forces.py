"""Forces of actuators along one motion, each worked out once: of many models that differ in one number, most
actuators read none of it and give what they gave.

For arrays over time, where a force takes a hundred times as long as to see that nothing of it has
changed."""

from collections.abc import Mapping
from typing import Any

from twin.physics.core import Tau
from twin.physics.ship_like import ShipLike
from twin.physics.state import Number

from .kinds import KINDS, OneActuator

READ_OF_SHIP = ("rho", "U_0", "L_pp")  # what any actuator reads of its ship


class KeptForces:
    """What actuators gave in one motion. The motion is that of the first who asks: in another (water that
    moves otherwise) nothing is kept. The arrays must stay as they are."""

    def __init__(self) -> None:
        self._motion: tuple[Any, ...] = ()
        self._of: dict[Any, tuple[tuple[Any, ...], Tau]] = {}

    def orders(self, of: Mapping[str, Number] | None) -> "KeptOrders | None":
        """The same orders; a force that is asked of them is kept here. None: a ship without actuators."""
        return None if of is None else KeptOrders(of, self)

    def force(
        self, a: OneActuator, orders: "KeptOrders", u: Number, v: Number, r: Number, ship: ShipLike
    ) -> Tau:
        """What `a` gives, as Actuator.force has it [N, N, N m]."""
        self._motion = self._motion or (u, v, r)
        if not all(map(_same, self._motion, (u, v, r))):
            return a.of_kind(a, orders.plain, u, v, r, ship)
        told = tuple(orders[key] for key in a.keys.values())
        asked = a, tuple(map(id, told)), read_of(a, ship)
        if asked not in self._of:  # `told` is kept, that no other array takes its place in memory
            self._of[asked] = told, a.of_kind(a, orders.plain, u, v, r, ship)
        return self._of[asked][1]


class KeptOrders(dict[str, Number]):
    """What is recorded of a ship's actuators, `name.attribute` in SI, in a motion whose forces are kept."""

    def __init__(self, of: Mapping[str, Number], kept: KeptForces) -> None:
        super().__init__(of)
        self.plain, self.kept = of, kept


def read_of(a: OneActuator, ship: ShipLike) -> tuple[Number, ...]:
    """Every number of the ship that the force of an actuator depends on, each in its own unit."""
    of, d = KINDS[a.kind].reads, ship.derivatives
    return (*(getattr(ship, name) for name in READ_OF_SHIP), *(getattr(d, name) for name in of))


def _same(a: Any, b: Any) -> bool:
    return a is b or (a.shape == b.shape and bool((a == b).all()))
