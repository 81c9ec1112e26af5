"""The live bound of the observer's error, tick by tick, through measurements, drop-outs, late ticks and
changing seas.

    before the measurements of a tick:   E = V p + push d(H_s) + calm + turned psi
    with one (row by row):               p = W p + again max(E) + drift max(p) + c + (h - dt) K E
    without:                             p = E, and what a sample that does not count was allowed to pull

psi: the bound of the estimated heading's error, a fourth state. The matrices are those of
    twin/live/certificate/theorem.py (twin/live/periods.py for
a tick that lasted longer than the certified period).
"""

from collections import deque
from math import inf

from twin.live.certificate.certificate import Certificate
from twin.live.certificate.comparison_systems import add, scaled_row
from twin.live.certificate.periods import ROUNDING_SHARE, TABLE
from twin.live.certificate.set_rows import SetRows
from twin.live.observer.operating import NU, WORDS, in_unit
from twin.physics.state import Situation

NOTHING = 1e9  # a bound so wide that it says nothing: hours without a measurement, or no certificate

Three = tuple[float, float, float]
NO_PULL = (0.0, 0.0, 0.0)
UNKNOWN: tuple[Three, float] = ((NOTHING, NOTHING, NOTHING), NOTHING)
NONE = (False, False, False)


def look_back(m: int) -> int:
    """Samples that a measurement of age m can still show."""
    return 2 * m + 1


def halves(c: Certificate) -> Three:
    """Half of the set's width of u, v, r [m/s, m/s, rad/s]: a bound that reaches it says nothing."""
    (u0, u1), (v0, v1), (r0, r1) = (c.operating.ranges[name] for name in NU)
    return 0.5 * (u1 - u0), 0.5 * (v1 - v0), 0.5 * (r1 - r0)


class Highest:
    """The greatest of the last so many values, in a time that does not grow with their number."""

    __slots__ = ("count", "kept", "size")

    def __init__(self, size: int, *first: float) -> None:
        self.size, self.count = size, 0
        self.kept: deque[tuple[int, float]] = deque()  # falling values with the number each came as
        for x in first:
            self.push(x)

    def push(self, x: float) -> float:
        """Take one more; the greatest of the window with it."""
        kept = self.kept
        while kept and kept[-1][1] <= x:
            kept.pop()
        kept.append((self.count, x))
        self.count += 1
        if kept[0][0] <= self.count - 1 - self.size:
            kept.popleft()
        return kept[0][1]

    def raised(self, x: float) -> float:
        """The newest value is at least this, after all."""
        self.count -= 1
        return self.push(x)


