"""How much may be believed: the ladder of modes, each step down with its reasons in words. What was lost
counts again as soon as it is heard; the learned force, after a fault of its own, only after a while.

    hybrid -> physics only -> dead reckoning -> invalid          ("starting" before the first estimate)
"""

from collections.abc import Sequence
from typing import NamedTuple

from twin.live.gates.plausible import Plausibility
from twin.live.learning.learned_force import Learned, LearnedForce
from twin.live.observer.controls import ONE_SCREW, controls_of
from twin.live.observer.estimate import Estimate
from twin.live.signals.channels import BY_NAME, CHANNELS
from twin.live.signals.measured import Measured
from twin.num import as_given
from twin.physics.ship import Ship

STARTING, HYBRID, PHYSICS, RECKONING, INVALID = (
    "starting",
    "hybrid",
    "physics only",
    "dead reckoning",
    "invalid",
)
CONTROLS = ONE_SCREW
BY_ATTRIBUTE = {c.attribute: c for c in CHANNELS}
WORSE, BETTER = 1.1, 0.9  # error with the learned force over the error without: off above, on again below
CLIPPED_SHARE = 0.5
NO_HEADING = "no heading"


class Verdict(NamedTuple):
    """The mode, why it is not better, whether the learned force acts, why learning stands still, and what the
    instruments contradict each other in ("" when they do not)."""

    mode: str
    reasons: list[str]
    use_learned: bool
    frozen: str
    odd: str = ""


class LatchedFault:
    """A fault counts at once, and until it was gone for `hold_s`."""

    def __init__(self, hold_s: float):
        self.hold_s = hold_s
        self.why = ""
        self._last_s = -1e18

    def feed(self, why: str, now_s: float) -> str:
        """What is wrong now ("": nothing) at `now_s` [s]; returns what counts, for `hold_s` after it
        ended."""
        if why:
            self.why, self._last_s = why, now_s
        elif now_s - self._last_s >= self.hold_s:
            self.why = ""
        return self.why


