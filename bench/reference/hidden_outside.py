"""What no effect of the catalogue describes, hidden in the truth at strength s."""

from math import pi, radians, sqrt

from bench.reference.hidden_plan import FULL_SCALE, Plan, either


def ice_like(hull, rng, s):
    return Plan(
        {"ice": 0.6 * s, "ice_length": 2.0 * hull.L, "ice_phase": rng.uniform(0, 6)},
        truth={"drag_share": 0.6 * s},
    )


def passing_ship(hull, rng, s):
    unit, side = hull.L / hull.U0, either(rng)
    return Plan(
        {
            "passing_Y": 0.03 * s * side,
            "passing_N": 0.010 * s * side,
            "passing_every": 11 * unit,
            "passing_width": 1.1 * unit,
        }
    )


def sloshing(hull, rng, s):
    return Plan({"slosh": 0.12 * s, "slosh_w": 2.5 * sqrt(9.81 / hull.L), "slosh_x": 0.3 * either(rng)})


def rudder_backlash(hull, rng, s):
    return Plan({"backlash": radians(2.5 * s)}, truth={"play_deg": 5.0 * s})


def squall(hull, rng, s):
    unit = hull.L / hull.U0
    return Plan(
        {
            "squall_mps": (28.0 if hull.L > FULL_SCALE else 9.0) * sqrt(s),
            "squall_from": rng.uniform(0, 2 * pi),
            "squall_every": 18 * unit,
            "squall_width": 2.0 * unit,
        }
    )
