"""Channels, readings and settings: what instruments say, in SI, before anyone believes it."""
