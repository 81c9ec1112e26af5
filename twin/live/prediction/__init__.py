"""How far predictions may be off, as reference voyages showed it."""
