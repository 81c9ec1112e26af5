"""The fit of the core to reference voyages, its held-out check and its warnings."""
