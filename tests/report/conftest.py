"""The page is tested on the voyages of the study's tests."""

from tests.study.conftest import kvlcc2, make, on_disk, sailed, verb

__all__ = ["kvlcc2", "make", "on_disk", "sailed", "verb"]
