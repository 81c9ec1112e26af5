"""What laws of adaptation are told on voyages, and what free runs make of what they learned.

All laws hear the same: the filter that gives unexplained force and regressors does not use what they learn.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bench.adaptation.laws import Stream, Writes
from bench.paper.adapted import Acting, Learning
from bench.paper.filter import Tuning, from_states
from bench.paper.lab import LabCourse, course, judge
from bench.paper.models import Workshop
from bench.paper.paper_voyages import sail
from export.batches import zeta_of
from export.teach import Taught
from twin.physics.model import Model


@dataclass(frozen=True)
class Heard:
    """Of some voyages: the filter's model and network, where it stood after each step (K, V, 11), and what
    the laws are told."""

    model: Model
    acting: Acting
    courses: Sequence[LabCourse]
    states: np.ndarray
    streams: Sequence[Stream]

    @property
    def scenario(self) -> np.ndarray:
        return np.array([c.scenario for c in self.courses])

    def errors(self, rows: np.ndarray, model: Model | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Heading deg and lateral m (V, W) of free runs with the learned numbers (V W, 3, width), by another
        model if one is given."""
        model = model or self.model
        starts = [self.states[c.starts, i] for i, c in enumerate(self.courses)]
        e = judge(from_states(self.courses, model, self.acting.holding(rows, model), starts), self.courses)
        heading, lateral = (x.reshape(len(self.courses), -1) for x in (e.heading_deg, e.lateral_m))
        return heading, lateral


@dataclass(frozen=True)
class Hearing:
    """A model, its network and its filter's tuning."""

    shop: Workshop
    model: Model
    taught: Taught
    tuning: Tuning

    @classmethod
    def of(cls, shop: Workshop, model: Model, name: str) -> "Hearing":
        """With the first seed's network of this name."""
        taught = shop.taught(model, shop.settings.seed, name)
        return cls(shop, model, taught, shop.tuned(model, taught.network))

    def of_voyages(
        self, cases: Sequence[Any], starts_s: tuple[float, ...], model: Model | None = None
    ) -> Heard:
        """Sail, filter by the model (or by another), and write down what a law would be told."""
        model = model or self.model
        acting = Acting(self.taught.network, model, zeta_of(self.taught.network, self.taught.samples))
        sailed = sail(cases, self.shop.work / "voyages", self.shop.tell)
        courses = [replace(course(one, model.ship), starts_s=starts_s) for one in sailed]
        learning = Learning(courses, model, acting, self.tuning, Writes)
        states = learning.run(int(courses[0].starts[-1]))
        return Heard(model, acting, courses, states, [law.heard for law in learning.laws])  # type: ignore[attr-defined]


def by_scenario(values: np.ndarray, scenario: np.ndarray) -> dict[str, float]:
    """Means of values by voyage."""
    return {name: float(values[scenario == name].mean()) for name in sorted(set(scenario.tolist()))}
