"""Boats and ferries that several actuators drive and steer, by physics of their own: strips for the hull, the
slip of a screw, the momentum of a jet. Nothing here is shared with `twin/`."""

from bench.reference.boats.boat_sea import BoatCase, BoatSea, sail
from bench.reference.boats.craft import CRAFT

__all__ = ["CRAFT", "BoatCase", "BoatSea", "sail"]
