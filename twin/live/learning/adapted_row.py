"""One row of adapted numbers with the evidence for them, and a number as it is published."""

from dataclasses import dataclass
from typing import NamedTuple

from twin.physics.model import CORE

ROWS = ("surge", "sway", "yaw")
COLUMNS = (("hull", "propeller"), ("hull", "rudder"), ("hull", "rudder"))  # sizes that each row may correct
SIZES = len(COLUMNS[0])
BESIDE = SIZES + 1  # numbers of a row beside its components: sizes and a constant
CORES = tuple(tuple(CORE.index(name) for name in row) for row in COLUMNS)  # where they stand among the forces


class Parameter(NamedTuple):
    """One adapted number as it is published; status: unestimated, estimated or invalid."""

    name: str
    value: float
    low: float
    high: float
    sigma: float
    unit: str
    status: str

    def numbers(self) -> dict[str, float]:
        """Value, box and standard deviation, by name, in its unit."""
        return {"value": self.value, "low": self.low, "high": self.high, "sigma": self.sigma}


@dataclass(slots=True)
class Row:
    """One row's numbers, their covariance, and the evidence for them."""

    a: list[float]
    I: list[list[float]]  # information: what was seen, over its noise
    b: list[float]
    L: list[list[float]]  # its factor, with the prior
    sigma: list[float]  # of a, at that time
    then: list[float]  # a of HINDSIGHT to twice that ago, whose promises the gate weighs
    next: list[float]
    B: list[list[float]]  # information that it shares with each number of the named effects
    age: float = 0.0
    spread: float = 0.05  # s_r^2
