"""Real ships: published measurements, never fitted to."""
