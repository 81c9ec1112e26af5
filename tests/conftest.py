"""For all rooms: what hypothesis draws is the same in every run, and how long it takes is no verdict."""

from hypothesis import settings

settings.register_profile("shiptwin", deadline=None, derandomize=True)
settings.load_profile("shiptwin")
