"""The equations of motion in six degrees of freedom: state, forces, rate of change.

Rows of the state (14, B): north, east, heading; surge, sway, yaw rate *through the water*; roll and its
rate; heave and its speed; pitch and its rate; slosh and its speed. Surge, sway, yaw and roll are coupled
(MMG with roll); heave and pitch are oscillators driven by the waves. In an even current the through-water
equations hold as they stand; a changing current adds the inertia -m dc/dt.
"""

import numpy as np

from bench.reference import flaws, mmg

NORTH, EAST, PSI, U, V, R, PHI, P, Z, W, THETA, Q, SLOSH, SLOSHING = range(14)


class Tally:
    """Sums force by origin, and the power of each hidden effect over the voyage."""

    def __init__(self, count):
        self.count, self.squares, self.nothing = count, {}, np.zeros(count)
        self.clear()

    def clear(self):
        self.total, self.by = [self.nothing] * 4, {}

    def add(self, origin, X=0.0, Y=0.0, N=0.0, K=0.0):
        for i, b in enumerate((X, Y, N, K)):
            if not isinstance(b, float):
                self.total[i] = self.total[i] + b
        old = self.by.get(origin)
        self.by[origin] = (X, Y, N) if old is None else (old[0] + X, old[1] + Y, old[2] + N)

    def remember(self, effect, X=0.0, Y=0.0, N=0.0):
        """Note the size of a hidden effect (its sum is already among the forces)."""
        old = self.squares.get(effect, (0.0, 0.0, 0.0, 0))
        self.squares[effect] = (
            *tuple(a + np.square(b) for a, b in zip(old[:3], (X, Y, N), strict=True)),
            old[3] + 1,
        )

    def typical(self, effect, k):
        """Root mean square X, Y, N of an effect on ship `k`."""
        *squares, times = self.squares[effect]
        return [float(np.sqrt(np.broadcast_to(s, self.count)[k] / times)) for s in squares]

    def hidden(self, effect, X=0.0, Y=0.0, N=0.0, K=0.0):
        self.add("hidden", X, Y, N, K)
        self.remember(effect, X, Y, N)


def propulsion(tally, f, on, h, there, u, n):
    """Propeller, with its wear and its walk; returns the inflow and the thrust for the rudder."""
    u_P = mmg.inflow(h, there, u)
    thrust = mmg.open_water(h, n, u_P)
    tally.add("propeller", (1 - h.t_P) * thrust)
    if on.prop_wear:
        lost = flaws.worn_thrust(f, h, thrust, n, u_P)
        tally.hidden("PropellerWear", -(1 - h.t_P) * lost)
        thrust = thrust - lost
    if on.walk:
        tally.hidden("PropellerWalk", 0.0, *flaws.propeller_walk(f, h, thrust, n, u_P, u))
    return u_P, thrust


def steering(tally, f, on, h, there, u_P, thrust, blade, feedback):
    """Rudder, with its wear and offset."""
    force = mmg.rudder(h, there, u_P, thrust, blade)
    tally.add("rudder", *force)
    if on.rudder_wear:
        lost = flaws.worn_rudder(f, h, blade) - 1
        tally.hidden("RudderWear", *(lost * c for c in force))
    if on.rudder_offset or on.backlash:
        straight = mmg.rudder(h, there, u_P, thrust, feedback)
        tally.remember(
            "RudderOffset" if on.rudder_offset else "RudderBacklash",
            *(a - b for a, b in zip(force[:3], straight[:3], strict=True)),
        )


