"""Shallow water: the bottom squeezes the stream past the hull, whose damping and added mass grow.

    F = T/h,  g(F) = F^2/(1 - F):   X, Y, N of the hull times 1 + surge g, 1 + sway g, 1 + yaw g
    added mass in sway times 1 + heavier g, in yaw times 1 + slower g
    of the thrust 1 - thrust F^2 drives it (and at the rudder it is what it was)
N is the whole moment of the hull, Munk's included. With sway = 0.75 the side force grows x1.4, x2.0 and x4.2
at h/T = 2, 1.5 and 1.2, as Kijima's regression 1/(1-F)^n - F gives for a full tanker (n = 0.9); with heavier
= 1 the added mass x1.5, x2.3 and x5.2. Li & Wu's regression has 1.5 to 3 for it and a third of that in yaw,
slender bodies 0.5 for both. The propeller draws harder at the stern of a hull that the bottom holds: with
thrust = 0.35 it drives it by 9, 16 and 24 % less, as (1 - t)/(1 - 0.2 F + 0.7295 F^2) has it. Below h/T =
1.05 the growth is held."""

from twin.physics.effect import Flow, param
from twin.physics.maths import maximum
from twin.physics.ship_like import ShipLike
from twin.physics.state import Situation, Water


class ShallowWater(Flow):
    """Little water under the keel: the ship slows, turns wider and answers later, the more the closer the
    bottom."""

    belongs_to = "voyage"
    needs = ("depth",)
    of_place = True
    role = "shallow_water"
    with_core = "there was little water under the keel on the reference voyages"
    source = (
        "Kijima, Katsuno, Nakiri & Furukawa (1990) J. Soc. Naval Arch. Japan 168 (shallow-water correction); "
        "Lackenby (1963) for "
        "surge; Newman (1969) J. Fluid Mech. 39 and Li & Wu (1990) J. Hydrodynamics for the added mass; "
        "Furukawa et al. (2016) and "
        "Tang et al. (2020) Ocean Eng. 195 for the thrust"
    )

    surge: float = param(
        0.15, unit="-", lo=0.0, hi=1.0, sd=0.15, doc="how fast the resistance grows with g(T/h)"
    )
    sway: float = param(
        0.75, unit="-", lo=0.0, hi=3.0, sd=0.6, doc="how fast the side force grows with g(T/h)"
    )
    yaw: float = param(
        0.35, unit="-", lo=0.0, hi=2.0, sd=0.3, doc="how fast the yaw moment grows with g(T/h)"
    )

    heavier: float = param(
        1.0, unit="-", lo=0.0, hi=6.0, sd=1.0, doc="how fast the added mass in sway grows with g(T/h)"
    )
    slower: float = param(
        0.4, unit="-", lo=0.0, hi=3.0, sd=0.6, doc="how fast the added inertia in yaw grows with g(T/h)"
    )
    thrust: float = param(
        0.35, unit="-", lo=0.0, hi=1.0, sd=0.3, doc="share of the driving thrust that is lost, over (T/h)^2"
    )

    def water(self, s: Situation, ship: ShipLike) -> Water:
        F = ship.T / maximum(s.depth, 1.05 * ship.T)
        g = F * F / (1.0 - F)
        return Water(
            k_u=self.surge * g,
            k_v=self.sway * g,
            k_r=self.yaw * g,
            k_m=self.heavier * g,
            k_j=self.slower * g,
            k_t=self.thrust * F * F,
        )
