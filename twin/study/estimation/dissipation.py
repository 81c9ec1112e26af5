"""A hull in still water takes energy out of its own motion, whichever way it moves; so must a fitted one.

    P(nu) = -(X_d u + Y_d v + N_d r) >= KEPT P_first(nu)          power that the damping takes out
    E(nu) = -1/2 (Y_vdot v^2 + (Y_rdot + N_vdot) v r + N_rdot r^2) >= KEPT E_first(nu)    energy of the water

in every direction of nu = (u, v, r), where `first` is the model that the priors are centred on. Both are
linear in the derivatives, so that each direction is one half-space of them; what lies between two directions
may feed a hundredth of what they take. Added mass and rigid body do no
work in C(nu), so a hull that keeps to P > 0 as fast as it gets stays bounded. Short voyages
leave directions open in which the ship never moved; without this a fit takes what sign it likes there and
the model runs away. On a straight course it does not run away either if its resistance R still grows where
a ship is fastest:

    dR/du >= KEPT dR_first/du at FASTEST,   R = -(X_uu + X_uuu u/sqrt(g L)) u^2 in prime units

As (dR/du)/u is linear in u, and positive at rest by P > 0, R then grows at every speed up to there. Thrust at
fixed turns falls with speed by its own boxes, so that past the speed where both are equal the ship is slowed
down. Behind its hump a planing hull's resistance may fall a little, but at higher speed it grows again
[Faltinsen 2005, ch. 9]; with X_uu < 0 this polynomial has no such dip: once it falls it falls for ever, until
it drives the ship. Over a hump a fit can only be flat.

Source: Fossen (2021) Handbook of Marine Craft, ch. 6: D(nu_r) > 0 and M_A = M_A^T > 0; Faltinsen (2005)
Hydrodynamics of High-Speed Marine Vehicles.
"""

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import NamedTuple

import numpy as np

from twin.physics import core
from twin.physics.dual import Dual
from twin.physics.ship import Derivatives, Ship
from twin.study.estimation.columns import Unknown

KEPT = 0.1  # least share of the first model's damping, and of its added mass, that a fit may leave
FASTEST = 1.5  # of service speed: up to here X_uuu must not turn resistance into a push, nor let it fall
PER_EDGE = 13  # directions along each edge of the cube that they are taken from
LINEAR = ("X_u", "Y_v", "N_r")  # never positive by their boxes, and small where the others are large
OF_WATER = ("Y_vdot", "Y_rdot", "N_vdot", "N_rdot")
OF_RESISTANCE = ("X_uu", "X_uuu")
OF_DAMPING = tuple(
    f.name
    for f in fields(Derivatives)
    if f.name[:2] in ("X_", "Y_", "N_") and not f.name.endswith("dot") and f.name not in LINEAR
)


class HalfSpaces(NamedTuple):
    """rows @ z >= least, z the unknowns in widths of their priors from their centres."""

    rows: np.ndarray  # (C, P)
    least: np.ndarray  # (C,)


def half_spaces(ship: Ship, unknowns: Sequence[Unknown]) -> HalfSpaces:
    """What the unknowns of a ship's core may not leave; none when none of them is of its damping or its added
    mass."""
    both = where_it_dissipates(ship, unknowns), where_resistance_grows(ship, unknowns)
    return HalfSpaces(*map(np.concatenate, zip(*both, strict=True)))


def where_it_dissipates(ship: Ship, unknowns: Sequence[Unknown]) -> HalfSpaces:
    """Of P and E alone."""
    return _of(ship, unknowns, ((OF_DAMPING, _damped), (OF_WATER, _energy)))


def where_resistance_grows(ship: Ship, unknowns: Sequence[Unknown]) -> HalfSpaces:
    """Of dR/du alone."""
    return _of(ship, unknowns, ((OF_RESISTANCE, _growing),))


def _of(
    ship: Ship,
    unknowns: Sequence[Unknown],
    measures: Sequence[tuple[Sequence[str], Callable[[Ship], np.ndarray]]],
) -> HalfSpaces:
    """Those in which each measure keeps its share, by the derivatives that it depends on."""
    first = ship.with_derivatives(**{u.name: u.centre for u in unknowns if u.owner == "core"})
    rows, at_first = [], []
    for names, measure in measures:
        column = [j for j, u in enumerate(unknowns) if u.owner == "core" and u.name in names]
        if not column:
            continue
        here = measure(first)
        some = np.zeros((here.size, len(unknowns)))
        for j in column:
            u = unknowns[j]
            some[:, j] = measure(first.with_derivatives(**{u.name: u.centre + u.sd})) - here
        rows.append(some)
        at_first.append(here)
    if not rows:
        return HalfSpaces(np.zeros((0, len(unknowns))), np.zeros(0))
    power, slope = np.concatenate(at_first), np.concatenate(rows)
    size = np.linalg.norm(slope, axis=1)
    free = size > 1e-12 * max(size.max(), 1e-300)
    least = KEPT * np.maximum(power, 0.0) - power
    return HalfSpaces(slope[free] / size[free, None], least[free] / size[free])


def power(ship: Ship, u: np.ndarray, v: np.ndarray, r: np.ndarray) -> np.ndarray:
    """(N,) power [W] that the hull's damping takes out of its motion at (u, v [m/s], r [rad/s])."""
    X, Y, N = core.damping(u, v, r, ship.c)
    return np.asarray(-(X * u + Y * v + N * r))


def _damped(ship: Ship) -> np.ndarray:
    """Power [W] without its linear part in every direction: of the quadratic part alone, and as fast as
    FASTEST with what grows faster."""
    fast = _without_linear(ship)
    slow = replace(fast, derivatives=replace(fast.derivatives, X_uuu=0.0))
    u, v, r = DIRECTIONS.T * FASTEST * float(ship.U_0)
    return np.concatenate([power(s, u, v, r / float(ship.L_pp)) for s in (slow, fast)])


def _growing(ship: Ship) -> np.ndarray:
    """(1,) by how much resistance without its linear part grows at FASTEST: u^2 dR/du [W]."""
    u = FASTEST * float(ship.U_0)
    (slope,) = core.resistance(Dual(u, (1.0,)), _without_linear(ship).c).slopes
    return np.array([-(u**2) * slope])


def _without_linear(ship: Ship) -> Ship:
    return replace(ship, derivatives=replace(ship.derivatives, **dict.fromkeys(LINEAR, 0.0)))


def _energy(ship: Ship) -> np.ndarray:
    """Energy [J] of the water that swaying and yawing set in motion, by direction."""
    angle = np.linspace(0.0, np.pi, 4 * PER_EDGE, endpoint=False)
    v, r = np.cos(angle), np.sin(angle) / float(ship.L_pp)
    c = ship.c
    return np.asarray(-0.5 * (c.Y_vdot * v * v + (c.Y_rdot + c.N_vdot) * v * r + c.N_rdot * r * r))


def _directions() -> np.ndarray:
    """(D, 3) evenly over the sides of a cube; of two that are mirrored (v, r) one."""
    edge = np.linspace(-1.0, 1.0, PER_EDGE)
    sides = np.array(np.meshgrid(edge, edge, edge, indexing="ij")).reshape(3, -1).T
    sides = sides[np.abs(sides).max(1) == 1.0]
    port = (sides[:, 1] < 0.0) | ((sides[:, 1] == 0.0) & (sides[:, 2] < 0.0))
    return sides[~port]


DIRECTIONS = _directions()
