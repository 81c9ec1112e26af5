"""A force along the ship, across it and about it, as engineers write it."""

from collections.abc import Mapping

from twin.num import num


def force(forces: Mapping[str, float]) -> str:
    """The components that are there, in words."""
    there = {key: forces[key] for key in ("X_N", "Y_N", "N_Nm")}
    return ", ".join(
        f"{key[0]} {_si(value, 'N m' if key == 'N_Nm' else 'N')}"
        for key, value in there.items()
        if abs(value) > 1e-9
    )


def _si(value: float, unit: str) -> str:
    """A size with the prefix that engineers use."""
    for prefix, factor in (("G", 1e9), ("M", 1e6), ("k", 1e3)):
        if abs(value) >= factor:
            return f"{num(value / factor, 3)} {prefix}{unit}"
    return f"{num(value, 3)} {unit}"
