"""Another damping of the hull in sway and yaw: bilge keels lost or added, something that hangs below it, a
stern that was rebuilt.

    Y_uv -> Y_uv - sway,  N_ur -> N_ur - yaw
in prime form: the lift that the hull sets against drift, and the moment that it sets against turning.
"""

from twin.physics.effect import Force, S, param


class HullDamping(Force):
    """The hull sets more, or less, against drifting and turning than it did, and is as heavy and as deep."""

    source = "Fossen (2021) Handbook of marine craft hydrodynamics and motion control, ch. 6 (D)"

    sway: float = param(0.1, unit="-", lo=-1.0, hi=1.0, sd=0.1, doc="more damping of sway, -Y_uv")
    yaw: float = param(0.02, unit="-", lo=-0.2, hi=0.2, sd=0.02, doc="more damping of yaw, -N_ur")

    def alter(self, ship: S) -> S:
        d = ship.derivatives
        return ship.with_derivatives(Y_uv=d.Y_uv - self.sway, N_ur=d.N_ur - self.yaw)
