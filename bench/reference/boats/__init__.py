"""Boats and ferries that several actuators drive and steer, by physics of their own: strips for the hull, the
slip of a screw, the momentum of a jet. Nothing here is shared with `twin/`."""

from bench.reference.boats.craft import CRAFT
from bench.reference.boats.sea import BoatCase, BoatSea, sail

__all__ = ["CRAFT", "BoatCase", "BoatSea", "sail"]
