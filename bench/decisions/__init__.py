"""A fixed set of voyages with a known truth, and what `twin diagnose` answers on each."""
