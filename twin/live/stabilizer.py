"""The stabilizer: what is certified of the observer's stability, tick by tick. It steers nothing; it follows
the bound of the observer's error and says whether the assumptions of its proof hold now
(docs/stability.md)."""

from math import copysign, degrees, hypot, pi

from twin.live.certificate.observer_tube import NO_PULL, NONE, NU, Tube
from twin.live.certificate.periods import TOO_LONG
from twin.live.certificate.rolled_tube import RolledTube
from twin.live.contradiction import Contradiction, contradicted
from twin.live.guard import CONTROLS
from twin.live.left_open import Bounds, LeftOpen, least
from twin.live.observer.observer import Observer
from twin.live.observer.rollback import RollBack
from twin.live.parity import Parity
from twin.live.seen import Certified
from twin.live.signals.measured import Measured
from twin.num import num
from twin.physics.state import Situation

NEEDED = {**CONTROLS, "psi": "heading"}  # inputs of the physics that nothing stands in for
# the bound goes on as for calm water, to be held against the measurements; it is not promised
NO_WAVES = "no wave height"
NO_ESTIMATE = "no estimate yet"
USELESS = 1e3  # m/s: a bound above every speed at sea


class Stabilizer:
    """Steps the tube once a tick; without a certificate it promises nothing, and says so by `inside` being
    false. Where it may have left the operating set the tube begins anew from what is measured, and promises
    again once all that a late measurement looks back on is inside. Till then a measurement counts only by
    what it leaves open by itself, and that is carried on: one sample in many ticks suffices."""

    def __init__(self, tube: Tube | None = None, why_not: str = "", authority_margin: float = 0.0):
        self.tube, self.why_not, self._authority = tube, why_not, authority_margin
        self.promises = tube is not None and tube.certificate.ok
        self._step_margin = tube.certificate.step_margin if tube else 0.0
        self._parity = Parity(tube.certificate.heading_noise) if tube else None
        self._restarts = -1
        self._seaway = False  # whether a wave height is known
        self._inside = 0  # ticks that it has surely been in the set
        self._inside_s = 0.0  # since when
        self._since_late_s = float("inf")  # seconds for which every tick came in time
        self._watched = tuple([Contradiction() for _ in NU])
        self.broken = ""  # what shows that the promise's conditions do not hold
        self._heard: set[str] = set()  # which of u, v, r an instrument of its own has measured so far
        self._guessed: tuple[str, ...] = NU  # whose bound rests on no measurement, but on what a ship can do
        self.outside: str | None = why_not  # why nothing is promised in this tick; None: it is

    @property
    def gain(self) -> float:
        """The K of the certificate [1/s], 0 without one."""
        return self.tube.certificate.K[0] if self.tube else 0.0

    def step(
        self,
        observer: Observer,
        measured: Measured,
        s: Situation,
        dt: float | None = None,
        doubt: str = "",
        acts: bool = True,
    ) -> Certified:
        """The bound of this tick, dt seconds after the last (None: a period); `doubt`: what is known to be
        wrong with the instruments or with an input of the physics, in words; `acts`: whether a learned force
        does."""
        tube = self.tube
        if tube is None or not observer.estimate.ready:
            margin = tube.certificate.margin if tube else 0.0
            self.outside = self.why_not or (NO_ESTIMATE if tube else "")
            return Certified(margin=margin, authority_margin=self._authority)
        dt = tube.certificate.h if dt is None else dt
        if observer.restarts != self._restarts:
            self._begin(observer, measured, tube)
        late = self._clocked(dt, tube)
        open_ = LeftOpen(observer, measured, tube, self._since_late_s, self._inside_for_s(measured.now_s))
        self._steps(observer, measured, tube, open_, dt, acts)
        if ("H_s" in measured.si) is not self._seaway:  # till now the noise was that of another sea
            self._seaway, self._inside = "H_s" in measured.si, 0
            tube.reset(*open_.bounds)
        certificate, known = tube.certificate, self._known(observer, open_, tube)
        if not self._inside:
            self._guessed = tuple(a for a in NU if not open_.known(a))
        proven = self._proven(tube)
        within = least((tube.beta, tube.psi), known) if proven else known
        apart = self._apart(observer, measured, tube, dt)
        left = tube.outside(s, within[0], dt, proven)
        # whether only the way to now may have left it
        again = left is not None and proven and tube.outside(s, open_.bounds[0], dt, False) is None
        wrong = late or doubt or apart or _unsure(measured)
        self.outside = wrong or (left and open_.unknown(self._guessed, self._heard)) or left
        self._count(measured.now_s, again and not wrong)
        if proven := self._proven(tube):
            tube.know(*known)
            if nothing := tube.says_nothing():  # what is known says more
                tube.reset(*least((tube.beta, tube.psi), known))
                nothing = tube.says_nothing()
            self.outside = nothing or self.broken or ("" if "H_s" in measured.si else NO_WAVES) or None
        else:
            tube.reset(*(known if self._inside > 1 else open_.bounds))
            nothing = tube.says_nothing()
            self.outside = self.outside or self.broken or nothing or self._waits(tube)
        if not self.promises:
            self.outside = self.why_not
        if nothing:  # with measurements it comes back by itself
            return Certified(
                certificate.margin, USELESS, False, degrees(pi), self._step_margin, self._authority
            )
        inside = self.promises and proven and self.outside is None
        return Certified(
            certificate.margin,
            hypot(tube.beta[0], tube.beta[1]),
            inside,
            degrees(tube.beta[2]),
            self._step_margin,
            self._authority,
        )

    def _apart(self, observer: Observer, measured: Measured, tube: Tube, dt: float) -> str:
        if self._parity is None:
            return ""
        self._parity.heading_noise = tube.heading_noise
        return self._parity.feed(measured, observer.estimate, tube.beta, dt)

    def _begin(self, observer: Observer, measured: Measured, tube: Tube) -> None:
        """The observer was set to what is measured: in waves, by instruments that move with them."""
        tube.under(measured.si.get("H_s", 0.0), True)
        open_ = LeftOpen(observer, measured, tube, self._since_late_s, 0.0)
        tube.reset(*open_.bounds)
        self._guessed = tuple(a for a in NU if not open_.known(a))
        self._restarts, self._inside = observer.restarts, tube.window
        self._inside_s = measured.now_s
        self._seaway = "H_s" in measured.si
        if self._parity:
            self._parity.begin()

    def _proven(self, tube: Tube) -> bool:
        """Whether the tube's bound rests only on what was surely inside."""
        return self._inside >= tube.window and tube.rests_on(self._inside_s)

    def _inside_for_s(self, now_s: float) -> float:
        return now_s - self._inside_s if self._inside else 0.0

    def _known(self, observer: Observer, open_: LeftOpen, tube: Tube) -> Bounds:
        """What bounds the error even while a late measurement may still look back outside: what the
        instruments leave open, or what was known in the last tick carried on, if it was inside there."""
        if not self._inside:
            return open_.bounds
        pulled = observer.pulled
        carried = tube.carried((pulled["u"], pulled["v"], pulled["r"]), pulled["psi"], self._inside_s)
        return least(open_.bounds, carried)

    def _count(self, now_s: float, again: bool) -> None:
        """For how long it has surely been inside (`again`: from now on); a bound that was contradicted begins
        anew afterwards."""
        was = self.broken
        self.broken = contradicted(NU, self._watched, now_s) if self.promises else ""
        if self.outside is not None or (was and not self.broken):
            self._inside = 0
        if self.outside is None or again:
            self._inside += 1
        if self._inside == 1:
            self._inside_s = now_s

    def _waits(self, tube: Tube) -> str:
        """What the promise waits for while nothing is wrong any more, and for how long [s] if nothing comes
        between."""
        for_s = max(tube.window - self._inside, 1) * tube.certificate.h
        return (
            "all is well again; the promise waits until no late measurement can look back to when it was "
            f"not, wait = {num(for_s, 2)} s"
        )

    def _clocked(self, dt: float, tube: Tube) -> str:
        """Remembers when a tick last came late; in words, when it came so late that nothing can be said of
        it."""
        count = tube.periods.count(dt)
        self._since_late_s = self._since_late_s + dt if count == 1 else 0.0
        if count != TOO_LONG:
            return ""
        return (
            f"the tick came late, after = {num(dt, 2)} s where {num(tube.certificate.h, 2)} s are certified"
        )

    def _steps(
        self,
        observer: Observer,
        measured: Measured,
        tube: Tube,
        open_: LeftOpen,
        dt: float,
        acts: bool,
    ) -> None:
        got = tuple([observer.received[a] and open_.in_time(a) for a in NU])
        if len(self._heard) < len(NU):
            self._heard |= {a for a in NU if a in measured.si and a not in measured.derived}
        if self._guessed:
            self._guessed = tuple(a for a in self._guessed if not open_.known(a))
        sea = measured.si.get("H_s", 0.0)
        if isinstance(tube, RolledTube) and isinstance(observer, RollBack):
            if suspected := any(test.suspects for test in self._watched):
                u, v, r = self._watched
                tube.distrusted = u.suspects, v.suspects, r.suspects
            tube.follow(observer.path, sea, acts)
            if suspected:
                tube.distrusted = NONE
        else:
            heading = observer.received["psi"] and open_.in_time("psi")
            in_time = self._since_late_s > 0.0
            pulled = tuple(
                [0.0 if g and in_time else observer.pulled[a] for a, g in zip(NU, got, strict=True)]
            )
            tube.step(
                got,  # type: ignore[arg-type]
                sea,
                pulled if any(pulled) else NO_PULL,  # type: ignore[arg-type]
                dt,
                acts,
                heading,
                observer.pulled["psi"],
            )
        self._watch(observer, measured, got, tube, open_)

    def _watch(
        self,
        observer: Observer,
        measured: Measured,
        got: tuple[bool, ...],
        tube: Tube,
        open_: LeftOpen,
    ) -> None:
        """Whether samples lie farther from the estimate than bound and noise allow."""
        rolled = isinstance(tube, RolledTube)
        uncounted = tube.uncounted if isinstance(tube, RolledTube) else NO_PULL
        for test, axis, accepted, most, noise, moved in zip(
            self._watched, NU, got, tube.widest, tube.noise, uncounted, strict=True
        ):
            gap = observer.innovation.get(axis, 0.0)
            test.feed(gap, most, noise, accepted)
            if axis in measured.fresh and open_.in_time(axis):
                test.fresh(gap, most, noise, measured.now_s, copysign(moved, gap))
            if rolled and test.suspects:
                open_.distrust(axis)


def _unsure(measured: Measured) -> str:
    """Why the physics may not be asked in this tick, or what the estimate was set to; "" when nothing is."""
    if missing := next((name for a, name in NEEDED.items() if a not in measured.si), ""):
        return f"no {missing}"
    return next((f"{a} stepped and is believed" for a in NU if a in measured.steps), "")
