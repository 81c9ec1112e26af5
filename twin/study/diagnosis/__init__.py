"""Hypotheses, evidence, search, validation on held-out parts, and the decision with its reason."""
