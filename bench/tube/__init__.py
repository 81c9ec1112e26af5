"""The prediction tube on voyages that it was not calibrated with: `twin-bench tube`."""
