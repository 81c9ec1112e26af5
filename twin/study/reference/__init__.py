"""What healthy voyages establish: noise model, priors, and how much voyages of one ship differ."""
