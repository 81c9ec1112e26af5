"""Adversaries against the certificate."""
