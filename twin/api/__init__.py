"""The Python interface: one function a verb, and its result as a frozen dataclass (docs/api.md)."""
