"""The certificate beside the loop: the live bound on the observer's error, and whether its assumptions
hold now."""

from math import hypot

from twin.live.estimate import Observer
from twin.live.measured import Measured
from twin.live.publish import Certified
from twin.live.tube import Tube
from twin.physics.state import Situation

NU = ("u", "v", "r")

USELESS = 1e3  # m/s: a bound above every speed at sea


class Stabilizer:
    """Steps the tube once a tick; without a certificate it promises nothing, and says so by `inside` being
    false."""

    def __init__(self, tube: Tube | None = None, why_not: str = "no certificate"):
        self.tube, self.why_not = tube, why_not
        self._restarts = -1
        self.outside: str | None = why_not

    def step(self, observer: Observer, measured: Measured, s: Situation) -> Certified:
        """The bound of this tick."""
        tube = self.tube
        if tube is None or not observer.estimate.ready:
            return Certified(margin=tube.certificate.margin if tube else 0.0)
        if observer.restarts != self._restarts:
            tube.reset()
            self._restarts = observer.restarts
        got = tuple([observer.received[a] and self._in_time(a, measured, tube) for a in NU])
        beta = tube.step(got, measured.si.get("H_s", 0.0))  # type: ignore[arg-type]
        self.outside = tube.outside(s)
        certificate = tube.certificate
        bound = hypot(beta[0], beta[1])
        if not bound < USELESS:  # a tube that no gain holds widens for ever: it says nothing, and begins anew
            tube.reset()
            return Certified(certificate.margin, USELESS, False)
        return Certified(certificate.margin, bound, certificate.ok and self.outside is None)

    def _in_time(self, attribute: str, measured: Measured, tube: Tube) -> bool:
        """Measured by its own instrument, and not older than the certificate allows."""
        if attribute in measured.derived or attribute not in measured.si:
            return False
        return measured.age_s(attribute) <= (tube.certificate.delay_samples + 0.5) * tube.certificate.h
