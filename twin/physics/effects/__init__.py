"""The catalogue: every effect the twin knows, in one explicit list, and those that others add.

An installed package adds its own by the entry point group `twin.effects`, name = class.
"""

from functools import lru_cache

from twin.errors import SettingsError, did_you_mean
from twin.physics.effect import Effect

from .current import Current
from .steering_lag import SteeringLag
from .wind import Wind

BUILT_IN: tuple[type[Effect], ...] = (
    Wind,
    Current,
    SteeringLag,
)


@lru_cache(maxsize=1)
def catalogue() -> dict[str, type[Effect]]:
    """Name -> effect, built-in first, then those that installed packages bring."""
    from importlib.metadata import entry_points

    known = {e.__name__: e for e in BUILT_IN}
    for point in entry_points(group="twin.effects"):
        known.setdefault(point.name, point.load())
    return known


def find(name: str) -> type[Effect]:
    """The effect of that name; a built-in one is found without looking at what is installed."""
    for effect in BUILT_IN:
        if effect.__name__ == name:
            return effect
    known = catalogue()
    if name not in known:
        raise SettingsError(f"Unknown effect {name!r}.{did_you_mean(name, known)}")
    return known[name]
