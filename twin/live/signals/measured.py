"""What may be believed now, in the units of physics."""

from dataclasses import dataclass, field

Numbers = dict[str, float]


@dataclass(slots=True)
class Measured:
    """SI values by attribute of physics; an attribute that is not in `si` is not measured.

    `fresh`: those with a new sample in this tick, and the time since the one before [s]; `steps`: those that
    were reset because a step lasted, and by how much; `derived`: those that no instrument measured itself.
    """

    now_s: float
    si: Numbers = field(default_factory=dict)
    fresh: Numbers = field(default_factory=dict)
    steps: Numbers = field(default_factory=dict)
    derived: set[str] = field(default_factory=set)
    time: Numbers = field(default_factory=dict)  # when it was measured [s, monotonic]
    heard: Numbers = field(default_factory=dict)  # when it arrived
    hold_s: Numbers = field(default_factory=dict)  # how long after that the next sample is due
    weights: Numbers = field(default_factory=dict)  # of what is noisier than usual, below 1
    border: Numbers = field(default_factory=dict)  # by channel, border units: what is logged and shown
    taken: Numbers = field(default_factory=dict)  # by channel, when it was measured
    clock_step_s: float = 0.0

    def at(self, now_s: float, fresh: Numbers, steps: Numbers, clock_step_s: float) -> "Measured":
        """A copy for one tick; `si` and `derived` are its own."""
        return Measured(
            now_s,
            dict(self.si),
            fresh,
            steps,
            set(),
            self.time,
            self.heard,
            self.hold_s,
            self.weights,
            self.border,
            self.taken,
            clock_step_s,
        )

    def has(self, *attributes: str) -> bool:
        """Whether all of these are measured now."""
        return all(a in self.si for a in attributes)

    def age_s(self, attribute: str) -> float:
        """How old a measurement is [s]."""
        return self.now_s - self.time[attribute]

    def age_by_channel(self) -> Numbers:
        """How old each channel's sample is [s]."""
        now_s = self.now_s
        return {name: now_s - t for name, t in self.taken.items()}

    def derive(self, attribute: str, value: float, of: str) -> None:
        """A value that follows from what another attribute measures."""
        if not self.derived:
            self.time, self.heard, self.hold_s = dict(self.time), dict(self.heard), dict(self.hold_s)
            self.weights = dict(self.weights)
        self.si[attribute] = value
        self.derived.add(attribute)
        self.time[attribute], self.heard[attribute], self.hold_s[attribute] = (
            self.time[of],
            self.heard[of],
            self.hold_s[of],
        )
        if of in self.weights:
            self.weights[attribute] = self.weights[of]
        if of in self.fresh:
            self.fresh[attribute] = self.fresh[of]
