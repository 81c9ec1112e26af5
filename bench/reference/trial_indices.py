"""The figures by which manoeuvring trials are judged: advance, tactical diameter, overshoots, periods."""

import numpy as np


def crossing(values, level):
    """Index, with a fraction, at which `values` first reaches `level`; NaN if never."""
    over = np.nonzero(values >= level)[0]
    if not len(over) or over[0] == 0:
        return float("nan")
    i = over[0]
    return i - 1 + (level - values[i - 1]) / (values[i] - values[i - 1])


def turn(north, east, psi_deg, L):
    """Advance and tactical diameter in ship lengths of a turn that starts northward at the origin."""
    turned = np.abs(psi_deg)
    i, j = crossing(turned, 90), crossing(turned, 180)
    ticks = np.arange(len(turned))
    return float(np.interp(i, ticks, north)) / L, abs(float(np.interp(j, ticks, east))) / L


def overshoots(time, psi_deg, rudder_deg, angle):
    """Overshoots [deg] and the times [s] of the reversals, from a zigzag whose rudder is held at +-`angle`.

    A reversal is where the rudder crosses zero on its way over; the overshoot is the largest heading until
    the next reversal, less the heading at which the rudder was ordered over, taken as `angle`.
    """
    side = np.sign(np.where(np.abs(rudder_deg) < 0.3 * abs(angle), 0, rudder_deg))
    held = np.nonzero(side)[0]
    turns = held[1:][side[held[1:]] != side[held[:-1]]]
    ends = [*list(turns[1:]), len(time)]
    peaks = [float(np.abs(psi_deg[a:b]).max() - abs(angle)) for a, b in zip(turns, ends, strict=True)]
    return peaks[:-1], [float(t) for t in np.asarray(time)[turns]]
