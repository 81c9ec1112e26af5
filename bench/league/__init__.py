"""Hidden effects: voyages with something hidden, and what the diagnosis makes of them."""
