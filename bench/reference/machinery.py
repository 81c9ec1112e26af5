"""Steering gear and engine: what lies between an order and the blade."""

import numpy as np

from bench.reference.mmg import limit


def steer(h, rudder, order, dt, rate_share=1.0):
    """Next rudder angle [rad]: a first-order servo, its speed limited by the pumps."""
    fastest = h.fastest * rate_share
    speed = (limit(order, -h.hard_over, h.hard_over) - rudder) / np.maximum(h.rudder_time, dt)
    return rudder + dt * limit(speed, -fastest, fastest)


def turn_engine(h, n, order, dt):
    """Next propeller rate [1/s]: first-order."""
    return n + dt * (order - n) / np.maximum(h.engine_time, dt)


def play(blade, feedback, slack):
    """Blade angle behind a linkage with `slack` [rad] of play: it moves only when the play is used up."""
    return limit(blade, feedback - slack, feedback + slack)
