"""Gears that answer late: where rudder and actuators are, given what they were ordered and when."""

from collections import deque
from collections.abc import Mapping
from copy import copy
from typing import Protocol

from twin.physics.effect import Lag
from twin.physics.effects.of_actuator import OfActuator
from twin.physics.state import Situation


class Steering(Protocol):
    """The orders, and what follows them; times may only go on."""

    def follow(self, s: Situation) -> None:
        """Puts what follows its order where it is at the time of s."""
        ...

    def take(self, si: Mapping[str, float]) -> None:
        """The orders of now, where they are measured."""
        ...

    def copy(self) -> "Steering":
        """The same gears, that can be run ahead on their own."""

    @property
    def late(self) -> bool:
        """Whether anything answers late."""
        ...


class RudderGear:
    """A rudder that follows its order through every gear of the model."""

    def __init__(self, gears: "list[Gear]", order: float = 0.0):
        self.gears, self.order = gears, order

    @property
    def late(self) -> bool:
        """Whether there is a gear at all."""
        return bool(self.gears)

    def at(self, t: float) -> float:
        """Where the rudder is at time t [rad]."""
        delta = self.order
        for gear in self.gears:
            delta = gear.turn(delta, t)
        return delta

    def follow(self, s: Situation) -> None:
        """Put the rudder where it is at `s.t` [s]."""
        s.delta = self.at(s.t)

    def take(self, si: Mapping[str, float]) -> None:
        """Take the order, if one was measured."""
        self.order = si.get("delta", self.order)

    def copy(self) -> "RudderGear":
        """The same gear, that can be run ahead on its own."""
        return RudderGear([gear.copy() for gear in self.gears], self.order)


class ActuatorGears:
    """Actuators of which some answer late; the others are where they are told."""

    def __init__(self, gears: "dict[str, list[Gear]]", orders: Mapping[str, float]):
        """gears: by `name.attribute`, those between its order and it; orders: of all, in SI."""
        self.gears, self.orders = gears, orders

    @property
    def late(self) -> bool:
        """Whether any actuator has a gear."""
        return bool(self.gears)

    def follow(self, s: Situation) -> None:
        """Put the actuators where they are at `s.t` [s]."""
        if not self.gears:
            s.orders = self.orders
            return
        orders = dict(self.orders)
        for name, gears in self.gears.items():
            for gear in gears:
                orders[name] = gear.turn(orders[name], s.t)  # type: ignore[arg-type]
        s.orders = orders

    def take(self, si: Mapping[str, float]) -> None:
        """Take the orders that were measured."""
        self.orders = {k: si.get(k, x) for k, x in self.orders.items()}

    def copy(self) -> "ActuatorGears":
        """The same gears, that can be run ahead on their own."""
        gears = {name: [gear.copy() for gear in many] for name, many in self.gears.items()}
        return ActuatorGears(gears, self.orders)


class Gear:
    """An actuator that answers late: where it is, given what was ordered."""

    def __init__(self, lag: Lag):
        self.lag = lag
        self.actual: float | None = None
        self._orders: deque[tuple[float, float]] = deque(maxlen=4096)
        self._t = 0.0

    def turn(self, order: float, now_s: float) -> float:
        """Where it is now [SI]."""
        dt, self._t = now_s - self._t, now_s
        if self.actual is None or not 0.0 <= dt < 5.0:  # after a pause no earlier order counts
            self._orders.clear()
            self.actual = order
        self._orders.append((now_s, order))
        due = now_s - self.lag.dead_time()
        while len(self._orders) > 1 and self._orders[1][0] <= due:
            self._orders.popleft()
        self.actual = float(self.lag.step(self.actual, self._orders[0][1], dt))
        return self.actual

    def copy(self) -> "Gear":
        """The same gear with orders of its own."""
        other = copy(self)
        other._orders = self._orders.copy()
        return other


def gears_of(lags: tuple[Lag, ...], rest: Mapping[str, float]) -> RudderGear | ActuatorGears:
    """The gears of a model; `rest`: the orders of its actuators to begin with, {} of a ship with one rudder.
    A lag of an actuator, or of several, stands between each of their orders and them."""
    if not rest:
        return RudderGear([Gear(lag) for lag in lags])
    gears = dict[str, list[Gear]]()
    for lag in lags:
        for name in rest:
            if isinstance(lag, OfActuator) and name.partition(".")[0] in lag.names:
                gears.setdefault(name, []).append(Gear(lag))
    return ActuatorGears(gears, rest)
