"""The live bound of an observer that corrects at a sample's own time: it goes the very way the estimate went.

Each inner step x <= M x + d, each sample x_i <= (1 - a) x_i + a n_i (one that does not count: x_i + what it
moved), from the moment that no sample of the tick changes; so it holds whatever the ages of the samples are.
"""

from collections import deque
from math import hypot
from typing import NamedTuple

from twin.live.certificate.certificate import Certificate
from twin.live.certificate.comparison_systems import add, scaled_row
from twin.live.certificate.observer_tube import NONE, NOTHING, UNKNOWN, Three, Tube, halves
from twin.live.certificate.periods import of_certificate
from twin.live.certificate.rolled import InnerStep, inner, way
from twin.live.certificate.set_parts import SetPart, SetParts
from twin.live.observer.operating import NU, outside_in_words
from twin.live.observer.rollback import KEPT_S, Motion, Path, State
from twin.physics.state import Situation

Four = tuple[float, float, float, float]
PSI = 2  # place of the heading among the observer's states; u, v, r follow


class Node(NamedTuple):
    """A moment of the estimate (u, v, r, psi) and the bound of its error, and that before what was corrected
    there."""

    time_s: float
    bound: Four
    estimate: Four
    before: Four


class RolledTube(Tube):
    """As Tube; `follow` in the place of `step`. Whether it was inside the set is asked of every inner step
    of the way."""

    def __init__(
        self, certificate: Certificate, start: Three | None = None, parts: SetParts | None = None
    ) -> None:
        """`parts`: those of another tube of the certificate."""
        self.certificate = certificate
        self.window = 2  # ticks; what the way goes back to is looked at in each
        self.periods = of_certificate(certificate)
        self.oldest_s = KEPT_S
        self.beta = certificate.noise if start is None else start
        self.psi = certificate.heading_noise
        self._one = InnerStep(inner(certificate.plant, certificate.inner))
        self._length = certificate.h / certificate.inner
        self._share = certificate.K[0] * certificate.h
        self._nodes: deque[Node] = deque()
        self._from_s = float("-inf")  # from where the last path went
        self._left: str | None = None  # what left the set on the way, or may have
        self.distrusted = NONE  # rows of nu of which no sample counts for the time being
        # what samples that did not count moved each row by; 0 where a part of the way was gone again
        self.uncounted: list[float] = [0.0, 0.0, 0.0]
        cells = certificate.plant.cells
        assert cells is not None  # the certificate of an observer with inner steps
        self.parts = parts or SetParts(certificate, cells)
        self._set = self.parts.operating
        self._part: SetPart | None = None  # in which the ship surely is; None: it may be outside
        self._sea = (-1.0, -1.0)
        self.under(0.0, True)

    @property
    def left(self) -> bool:
        """Whether the last way may have left the set."""
        return self._left is not None

    @property
    def widest(self) -> Three:
        """The greatest bound before a correction of the kept time."""
        kept = [node.before for node in self._nodes] or [(*self.beta, self.psi)]
        return max(x[0] for x in kept), max(x[1] for x in kept), max(x[2] for x in kept)

    def carried(self, pulled: Three, turned: float, since_s: float) -> tuple[Three, float]:
        """The bound as it is, for a sample corrects its own time and nothing looks back, if the path began
        no earlier than `since_s`; else one that says nothing."""
        return (self.beta, self.psi) if self.rests_on(since_s) else UNKNOWN

    def rests_on(self, since_s: float) -> bool:
        """Whether the last way began no earlier than that."""
        return self._from_s >= since_s

    def know(self, most: Three, psi: float) -> None:
        """Of this and what the tube says the lesser holds, row by row, and the next way begins at it. A
        sample takes away so much of an error that only in yaw, and where samples are seldom, there is much
        between them. The bound of now stays the tube's: it forgives a sample that is off by more than n."""
        if self._nodes:
            (u, v, r), last = self.beta, self._nodes[-1]
            known = min(u, most[0]), min(v, most[1]), min(r, most[2]), min(self.psi, psi)
            self._nodes[-1] = last._replace(bound=known)

    def reset(self, start: Three | None = None, psi: float | None = None) -> None:
        """Begin anew from what the instruments leave open; before now it was at most its way from there."""
        if start == self.beta and psi == self.psi:
            return  # the way to it is known better than that
        self.beta = self.noise if start is None else start
        self.psi = self.heading_noise if psi is None else psi
        if not self._nodes:
            return
        bound, last = (*self.beta, self.psi), self._nodes[-1]
        way = (*self.way, max(map(abs, self._set.ranges["r"])))
        old, self._nodes = self._nodes, deque()
        for node in old:
            at: Four = tuple(  # type: ignore[assignment]
                b + abs(then - now) + w * (last.time_s - node.time_s)
                for b, then, now, w in zip(bound, node.estimate, last.estimate, way, strict=True)
            )
            self._nodes.append(Node(node.time_s, at, node.estimate, at))

    def follow(self, path: Path, H_s: float = 0.0, acts: bool = True) -> Three:
        """The bound at the end of that path."""
        self.under(H_s, acts)
        nodes, self._left, self._from_s = self._nodes, None, path.start_s
        again = bool(nodes) and nodes[-1].time_s > path.start_s
        self.uncounted = [0.0, 0.0, 0.0]
        while nodes and nodes[-1].time_s > path.start_s:
            nodes.pop()
        x = nodes[-1].bound if nodes else (*self.beta, self.psi)
        if not nodes:  # a new start
            nodes.append(Node(path.start_s, x, of_state(path.start), x))
        for time_s, motions, pulls, after in path.stretches:
            for k, motion in enumerate(motions):
                if not (k and self._part and self._part.holds(motion, x)):
                    self._part = self._around(motion, x)
                if self._part is None:
                    self._left = self._left or self._outside(motion, x)
                x = self._on(x)
            before = x
            for state, full, moved in pulls:
                if state >= PSI:
                    x = self._pulled(x, 3 if state == PSI else state - 3, full, moved)
            nodes.append(Node(time_s, x, of_state(after), before))
        while len(nodes) > 1 and nodes[1].time_s <= nodes[-1].time_s - KEPT_S:
            nodes.popleft()
        if again:
            self.uncounted = [0.0, 0.0, 0.0]
        self.beta, self.psi = x[:3], x[3]
        return self.beta

    def outside(
        self, s: Situation, within: Three | None = None, dt: float = 0.0, on_the_way: bool = True
    ) -> str | None:
        """What left the set on the way to now, or does now."""
        if on_the_way and self._left:
            return self._left
        within = within or self.beta
        now: Motion = (s.u_r, s.v_r, s.r, hypot(s.u - s.u_r, s.v - s.v_r))  # type: ignore[assignment, operator]
        part = self._around(now, (*within, self.psi))
        way = part.way if part else self.way
        return self._set.outside(s, add(within, scaled_row(self._length, way)))

    def _around(self, motion: Motion, x: Four) -> SetPart | None:
        """The part of the set in which the ship surely is during a step from that motion."""
        return self.parts.around(motion, x, self._force, self._part)

    def _outside(self, motion: Motion, x: Four) -> str:
        """What may be outside as an inner step begins, or within it."""
        ranges = self._set.ranges
        for name, value, b, w in zip(NU, motion, x, self.way, strict=False):
            most, (low, high) = b + self._length * w, ranges[name]
            if not low + most <= value <= high - most:
                return outside_in_words(name, value, most, low, high)
        return outside_in_words("stream", motion[3], 0.0, *ranges["stream"])

    def _on(self, x: Four) -> Four:
        u, v, r, psi = x
        rows = self._part.rows if self._part else self._rows
        a, b, c, e = [min(m0 * u + m1 * v + m2 * r + m3 * psi + d, NOTHING) for m0, m1, m2, m3, d in rows]
        return a, b, c, e

    def _pulled(self, x: Four, i: int, full: bool, moved: float) -> Four:
        """A sample farther from the estimate than x_i + n_i is not one that A4 speaks of: it counts by what
        it moved."""
        bound, share, noise = [*x], self._share, self._noise[i]
        if full and moved <= share * (x[i] + noise) and not (i < len(NU) and self.distrusted[i]):
            bound[i] = (1.0 - share) * x[i] + share * noise
        else:
            bound[i] += moved
            if i < len(NU):
                self.uncounted[i] += moved
        return tuple(bound)  # type: ignore[return-value]

    def under(self, H_s: float, acts: bool) -> None:
        """The rows of an inner step in this sea."""
        if self._sea == (H_s, float(acts)):
            return
        self._sea = H_s, float(acts)
        self._halves = halves(self.certificate)
        c = self.certificate
        force = c.disturbance.at(H_s)
        if not acts:
            force = add(force, scaled_row(-1.0, c.saturation))
        self.noise: Three = c.disturbance.noise(c.noise, H_s)
        self.heading_noise = c.disturbance.heading_noise(c.heading_noise, H_s)
        self._noise: Four = (*self.noise, self.heading_noise)
        self._force = force
        self.way: Three = self.parts.everywhere.under(force).way
        d = self._one.pushes(force, way(c.plant, force)[2])
        self._rows = tuple((*row, x) for row, x in zip(self._one.M, d, strict=True))


def of_state(x: State) -> Four:
    """(u, v, r, psi) of an estimate."""
    return x[3], x[4], x[5], x[2]


def tube_of(certificate: Certificate) -> Tube:
    """The tube that goes with the certificate's observer."""
    return RolledTube(certificate) if certificate.inner > 1 else Tube(certificate)
