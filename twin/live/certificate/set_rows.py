"""How the bounds of Theorem 2 go on by a tick while the ship is in one operating set: the rows of its
matrices, for the sea and the force at hand (docs/stability.md, section 4)."""

from twin.live.certificate.certificate import Certificate
from twin.live.certificate.comparison_systems import AXES, Row, add, scaled_row
from twin.live.certificate.periods import of_certificate

Rows = tuple[tuple[float, ...], ...]
UNANSWERED = (0.0,) * 8  # a tick in which no measurement counts


class SetRows:
    """Of the set for which `certificate` holds. `table`: for each axis (V, d, turned, W, again, drift, c);
    `way`: how fast the ship can change its motion [m/s2, m/s2, rad/s2]; noise and heading_noise of that sea
    [m/s, m/s, rad/s; rad]."""

    def __init__(self, certificate: Certificate) -> None:
        self.operating = certificate.operating
        self.periods = of_certificate(certificate)
        self._certificate = certificate
        self._sea = (-1.0, -1.0)
        self.under(0.0, True)

    def under(self, H_s: float, acts: bool) -> "SetRows":
        """In this sea, and whether a learned force acts."""
        if self._sea == (H_s, float(acts)):
            return self
        self._sea = H_s, float(acts)
        c, step, one = self._certificate, self._certificate.step, self.periods.of(1)
        force = c.disturbance.at(H_s)
        self._force = force if acts else add(force, scaled_row(-1.0, c.saturation))
        self.way: Row = add(c.plant.most, scaled_row(1.0 / c.h, one.pushed(self._force)))
        d = add(one.pushed(self._force), one.calm)
        self.noise: Row = c.disturbance.noise(c.noise, H_s)
        self.heading_noise = c.disturbance.heading_noise(c.heading_noise, H_s)
        left = step.left_by(d, self.noise)
        self.table: Rows = tuple(
            (*one.V[i], d[i], one.turned[i], *step.now[i], step.again[i], *step.drift[i], left[i])
            for i in AXES
        )
        self._late: dict[int, Rows] = {}
        return self

    def late(self, periods: int) -> Rows:
        """The rows of a tick that lasted so many periods: no measurement counts in it."""
        if periods not in self._late:
            many = self.periods.of(periods)
            d = add(many.pushed(self._force), many.calm)
            self._late[periods] = tuple((*many.V[i], d[i], many.turned[i], *UNANSWERED) for i in AXES)
        return self._late[periods]
