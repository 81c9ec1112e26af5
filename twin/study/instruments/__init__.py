"""Instruments by kinematics: position, velocity, heading, rate of turn, log and wind must agree whatever the
ship is.

No rudder, no shaft and no model of the ship. Method: docs/instruments.md.
"""
