"""The one way in which a number is told to a person: so many significant digits, and no power of ten."""


def num(value: float, digits: int = 2) -> str:
    """`value` with so many significant digits, 160 and not 1.6e+02; what is smaller than 1e-4 or not below
    1e12 keeps its power of ten."""
    return f"{float(f'{value:.{digits}g}'):.12g}"


def percent(share: float) -> str:
    """A share or a probability, in whole per cent."""
    return f"{100.0 * share:.0f} %"
