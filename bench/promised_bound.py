"""The bound that a loop with a certificate promises for its estimate at this moment."""

from twin.live.certificate.observer_tube import Three
from twin.live.loop import Loop


def promised_bound(loop: Loop) -> Three:
    """Of u, v, r [m/s, m/s, rad/s]. ValueError: the loop has no certificate, and promises nothing."""
    if loop.stabilizer.tube is None:
        raise ValueError("the loop has no certificate: give its ship one")
    return loop.stabilizer.tube.beta
