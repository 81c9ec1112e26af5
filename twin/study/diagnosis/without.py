"""What one effect of a model does by itself: the model without it, or with it put back to what it was."""

from twin.physics.model import Model


def without(model: Model, before: Model, name: str) -> Model:
    """The model with one effect taken out, or put back to what it was `before`."""
    was = (e for e in before.effects if type(e).__name__ == name)
    return Model(model.ship, (*(e for e in model.effects if type(e).__name__ != name), *was))
