"""The N-body problem in plain Python: a yardstick of interpreted arithmetic that also ran on a Cortex-A72.

Five million steps of the Benchmarks Game's program took 158.3 s on a Raspberry Pi 4 at 1.5 GHz (performance
governor; https://chaitanyamehta.github.io/projects/performance-analysis-of-programming-languages;
the version of Python is not given). So this machine is about PI_4_US / step_us() times as fast as the board.
"""

import time
from math import pi

PI_4_US = 158.263e6 / 5e6  # one step on the board
DAY = 365.24
BODIES = (  # x, y, z [AU], velocities [AU/day], mass [suns]: Sun, Jupiter, Saturn, Uranus, Neptune
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
    (4.84143, -1.16032, -0.103622, 1.66008e-3, 7.69901e-3, -6.90460e-5, 9.54792e-4),
    (8.34337, 4.12480, -0.403523, -2.76743e-3, 4.99853e-3, 2.30417e-5, 2.85886e-4),
    (12.8944, -15.1112, -0.223308, 2.96460e-3, 2.37847e-3, -2.96590e-5, 4.36624e-5),
    (15.3797, -25.9193, 0.179259, 2.68068e-3, 1.62824e-3, -9.51592e-5, 5.15139e-5),
)


def step_us(steps: int = 2000, repeats: int = 5) -> float:
    """Microseconds of one step here; the best of `repeats`, so that a busy neighbour does not count."""
    bodies = [([x, y, z], [u * DAY, v * DAY, w * DAY], m * 4 * pi * pi) for x, y, z, u, v, w, m in BODIES]
    pairs = [(a, b) for i, a in enumerate(bodies) for b in bodies[i + 1 :]]
    best = float("inf")
    for _ in range(repeats):
        start = time.perf_counter()
        _advance(bodies, pairs, steps)
        best = min(best, time.perf_counter() - start)
    return best / steps * 1e6


def _advance(bodies, pairs, steps, dt=0.01):
    for _ in range(steps):
        for ([x1, y1, z1], v1, m1), ([x2, y2, z2], v2, m2) in pairs:
            dx, dy, dz = x1 - x2, y1 - y2, z1 - z2
            pull = dt * (dx * dx + dy * dy + dz * dz) ** -1.5
            p1, p2 = m1 * pull, m2 * pull
            v1[0] -= dx * p2
            v1[1] -= dy * p2
            v1[2] -= dz * p2
            v2[0] += dx * p1
            v2[1] += dy * p1
            v2[2] += dz * p1
        for place, (u, v, w), _ in bodies:
            place[0] += dt * u
            place[1] += dt * v
            place[2] += dt * w
