"""Is the rudder where its feedback says? One that stands still says nothing by itself: a helmsman may hold
his rudder. But then the ship may not turn as if it moved.

    n = N_unexplained / (N of one radian of rudder)
        how far the rudder would have to be elsewhere [rad]

While the feedback stands, n may change by what a wrong model explains: SLACK, a share of the moments at work,
and a greater share of what the feedback's own last movement still does in the filters. More than that, and
the feedback is stuck. A rudder that has not moved for long teaches nothing either way, so learning waits, and
what it taught since it came to stand is taken back (learned_force.py)."""

from math import degrees, radians

from twin.live.observer.dynamics import Forces
from twin.live.observer.operating import propeller_rate
from twin.physics.model import CORE, Model
from twin.physics.ship import Ship
from twin.physics.state import Situation

FEEDBACK_REST_RAD = radians(0.5)  # a feedback within this of where it was has not moved
SLACK = radians(4.0)  # rudder that gusts and the model's errors may look like
# shares of hull's and rudder's moments, and of a movement, that a model may be wrong by
OF_MOMENTS, OF_MOVEMENT = 0.15, 0.4
STANDS = 0.25  # L/U_0 after which it has come to stand
RESTS = 3.0  # L/U_0 after which a rudder that has not moved teaches no more
FADES = 2.5  # L/U_0 until the filters have forgotten what a stuck feedback told them
HULL, RUDDER = CORE.index("hull"), CORE.index("rudder")


class Helm:
    """Fed with each lesson; `stuck` and `resting` say in words what is wrong with the rudder's feedback, ""
    when nothing is."""

    def __init__(self, ship: Ship):
        self.time_s, self.U_0 = ship.L_pp / ship.U_0, ship.U_0
        self.per_rad = self._moment_of_a_radian(ship)
        self.stuck = self.resting = ""
        self._at: float | None = None  # where the feedback stands [rad]
        self._still_s = self._fades_s = 0.0
        # unexplained and rudder's moment as it came to stand, greatest moments since
        self._start = self._moved = self._work = 0.0
        self._low = self._lower = 0.0  # the rudder's moment through the filters of filtered_regression.py

    def feed(self, s: Situation, forces: Forces, unexplained_Nm: float, dt: float) -> bool:
        """One lesson: the rudder as reported, the moments at work, and the yaw moment that nothing explains,
        low-passed twice. True when the rudder has just come to stand."""
        delta, rudder = float(s.delta), float(forces[RUDDER][2])
        a = min(2.0 * dt / self.time_s, 0.5)
        self._low += a * (rudder - self._low)
        self._lower += a * (self._low - self._lower)
        if self._at is None or abs(delta - self._at) > FEEDBACK_REST_RAD:
            self._moves(delta, unexplained_Nm)
            return False
        if self._fades_s > 0.0:
            self._forgets(unexplained_Nm, dt)
            return False
        before_s, self._still_s = self._still_s, self._still_s + dt
        self._stands(s, forces, unexplained_Nm)
        return before_s < STANDS * self.time_s <= self._still_s

    def pause(self) -> None:
        """The measurements have a hole: begin again."""
        self._at = None

    def _moves(self, delta: float, unexplained_Nm: float) -> None:
        self._at, self._still_s, self.resting = delta, 0.0, ""
        self._start, self._moved, self._work = unexplained_Nm, self._lower, 0.0
        if self.stuck and not self._fades_s:
            self._fades_s = FADES * self.time_s

    def _forgets(self, unexplained_Nm: float, dt: float) -> None:
        """It moves again: nothing is judged until the filters have forgotten."""
        self._start, self._fades_s = unexplained_Nm, max(self._fades_s - dt, 0.0)
        if not self._fades_s:
            self.stuck = ""

    def _stands(self, s: Situation, forces: Forces, unexplained_Nm: float) -> None:
        self._work = max(self._work, abs(forces[HULL][2]) + abs(forces[RUDDER][2]))
        moment = self.per_rad * max((float(s.u) / self.U_0) ** 2, 0.1)
        allowed = SLACK * moment + OF_MOMENTS * self._work + OF_MOVEMENT * abs(self._lower - self._moved)
        said = degrees(self._at or 0.0)
        if abs(unexplained_Nm - self._start) > allowed:
            self.stuck = f"rudder_angle_deg stays at {said:.1f} while it turns as if it moved"
        if self._still_s > RESTS * self.time_s:
            self.resting = (
                f"rudder_angle_deg has stayed at {said:.1f} for {RESTS * self.time_s:.0f} s: "
                "nothing is learned until it moves"
            )

    @staticmethod
    def _moment_of_a_radian(ship: Ship) -> float:
        """[N m] at service speed, straight ahead."""
        model, angle = Model(ship, ()), 0.1  # the core alone: nothing is measured yet
        forces = model.forces(
            Situation(u=model.loaded.U_0, n=propeller_rate(model), delta=angle), model.water(Situation())
        )
        return abs(float(forces[RUDDER][2])) / angle


class NoHelm:
    """Of a ship of actuators: which of them does not do what it says, one moment cannot tell."""

    stuck = resting = ""

    def feed(self, s: Situation, forces: Forces, unexplained_Nm: float, dt: float) -> bool:
        """Nothing is judged; False."""
        return False

    def pause(self) -> None:
        """Nothing was begun."""


def helm_of(ship: Ship) -> Helm | NoHelm:
    """Who doubts the rudder's feedback."""
    return NoHelm() if ship.actuators else Helm(ship)