class Guard:
    """Judges each tick."""

    def __init__(
        self,
        ship: Ship,
        learned: LearnedForce,
        reckoning_s: float = 60.0,
        hold_s: float = 0.0,
        period_s: float = 0.1,
    ):
        T = ship.L_pp / ship.U_0
        # how long the model may run without measurements before nothing is promised
        self.reckoning_s = reckoning_s
        self.learned = learned
        self.controls = controls_of(ship)
        self._counting = "heading", "surge", "sway", "yaw", *self.controls.values()
        self.plausible = Plausibility(ship, period_s)
        hold_s = hold_s or 3.0 * T
        self._worse = LatchedFault(hold_s)
        self._broken = LatchedFault(hold_s)
        self._bound = LatchedFault(hold_s)
        self._clipped = LatchedFault(hold_s)
        self._doubted = LatchedFault(hold_s)
        self._clipped_share = 0.0
        self._bad = self._outside = self._unproved = ""
        self._reckoning_since: float | None = None
        self._announced: list[tuple[float, str]] = []

    def judge(
        self,
        measured: Measured,
        estimate: Estimate,
        sensors: list[str],
        dt: float,
        doubts: Sequence[str] = (),
    ) -> Verdict:
        """The verdict of this tick; `sensors`: what is wrong with the channels, `doubts`: which of them
        contradict each other, in words."""
        self.plausible.feed(measured, dt)
        self._announce(measured)
        odd = self.plausible.reasons()
        odd += [self.learned.helm.stuck] * bool(self.learned.helm.stuck)
        odd += doubts
        said = [text for _, text in self._announced] + sensors + odd
        if not estimate.ready:
            return Verdict(
                STARTING, [_waiting(measured), *said], False, "no estimate yet", next(iter(odd), "")
            )
        off = self._off(measured.now_s, next(iter(doubts), ""))
        lost = _lost(measured, self.controls)
        if lost == NO_HEADING and "psi" in measured.derived:
            self._reckoning_since = None
            carried = f"{lost} from the compass: gyro and course carry it"
            return Verdict(RECKONING, [carried, *off, *said], not off, lost, next(iter(odd), ""))
        if lost:
            return self._reckon(measured.now_s, lost, off, said)._replace(odd=next(iter(odd), ""))
        self._reckoning_since = None
        frozen = odd[0] if odd else next((text for text in sensors if text.startswith(self._counting)), "")
        return Verdict(
            PHYSICS if off else HYBRID,
            [*off, *([self._outside] if self._outside else []), *said],
            not off,
            frozen,
            next(iter(odd), ""),
        )

    def note(self, learned: Learned, dt: float, unproved: str = "") -> None:
        """How the learned force came out in this tick, and what broke the certificate in the last one; it
        counts in the next."""
        self._unproved = unproved
        share = min(dt / 10.0, 0.5)
        self._clipped_share += share * (learned.clipped - self._clipped_share)
        self._bad = learned.why if learned.weight == 0.0 and learned.why and not any(learned.shadow) else ""
        self._outside = f"learned force shrunk: {learned.why}" if learned.why and any(learned.shadow) else ""

    def _off(self, now_s: float, doubt: str) -> list[str]:
        """Why the learned force may not act; `doubt`: which instruments contradict each other."""
        evidence = self.learned.evidence
        if self.learned.residual is None:
            return [f"no learned force: {self.learned.why_not}"]
        limit = BETTER if self._worse.why else WORSE
        worse = evidence.judged and evidence.with_learned > limit * evidence.without
        broken = "gives" in self._bad or "failed" in self._bad or "absurd" in self._bad
        reasons = [
            self._worse.feed(
                "the learned force made it worse than the physics alone" if worse else "", now_s
            ),
            self._broken.feed(self._bad if broken else "", now_s),
            self._clipped.feed(
                "the learned force stays at its bound" if self._clipped_share > CLIPPED_SHARE else "", now_s
            ),
            self._bad if not broken else "",
            self._bound.feed(self._unproved, now_s),
            self._doubted.feed(doubt, now_s),
        ]
        return [f"learned force off: {why}" for why in reasons if why]

    def _reckon(self, now_s: float, lost: str, off: list[str], said: list[str]) -> Verdict:
        if self._reckoning_since is None:
            self._reckoning_since = now_s
        for_s = now_s - self._reckoning_since
        mode = INVALID if for_s > self.reckoning_s else RECKONING
        alone = f"{lost}, for {for_s:.0f} s; the model runs on alone"
        return Verdict(mode, [alone, *off, *said], mode == RECKONING and not off, lost)

    def _announce(self, measured: Measured) -> None:
        now_s = measured.now_s
        for attribute, step in measured.steps.items():
            channel = BY_ATTRIBUTE.get(attribute) or BY_NAME[self.controls[attribute]]
            by = as_given(step / channel.to_si, 4)
            self._announced.append(
                (now_s, f"{channel.name} stepped by {by} and stayed: the new value is believed")
            )
        if measured.clock_step_s:
            self._announced.append(
                (now_s, f"the wall clock was set by {measured.clock_step_s:+.1f} s; the state is not touched")
            )
        self._announced = [(t, text) for t, text in self._announced if now_s - t < 10.0][-8:]


def _waiting(measured: Measured) -> str:
    needs = [] if "psi" in measured.si else ["heading"]
    if not any(a in measured.si for a in ("x", "u", "u_r")):
        needs.append("position or speed")
    return f"waiting for {' and '.join(needs) or 'the next sample'}"


def _lost(measured: Measured, controls: dict[str, str]) -> str:
    """What is missing that only the model can stand in for; "" when nothing essential is."""
    si = measured.si
    missing = [name for a, name in controls.items() if a not in si]
    if "psi" not in si or "psi" in measured.derived:
        missing.append("heading")
    if not any(a in si for a in ("x", "u", "u_r")):
        missing.append("position and speed")
    return f"no {', no '.join(missing)}" if missing else ""
