"""What pushes: the slip of a screw, the momentum of a jet, a rudder in the race behind its screw."""

import math

from bench.reference.boats.craft import Drive

Push = tuple[float, float]  # ahead and to starboard [N]


def screw(d: Drive, n: float, u_a: float, rho: float) -> float:
    """Thrust [N] by the speed of its slip, n pitch - u_a; backwards it works on its backs."""
    slip = n * d.pitch - u_a
    thrust = 0.5 * rho * 0.25 * math.pi * d.D**2 * d.grip * slip * abs(slip)
    return thrust * (d.astern if thrust < 0.0 else 1.0)


def thruster(d: Drive, n: float, angle: float, u: float, v: float, rho: float) -> Push:
    return screw(d, n, 0.9 * u, rho), 0.0


def pod(d: Drive, n: float, angle: float, u: float, v: float, rho: float) -> Push:
    """The screw along its own axis; its strut is a fin that the water across it pushes; the hull takes back
    most of a push straight ahead."""
    c, s = math.cos(angle), math.sin(angle)
    along, across = u * c + v * s, v * c - u * s
    T = screw(d, n, 0.95 * along, rho) * (1.0 - 0.06 * c * c)
    F = -0.5 * rho * 0.5 * d.D**2 * across * math.hypot(along, across)
    return T * c - F * s, T * s + F * c


def jet(d: Drive, n: float, angle: float, u: float, v: float, rho: float) -> Push:
    """Water taken in at the ship's speed and let out faster; the nozzle turns what goes out, not what comes
    in."""
    area = 0.25 * math.pi * d.D**2
    out = math.sqrt((d.pitch * n) ** 2 + 0.55 * u * u)
    flow = rho * area * out
    return flow * (0.97 * out * math.cos(angle) - 0.92 * u), -0.93 * flow * out * math.sin(angle)


def tunnel(d: Drive, n: float, angle: float, u: float, v: float, rho: float) -> Push:
    """The stream past its mouths bends the jet back along the side."""
    return 0.0, screw(d, n, 0.0, rho) * math.exp(-((abs(u) / 2.6) ** 1.5))


def shaft(d: Drive, n: float, angle: float, u: float, v: float, rho: float) -> Push:
    """Screw in the wake, and a flat plate in what it throws back."""
    u_a = 0.85 * u
    T = screw(d, n, u_a, rho)
    race = math.sqrt(max(u_a * u_a + 2.0 * T / (rho * 0.25 * math.pi * d.D**2), 0.0))
    ahead, across = 0.75 * race + 0.25 * u_a, 0.6 * v
    flow = math.hypot(ahead, across) + 1e-6
    bite = math.sin(angle + math.atan2(across, max(ahead, 1e-3)))
    F = (
        0.5
        * rho
        * d.rudder
        * flow
        * flow
        * (2.6 * bite + 0.9 * bite * abs(bite))
        * math.exp(-(bite**6) / 0.02)
    )
    return 0.86 * T - 0.7 * F * math.sin(angle), -1.15 * F * math.cos(angle)


KINDS = {"thruster": thruster, "pod": pod, "jet": jet, "tunnel": tunnel, "shaft": shaft}
