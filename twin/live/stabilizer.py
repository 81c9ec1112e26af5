"""The stabilizer: what is certified of the observer's stability, tick by tick. It steers nothing; it follows
the bound of the observer's error and says whether the assumptions of its proof hold now
(docs/stability.md)."""

from math import degrees, hypot, pi

from twin.live.certificate.observer_tube import NO_PULL, Three, Tube
from twin.live.certificate.periods import TOO_LONG
from twin.live.certificate.rolled_tube import RolledTube
from twin.live.guard import CONTROLS
from twin.live.observer.observer import Observer
from twin.live.observer.operating import WORDS
from twin.live.observer.rollback import RollBack
from twin.live.parity import Parity
from twin.live.seen import Certified
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.num import num
from twin.physics.state import Situation

NU = ("u", "v", "r")
NEEDED = {**CONTROLS, "psi": "heading"}  # inputs of the physics that nothing stands in for
# the bound goes on as for calm water, to be held against the measurements; it is not promised
NO_WAVES = "no wave height"
MEMORY = 100.0  # ticks with a measurement over which it is counted how often they contradict the bound
SURPRISED = 0.1  # share of them from which it does not hold

USELESS = 1e3  # m/s: a bound above every speed at sea


class Stabilizer:
    """Steps the tube once a tick; without a certificate it promises nothing, and says so by `inside` being
    false. Where it may have left the operating set the tube begins anew from what is measured, and promises
    again once all that a late measurement looks back on is inside."""

    def __init__(
        self, tube: Tube | None = None, why_not: str = "no certificate", authority_margin: float = 0.0
    ):
        self.tube, self.why_not, self._authority = tube, why_not, authority_margin
        self.promises = tube is not None and tube.certificate.ok
        self._step_margin = tube.certificate.step_margin if tube else 0.0
        self._parity = Parity(tube.certificate.heading_noise) if tube else None
        self._restarts = -1
        self._seaway = False  # whether a wave height is known
        self._inside = 0  # ticks that it has surely been in the set
        self._since_late_s = float("inf")  # seconds for which every tick came in time
        self._surprised = dict.fromkeys(NU, 0.0)
        self._heard: set[str] = set()  # which of u, v, r an instrument of its own has measured so far
        self._guessed: tuple[str, ...] = NU  # whose bound rests on no measurement, but on what a ship can do
        self.outside: str | None = why_not

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
            return Certified(margin=margin, authority_margin=self._authority)
        dt = tube.certificate.h if dt is None else dt
        if observer.restarts != self._restarts:
            self._begin(observer, measured, tube)
        late = self._clocked(dt, tube)
        self._steps(observer, measured, tube, dt, acts)
        if ("H_s" in measured.si) is not self._seaway:  # till now the noise was that of another sea
            self._seaway, self._inside = "H_s" in measured.si, 0
            tube.reset(self._first(observer, measured, tube), self._heading(observer, measured, tube))
        certificate, first = tube.certificate, self._first(observer, measured, tube)
        within = min(tube.beta[0], first[0]), min(tube.beta[1], first[1]), min(tube.beta[2], first[2])
        apart = self._apart(observer, measured, tube, dt)
        left = tube.outside(s, within, dt)
        self.outside = (
            late or doubt or apart or _unsure(measured) or (left and self._unknown(measured, tube)) or left
        )
        self._inside = self._inside + 1 if self.outside is None else 0
        if proven := self._inside >= tube.window:
            self.outside = (
                tube.says_nothing() or self.broken or ("" if "H_s" in measured.si else NO_WAVES) or None
            )
        else:
            tube.reset(first, self._heading(observer, measured, tube))
            self._guessed = tuple(a for a in NU if not self._in_time(a, measured, tube))
        if tube.says_nothing():  # with measurements it comes back by itself
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
        """The observer was set to what is measured."""
        tube.reset(self._first(observer, measured, tube), self._heading(observer, measured, tube))
        self._restarts, self._inside = observer.restarts, tube.window
        self._seaway = "H_s" in measured.si
        if self._parity:
            self._parity.begin()

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

    def _steps(self, observer: Observer, measured: Measured, tube: Tube, dt: float, acts: bool) -> None:
        got = tuple([observer.received[a] and self._in_time(a, measured, tube) for a in NU])
        self._watch(observer, got, tube)
        self._heard |= {a for a in NU if a in measured.si and a not in measured.derived}
        self._guessed = tuple(a for a in self._guessed if not self._in_time(a, measured, tube))
        sea = measured.si.get("H_s", 0.0)
        if isinstance(tube, RolledTube) and isinstance(observer, RollBack):
            tube.follow(observer.path, sea, acts)
            return
        heading = observer.received["psi"] and self._in_time("psi", measured, tube)
        in_time = self._since_late_s > 0.0
        pulled = tuple([0.0 if g and in_time else observer.pulled[a] for a, g in zip(NU, got, strict=True)])
        tube.step(got, sea, pulled if any(pulled) else NO_PULL, dt, acts, heading, observer.pulled["psi"])  # type: ignore[arg-type]

    @property
    def broken(self) -> str:
        """What shows that the promise's conditions do not hold; "" when nothing does, or nothing was
        promised."""
        if self.tube is None or not self.tube.certificate.ok:
            return ""
        axis = next((a for a, share in self._surprised.items() if share > SURPRISED), "")
        return f"{axis} is measured farther from the estimate than its bound allows" if axis else ""

    def _watch(self, observer: Observer, got: tuple[bool, ...], tube: Tube) -> None:
        """How often an accepted sample lies farther from the estimate than bound and noise allow: one in many
        may, a row of them tells of a larger disturbance or a worse sensor than was assumed."""
        for axis, accepted, most, noise in zip(NU, got, tube.widest, tube.noise, strict=True):
            if accepted:
                off = abs(observer.innovation[axis]) > most + noise
                self._surprised[axis] += (off - self._surprised[axis]) / MEMORY

    def _first(self, observer: Observer, measured: Measured, tube: Tube) -> Three:
        """What the estimate is off by at most, asking the instruments alone: how far it lies from what was
        measured, its noise and its way since; where nothing was, all that a ship can."""
        e = observer.estimate
        u, v, r = (
            abs(measured.si[a] - now) + noise + measured.age_s(a) * way
            if self._in_time(a, measured, tube)
            else 2.0 * most
            for a, now, noise, way, most in zip(
                NU, (e.u, e.v, e.r), tube.noise, tube.way, observer.most, strict=True
            )
        )
        return u, v, r

    def _heading(self, observer: Observer, measured: Measured, tube: Tube) -> float:
        """The same of the heading [rad]."""
        if not self._in_time("psi", measured, tube):
            return pi
        off = abs(turn(measured.si["psi"] - observer.estimate.psi))
        return off + tube.heading_noise + measured.age_s("psi") * observer.most[2]

    def _unknown(self, measured: Measured, tube: Tube) -> str:
        """Which speed or rate of turn the observer's bound knows nothing of, and why; "" when each has been
        measured since the bound began."""
        if not self._guessed:
            return ""
        a = self._guessed[0]
        name, old_s = WORDS[a], min(tube.oldest_s, self._since_late_s)
        if a not in self._heard:
            return f"{name} is not measured yet"
        if a not in measured.si or a in measured.derived:
            return f"{name} is not measured"
        return (
            f"{name} is not measured often enough, age = {num(measured.age_s(a), 2)} s where at most "
            f"{num(old_s, 2)} s are certified"
        )

    def _in_time(self, attribute: str, measured: Measured, tube: Tube) -> bool:
        """Measured by its own instrument, not older than the certificate allows, and not from before a late
        tick."""
        if attribute in measured.derived or attribute not in measured.si:
            return False
        return measured.age_s(attribute) <= min(tube.oldest_s, self._since_late_s)


def _unsure(measured: Measured) -> str:
    """Why the physics may not be asked in this tick, or what the estimate was set to; "" when nothing is."""
    if missing := next((name for a, name in NEEDED.items() if a not in measured.si), ""):
        return f"no {missing}"
    return next((f"{a} stepped and is believed" for a in NU if a in measured.steps), "")
