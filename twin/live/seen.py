"""What one tick knew: for the wide record, and for those who look on."""

from collections.abc import Sequence
from typing import NamedTuple

from twin.live.clock import Instant
from twin.live.guard import Verdict
from twin.live.learning.adapted_row import Parameter
from twin.live.learning.learned_force import Learned
from twin.live.observer.dynamics import KnownDynamics
from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import Prediction
from twin.live.signals.measured import Measured
from twin.physics.core import Tau
from twin.physics.state import Situation


class Certified(NamedTuple):
    """The certificate's margin, the live bound of the observer's error in speed [m/s], and whether it holds
    now; the bound in rate of turn, and the share of an error that one sample surely takes away: 0 when none
    does."""

    margin: float = 0.0
    bound: float = 0.0
    inside: bool = False
    yaw_bound_degps: float = 0.0
    step_margin: float = 0.0
    authority_margin: float = 0.0  # of the rudder against what the bounds leave open (authority.py)


class Seen(NamedTuple):
    """What the lines of one tick found, in their order."""

    instant: Instant
    measured: Measured
    estimate: Estimate
    situation: Situation
    physics: KnownDynamics
    forces: Sequence[Tau]  # known ones, in the order of physics.names
    verdict: Verdict
    learned: Learned
    ahead: Sequence[Prediction]
    certified: Certified


class Pace(NamedTuple):
    """How the loop keeps time."""

    rate_hz: float
    overruns: int = 0  # periods skipped since start
    slack_us: float | None = None  # time that was left when the tick before was done; absent in a replay
    step_us: float | None = None  # what the tick before took


class Standing(NamedTuple):
    """What goes on from tick to tick, as it stands after this one."""

    pace: Pace
    reasons: list[str]  # why the mode is not better, and every alarm
    quality: dict[str, int]  # by channel
    share: float  # the learned force's part of all force
    parameters: Sequence[Parameter]
    rejected: int  # samples since start
    log_dropped: int  # messages since start
