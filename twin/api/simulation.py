"""`twin.simulate`: the model sailed through a manoeuvre in still water."""

import re
from dataclasses import dataclass, field
from math import degrees, pi, radians
from typing import TYPE_CHECKING, Any

from twin.api.result import Result
from twin.errors import UsageError
from twin.live.signals.channels import BY_NAME
from twin.num import as_given
from twin.physics.model import Eta_nu, Model
from twin.physics.ship import Ship
from twin.physics.state import WEATHER
from twin.study.prediction.trial import Steer, sail, shaft_speed

if TYPE_CHECKING:
    import matplotlib.axes

COLUMNS = (
    "time_s",
    "north_m",
    "east_m",
    "heading_true_north_deg",
    "surge_velocity_mps",
    "sway_velocity_mps",
    "yaw_rate_degps",
)
FASTEST_SAILED = 4.0  # times the service speed: no model of a hull holds beyond
KNOWN = "straight, zigzag_ANGLE, circle_ANGLE (degrees, such as zigzag_20; a circle to port is circle_-35)"


@dataclass(frozen=True, repr=False)
class Simulation(Result):
    """Where the ship went. Its rows are the samples, by the names and units of the channels."""

    ship: Ship = field(repr=False)

    def _rows(self) -> Any:
        columns = self.data["columns"]
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]

    def __repr__(self) -> str:
        seconds = self.data["columns"]["time_s"][-1]
        return f"<Simulation of {self.ship.name!r}: {self.data['manoeuvre']}, {seconds:.0f} s>"

    def plot(self) -> "matplotlib.axes.Axes":
        """The track over ground, north up [m]."""
        from matplotlib import pyplot

        _, axes = pyplot.subplots()
        c = self.data["columns"]
        axes.plot(c["east_m"], c["north_m"])
        axes.set(xlabel="east [m]", ylabel="north [m]", title=f"{self.ship.name}: {self.data['manoeuvre']}")
        axes.set_aspect("equal", "datalim")
        return axes

    def page(self) -> str:
        """The track as numbers: a small table of every tenth of the way."""
        from twin.report.result_page import PageTable, result_page

        rows = self._rows()
        some = [{k: as_given(v, 5) for k, v in row.items()} for row in rows[:: max(1, len(rows) // 10)]]
        manoeuvre = str(self.data["manoeuvre"])
        said = f"{manoeuvre.replace('_', ' ')}, {as_given(rows[-1]['time_s'])} s."
        return result_page(
            f"{self.ship.name}: simulated",
            said,
            parts=(PageTable("Every tenth of the way", {name: name for name in COLUMNS}, some),),
        )


def simulate(
    ship: Ship, *, manoeuvre: str = "zigzag_20", duration_s: float = 900.0, speed_mps: float | None = None
) -> Simulation:
    """Sail the ship's model from straight ahead in still water, at the shaft speed that keeps `speed_mps`
    (default: service speed).

    `manoeuvre`: straight, zigzag_ANGLE or circle_ANGLE with the angle in degrees (positive: starboard first).
    UsageError when there is no such manoeuvre, no rudder stands at its angle, or duration or speed is not
    positive.
    """
    if not 0.0 < duration_s <= 1e6:
        raise UsageError(f"duration_s = {as_given(duration_s)}: seconds between 0 and 1e6 are needed.")
    speed = float(ship.U_0) if speed_mps is None else speed_mps
    if not 0.0 < speed <= FASTEST_SAILED * ship.U_0:
        most = as_given(FASTEST_SAILED * ship.U_0, 3)
        raise UsageError(
            f"speed_mps = {as_given(speed)}: above 0 and at most {most} m/s is needed, "
            f"{as_given(FASTEST_SAILED)} times the service speed."
        )
    model = Model.of(ship).without_inputs(set(WEATHER))[0]
    log = sail(model, _steer(manoeuvre), shaft_speed(model, speed), duration_s, speed)
    columns: dict[str, list[float]] = {name: [] for name in COLUMNS}
    for t, state in log:
        x, y, psi, u, v, r = map(float, state)
        row = (t, x, y, degrees(psi % (2.0 * pi)), u, v, degrees(r))
        for name, value in zip(COLUMNS, row, strict=True):
            columns[name].append(value)
    data = {"schema_version": 1, "ship": ship.name, "manoeuvre": manoeuvre, "columns": columns}
    return Simulation(ship, data=data)


def _steer(manoeuvre: str) -> Steer:
    """The helmsman: rudder order [rad] by state."""
    found = re.fullmatch(r"(zigzag|circle)_(-?\d+(?:\.\d+)?)", manoeuvre)
    if manoeuvre == "straight":
        return lambda state: 0.0
    if found is None:
        raise UsageError(f"no manoeuvre is called {manoeuvre!r}. Known: {KNOWN}.")
    angle, most = radians(float(found[2])), BY_NAME["rudder_angle_deg"].high
    if abs(float(found[2])) > most:
        raise UsageError(f"{manoeuvre}: a rudder stands at {as_given(most)} deg to either side at most.")
    if found[1] == "circle":
        return lambda state: angle
    if not angle:
        raise UsageError(f"{manoeuvre}: a zigzag needs an angle that is not 0 deg.")
    return _zigzag(angle)


def _zigzag(angle: float) -> Steer:
    """Rudder and heading by the same angle: over when the heading has passed it."""
    side = [1.0]

    def steer(state: Eta_nu) -> float:
        if float(state[2]) * side[0] * (1.0 if angle > 0.0 else -1.0) > abs(angle):
            side[0] = -side[0]
        return angle * side[0]

    return steer