class Tube:
    """|nu_hat - nu| <= beta, component by component [m/s, m/s, rad/s], as long as the assumptions hold; `psi`
    the same of the heading."""

    def __init__(self, certificate: Certificate, start: Three | None = None) -> None:
        """`start` bounds the error of the first estimate; by default that is a measurement, so its noise."""
        self.certificate = certificate
        self.window = look_back(max(certificate.delays))
        self._usual = self._wider = SetRows(certificate)
        self._sets = [self._usual]
        if certificate.reach:
            self._wider = SetRows(certificate.in_reach())
            self._sets.append(self._wider)
        self.periods = self._usual.periods
        # how far it surely is from the ends of the usual set [m/s, m/s, rad/s]; None: it may be outside
        self._room: Three | None = None
        self._beyond = 0  # ticks for which a late measurement may look back on what was outside of it
        self.oldest_s = (1.0 + ROUNDING_SHARE) * max(certificate.delays) * certificate.h
        first = self.beta = certificate.noise if start is None else start
        self.psi = certificate.heading_noise
        self._after, self._before = ([Highest(self.window, b) for b in first] for _ in range(2))
        self._headings = Highest(self.window, self.psi)
        self._widest: Three = first  # greatest after of the window
        self._seas, self._acted = Highest(self.window), Highest(self.window)
        self._pulls: deque[Three] = deque(maxlen=self.window)
        # what is known without counting measurements in, E of it, and its greatest of the window
        self._known: tuple[Three, float] = (first, self.psi)
        self._alone: tuple[Three, float] = self._known
        self._alones = tuple([Highest(self.window, b) for b in first])
        # the highest in the window, and whether the learned force acted, for which the rows were made
        self._sea = (-1.0, -1.0)
        self.under(0.0, True)

    def carried(self, pulled: Three, turned: float, since_s: float) -> tuple[Three, float]:
        """What was `know`n (nu, psi) one step later, with no measurement counted: E of it, and what samples
        `pulled` and `turned` the estimate by. Nothing in it looks back, but on bounds from before `since_s`
        it does not rely."""
        return add(self._alone[0], pulled), self._alone[1] + turned

    def rests_on(self, since_s: float) -> bool:
        """Whether the bound rests on nothing from before that time; here the window sees to it."""
        return since_s < inf

    def know(self, most: Three, psi: float) -> None:
        """A bound of the estimate's error that holds now, whatever this tube says: the next step carries it,
        and only that one."""
        self._known = most, psi

    def reset(self, start: Three | None = None, psi: float | None = None) -> None:
        """Begin anew from what the instruments leave open. What a late measurement looks back on stays in the
        windows."""
        self.beta = self.noise if start is None else start
        self.psi = psi if psi is not None and self.certificate.estimated_heading else self.heading_noise
        first, second, third = self._after
        u, v, r = self.beta
        self._widest = first.raised(u), second.raised(v), third.raised(r)
        self._headings.raised(self.psi)
        for before, alone, b in zip(self._before, self._alones, self.beta, strict=True):
            before.raised(b)
            alone.raised(b)
        self._known = self.beta, self.psi

    def step(
        self,
        received: tuple[bool, bool, bool],
        H_s: float = 0.0,
        pulled: Three = NO_PULL,
        dt: float | None = None,
        acts: bool = True,
        heading: bool = True,
        turned: float = 0.0,
    ) -> Three:
        """The bound after this tick of dt seconds (the certified period by default); `received` says which of
        u, v, r was measured and accepted, `heading` whether psi was, `acts` whether a learned force acts.

        `pulled`, `turned`: by how much a sample that was not accepted may have moved the estimate all the
        same."""
        h, K = self.certificate.h, self.certificate.K
        dt = h if dt is None else dt
        late = self.periods.count(dt)
        self.under(self._seas.push(H_s), self._acted.push(float(acts)) > 0.0)
        rows = self._set_rows(max(h, dt))
        pu, pv, pr = self._widest
        (u, v, r), psi = self.beta, self.psi
        if late == 1:
            short, table = max(h - dt, 0.0), rows.table
        else:
            late = late or TABLE[-1]
            short, table, received, heading = 0.0, rows.late(late), NONE, False
        beta, alone, E = [], [], 0.0
        (known_u, known_v, known_r), known_psi = self._known
        for i, (v0, v1, v2, d, t, w0, w1, w2, again, d0, d1, d2, c) in enumerate(table):
            E = min(v0 * u + v1 * v + v2 * r + d + t * psi, NOTHING)
            widest = self._before[i].push(E)
            by_itself = min(v0 * known_u + v1 * known_v + v2 * known_r + d + t * known_psi, NOTHING)
            alone.append(by_itself)
            self._alones[i].push(by_itself)
            if received[i]:
                p = (
                    w0 * u
                    + w1 * v
                    + w2 * r
                    + again * widest
                    + d0 * pu
                    + d1 * pv
                    + d2 * pr
                    + c
                    + self.certificate.step.pushed[i] * t * psi
                )
                beta.append(min(p + short * K[i] * E, NOTHING))
            else:
                beta.append(E)
        turned_by = 0.5 * late * h * (known_r + alone[2]) + self._curve(late * h)
        self._alone, self._known = ((alone[0], alone[1], alone[2]), known_psi + turned_by), UNKNOWN
        if self.certificate.estimated_heading:
            self._turn(E, late * h, short, heading, turned)
        if pulled is not NO_PULL or self._pulls:
            beta = self._and_pulled(beta, received, pulled)
        u, v, r = self.beta = beta[0], beta[1], beta[2]
        first, second, third = self._after
        self._widest = first.push(u), second.push(v), third.push(r)
        return self.beta

    def _turn(self, E_r: float, h: float, short: float, heading: bool, turned: float) -> None:
        """The heading's bound: turned at the error of r, pulled by a measurement of it as the motion is."""
        c = self.certificate
        curve = self._curve(h)
        E = min(self.psi + 0.5 * h * (self.beta[2] + E_r) + curve, NOTHING)
        if not heading:
            self.psi = E + turned
        else:
            pull, back = c.step.pull[2], c.step.before[2]
            again = back * pull * (h * self._widest[2] + pull * self._headings.kept[0][1]) + pull * curve
            self.psi = (
                (1.0 - pull + short * c.K[2]) * E + again + pull * (1.0 + back * pull) * self.heading_noise
            )
        self._headings.push(self.psi)

    def _curve(self, h: float) -> float:
        """What a turning that is taken for even misses the heading by."""
        return 0.25 * h * h * self.way[2]

    def _and_pulled(self, beta: list[float], received: tuple[bool, bool, bool], pulled: Three) -> list[float]:
        """A rejected sample's pull counts in full now, and shows in late measurements for a while."""
        step = self.certificate.step
        late = [
            step.before[i] * step.pull[i] * max((p[i] for p in self._pulls), default=0.0) for i in (0, 1, 2)
        ]
        self._pulls.append(pulled)
        if not any(any(p) for p in self._pulls):
            self._pulls.clear()
        return [b + (late[i] if received[i] else pulled[i]) for i, b in enumerate(beta)]

    def under(self, H_s: float, acts: bool) -> None:
        """What both sets have in this sea."""
        if self._sea == (H_s, float(acts)):
            return
        self._sea = H_s, float(acts)
        self._halves = halves(self.certificate)
        usual, wider = self._usual.under(H_s, acts), self._wider.under(H_s, acts)
        self.noise, self.heading_noise = usual.noise, usual.heading_noise
        if not self.certificate.estimated_heading:
            self.psi = self.heading_noise
        self.way: Three = wider.way  # how fast it can change its motion, wherever it was

    def _set_rows(self, lasted_s: float) -> SetRows:
        """Those of the usual set if nothing that a late measurement looks back on can have left it."""
        (u, v, r), room, s = self._usual.way, self._room, lasted_s
        stays = room and s * u <= room[0] and s * v <= room[1] and s * r <= room[2]
        self._beyond = max(self._beyond - 1, 0) if stays else self.window
        return self._wider if self._beyond else self._usual

    @property
    def widest(self) -> Three:
        """The greatest bound before a correction of the window that a measurement of greatest age looks back
        on: what a sample may be compared with is off by no more."""
        (u, v, r), (first, second, third) = self._before, self._alones
        return (
            min(u.kept[0][1], first.kept[0][1]),
            min(v.kept[0][1], second.kept[0][1]),
            min(r.kept[0][1], third.kept[0][1]),
        )

    def outside(
        self, s: Situation, within: Three | None = None, dt: float = 0.0, on_the_way: bool = True
    ) -> str | None:
        """What leaves the operating set, or may within a sample, in words; None when the ship is surely in
        it. `within`: how far it may be from the estimate, where that is known better than by the tube; dt:
        how long the last tick was, if longer than a sample. In which of both sets the next step goes is
        remembered."""
        within, lasts_s = within or self.beta, max(self.certificate.h, dt)
        for rows in self._sets:
            left = rows.operating.outside(s, add(within, scaled_row(lasts_s, rows.way)))
            if left is None:
                self._room = rows.operating.room(s, within) if rows is self._usual else None
                return None
        self._room = None
        return left

    def says_nothing(self) -> str | None:
        """In words, while the bound is as wide as the operating set itself; else None."""
        u, v, r = self.beta
        most_u, most_v, most_r = self._halves
        if u < most_u and v < most_v and r < most_r:
            return None
        for name, b, half in zip(NU, self.beta, self._halves, strict=True):
            if not b < half:
                wide = f"the bound of {WORDS[name]} is as wide as the operating set"
                return f"{wide}, width = ± {in_unit(name, b)}"
        return None
