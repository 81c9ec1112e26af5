"""What a decision is made from: named, dimensionless facts about one diagnosis, each computed once
(consider.py).

A log Bayes factor is the natural logarithm of how many times more probable the voyages are under one
hypothesis than under another, tempered as all evidence here (nuisance.temper_of). An error ratio is an
open-loop position error after the horizon over the error that is expected of this calibrated ship when the
hypothesis is true. The rules that read the facts: decision.py.
"""

from dataclasses import asdict, dataclass
from typing import Any

from twin.study.diagnosis.criteria import LOST


@dataclass(frozen=True)
class Cause:
    """Facts about one effect of the explanation, or of the likeliest hypothesis."""

    effect: str
    belongs_to: str  # whose is it? ship, instrument or voyage
    in_explanation: bool  # is it a part of the explanation?
    in_ship_file: bool  # does the model have it already, so that a change of it is asked?
    # is it the force of a sea that the model lacks, which comes and goes with what no input shows?
    sea_force: bool
    probability: float  # how probable is it among all that was weighed? [1]
    with_rivals: float  # how probable is it, or one that these voyages cannot tell from it? [1]
    log_bayes_factor: float  # how much likelier is the best hypothesis with it than without? [log odds]
    alone: float  # how much likelier is it alone than nothing? [log odds]
    error_gain: float | None  # share by which the open-loop error is less with it; None: not asked [1]
    significance: float  # how far are its numbers together from none? [standard deviations of one]
    change: float  # how far is its clearest number from the ship's file, over what its form may miss? [1]
    # share of the reference voyages whose kinematics are as far from the others' as these voyages' are from
    # theirs; None: kinematics cannot tell its size from none, or were not asked [1]
    reached: float | None = None
    # how probable is it that its size varies within a voyage, although it belongs to the ship? [1]
    varies: float = 0.0


@dataclass(frozen=True)
class Left:
    """Facts about what one set of effects leaves over."""

    error: float | None  # open-loop error over the expected one; None: so unlikely that nobody asked [1]
    share: float | None  # open-loop error over that with the day's weather alone [1]
    restless: float  # how much likelier are more unmodelled dynamics than on references? [log Bayes factor]


@dataclass(frozen=True)
class Facts:
    """Facts about the whole of one diagnosis. The explanation is the likeliest hypothesis, or a part of it
    as likely that leaves less."""

    nothing: float  # how probable is it that no cause is missing, whatever the weather? [1]
    unknown: float  # how probable is it that something is at work that has no name? [1]
    likeliest: tuple[str, ...]  # effects of the likeliest hypothesis
    explanation: tuple[str, ...]  # effects of the explanation
    left: Left  # what the explanation leaves over
    error_nothing: (
        float  # open-loop error of the model with the day's weather alone, over the expected one [1]
    )
    error_best: float | None  # that of the likeliest hypothesis over its expected one [1]
    manoeuvre: bool  # does one of the voyages hold a manoeuvre?
    power: float  # share of the causes of ship and instruments that would have shown at a plausible size [1]
    structural: tuple[
        float, float, float
    ]  # what calibration left unexplained of the forces at work, in surge, sway, yaw [1]
    noise: tuple[float, float, float]  # fast noise over that on the references, in surge, sway, yaw [1]
    scatter: float  # scatter of the readings over that on the references [1]
    sea: bool  # was a sea measured that may move the ship?
    rough: float  # share of the expected error that is due to forces known only roughly [1]
    transient: float  # how much likelier has one stretch a push of its own? [log Bayes factor; 0: none]
    in_waves: bool  # did waves toss the ship there?
    resembles: tuple[str, ...]  # what is known by its form alone, and is likely
    one_of: tuple[str, ...]  # the fewest effects of which one is surely there
    causes: tuple[Cause, ...]  # the likeliest first
    weather: tuple[
        Cause, ...
    ]  # water and weather of these voyages that is likely and that the model lacks, or has otherwise
    as_before: tuple[str, ...]  # water and weather that the references had as much of
    # share of the reference voyages, each left out in turn, that a single cause explains as much; None: the
    # ship file lacks their scores [1]
    reached: float | None = None
    # how probable is it that the force of the explanation's causes that belong to the ship comes and goes,
    # and does not last? [1]
    comes_and_goes: float = 0.0

    def lasts(self, c: Cause) -> float:
        """How probable it is that a cause that is there acts all the time, as what belongs to the ship does.
        (What is not likelier than not to vary has shown no more than the odds beforehand.) [1]"""
        varies = c.varies if c.varies >= LOST else 0.0
        return 1.0 - max(self.comes_and_goes, varies) if c.belongs_to == "ship" else 1.0

    def as_json(self) -> dict[str, Any]:
        """As JSON has them."""
        return asdict(self)

    @staticmethod
    def read(told: dict[str, Any]) -> "Facts":
        """From JSON."""
        lists = {k: tuple(v) for k, v in told.items() if isinstance(v, list)}
        return Facts(
            **{
                **told,
                **lists,
                "left": Left(**told["left"]),
                **{k: tuple(Cause(**c) for c in told[k]) for k in ("causes", "weather")},
            }
        )