def water(tally, f, on, h, s, there, env):
    """The bare hull and what alters the water's grip on it."""
    u, v, r, phi = s[U], s[V], s[R], s[PHI]
    force = mmg.hull(h, there, u, r, s[P], phi)
    tally.add("hull", *force)
    if on.shallow:
        extra = [
            a - b
            for a, b in zip(
                mmg.hull(h, there, u, r, s[P], phi, flaws.shallow(h.d / env.depth)), force, strict=True
            )
        ]
        tally.hidden("ShallowWater", *extra)
    if on.crossflow:
        tally.hidden("CrossFlowDrag", 0.0, *flaws.crossflow(f, h, v, r))
    if on.fouling:
        tally.hidden("HullFouling", *flaws.fouling(f, h, u, v))
    if on.heel_N:
        tally.hidden("RollCoupling", 0.0, *flaws.heel(f, h, u, v, r, phi))
    if on.bank_N:
        tally.hidden("Bank", 0.0, *flaws.bank(f, h, u, env.bank))
    if on.ice:
        tally.hidden("IceLike", flaws.ice(f, h, s[NORTH], s[EAST], u))


def pulls(tally, f, on, h, t, psi):
    """What neither water, wind nor blades do."""
    if on.tow_N:
        tally.hidden("TowForce", *flaws.tow(f, t))
    if on.ext_north:
        tally.hidden("ExternalForce", *flaws.external(f, t, psi))
    if on.passing_N:
        tally.hidden("PassingShip", 0.0, *flaws.passing(f, h, t))


def rate(tally, f, on, h, s, sway_acceleration, env, t, n, blade, feedback):
    """Rate of change of the state (14, B); fills the tally with the forces of this instant."""
    tally.clear()
    u, v, r, phi, p = s[U], s[V], s[R], s[PHI], s[P]
    there = mmg.angles(h, u, v, r)
    water(tally, f, on, h, s, there, env)
    u_P, thrust = propulsion(tally, f, on, h, there, u, n)
    steering(tally, f, on, h, there, u_P, thrust, blade, feedback)
    pulls(tally, f, on, h, t, s[PSI])
    cos, sin = np.cos(s[PSI]), np.sin(s[PSI])
    for origin, force in env.air(s, cos, sin).items():
        tally.add(origin, *force)
    tally.add("waves", *env.wave_force)
    tally.add("waves", *env.drift)
    slosh = np.zeros_like(u)
    if on.slosh:
        slosh, *force = flaws.slosh(f, h, s[SLOSH], s[SLOSHING], sway_acceleration)
        tally.hidden("Sloshing", 0.0, *force)
    X, Y, N, K = tally.total
    north_dot, east_dot = env.current_rate
    X = X + h.swayed * v * r + h.off * r * r - h.M * (north_dot * cos + east_dot * sin)
    pull = h.M * (east_dot * cos - north_dot * sin)
    Y, N = Y - h.surged * u * r - pull, N - h.off * u * r - h.x_G * pull
    K = K + h.rolled * u * r - h.GZ * np.sin(phi) - h.B44 * p * (1 + 8 * np.abs(p) / h.w_roll)
    w3, z3, w5, z5, m3, m5 = env.oscillator
    cu, cv = env.current[0] * cos + env.current[1] * sin, env.current[1] * cos - env.current[0] * sin
    out = np.empty_like(s)
    out[NORTH], out[EAST] = (u + cu) * cos - (v + cv) * sin, (u + cu) * sin + (v + cv) * cos
    out[PSI], out[U] = r * np.cos(phi), X / h.surged
    out[V] = h.inv_vY * Y + h.inv_vN * N + h.inv_vK * K
    out[R] = h.inv_vN * Y + h.inv_rN * N + h.inv_rK * K
    out[PHI], out[P] = p, h.inv_vK * Y + h.inv_rK * N + h.inv_pK * K
    out[Z], out[W] = s[W], env.heave / m3 - 2 * z3 * w3 * s[W] - w3 * w3 * s[Z]
    out[THETA], out[Q] = s[Q], env.pitch / m5 - 2 * z5 * w5 * s[Q] - w5 * w5 * s[THETA]
    out[SLOSH], out[SLOSHING] = s[SLOSHING], slosh
    return out
