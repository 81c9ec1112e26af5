"""Mass that swings aside and round with it but is not driven ahead: liquid in slack tanks, water in an open
hold.

    Y = -m share (dv/dt + u r + place dr/dt),  N = -m (share place (dv/dt + u r) + inertia L^2 dr/dt)
m: mass of the ship. Liquid far below the period of its tank goes with the ship's side, as a mass would.
    Several tanks have a centre (place) and an
inertia about midship of their own. What they do to its heel is left out.
"""

from twin.physics.effect import Force, S, param


class SwayingMass(Force):
    """Something swings aside and round with the ship that is not driven ahead: liquid in slack tanks, water
    in an open hold."""

    source = (
        "Abramson (1966) The dynamic behavior of liquids in moving containers, NASA SP-106, ch. 6 "
        "(sloshing mass)"
    )

    share: float = param(
        0.1, unit="-", lo=0.0, hi=0.5, sd=0.1, doc="what swings, as a share of the ship's mass"
    )
    place: float = param(
        0.0, unit="m", lo=-0.5, hi=0.5, sd=0.2, of="length", doc="where its centre is, ahead of midship"
    )
    inertia: float = param(
        0.01,
        unit="-",
        lo=0.0,
        hi=0.1,
        sd=0.01,
        doc="its moment of inertia about midship, as a share of m L^2",
    )

    def alter(self, ship: S) -> S:
        mass = ship.m / (0.5 * ship.rho * ship.L_pp**2 * ship.T)
        aside, second, d = self.share * mass, self.inertia * mass, ship.derivatives
        first = aside * self.place / ship.L_pp
        return ship.with_derivatives(
            Y_vdot=d.Y_vdot - aside,
            Y_rdot=d.Y_rdot - first,
            N_vdot=d.N_vdot - first,
            N_rdot=d.N_rdot - second,
            Y_ur=d.Y_ur - aside,
            # what added water does besides (core.coriolis), and this does not
            X_vr=d.X_vr - aside,
            X_rr=d.X_rr - first,
            N_uv=d.N_uv + aside,
        )
