"""Which measurements are believed."""
